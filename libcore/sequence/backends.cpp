#include "sequence/backends.h"

#include <fmt/format.h>

#include <algorithm>

#include "backend_embree/embree/embree_renderer.h"
#include "base/error.h"
#include "base/option_text.h"
#include "base/stages.h"
#include "base/suggest.h"

namespace cistula {
namespace {

std::string describe(const CudaDevice& device) {
    return fmt::format("{}: {}, capability {}.{}, {:.1f} GiB, {} multiprocessors", device.index, device.name,
                       device.major, device.minor, static_cast<double>(device.memory) / (1 << 30),
                       device.multiprocessors);
}

[[noreturn]] void fail_device(const std::string& value, const std::string& problem, const std::string& remedy = {}) {
    throw Error(ErrorKind::device, problem, remedy).of("device", value);
}

}  // namespace

DeviceChoice parse_devices(const std::string& text, Backend backend) {
    if (backend != Backend::cuda)
        fail_usage(fmt::format("chooses GPUs, and `backend` is {}", backend_name(backend)),
                   "add `backend` cuda or leave it out");
    if (text == "all") return {true, {}};
    DeviceChoice choice{false, {}};
    for (const std::string_view part : parts_at_commas(text)) {
        const auto index = whole_number<int>(part);
        if (!index || *index < 0)
            fail_usage("", "must be numbers of GPUs, as in 0 or 0,2, or all; render `list_devices` shows them");
        if (std::find(choice.indices.begin(), choice.indices.end(), *index) != choice.indices.end())
            fail_usage(fmt::format("names GPU {} twice", *index), "once is enough");
        choice.indices.push_back(*index);
    }
    return choice;
}

std::string devices_text(const DeviceChoice& choice) {
    return choice.all ? "all" : fmt::format("{}", fmt::join(choice.indices, ","));
}

std::vector<CudaDevice> pick_devices(const DeviceChoice& choice, const std::vector<CudaDevice>& present) {
    std::vector<CudaDevice> picked;
    if (choice.all) {
        for (const CudaDevice& device : present)
            if (device.obstacle.empty()) picked.push_back(device);
        if (!picked.empty()) return picked;
        if (present.empty()) fail_device("all", "this machine has no GPU");
        fail_device("all", fmt::format("no GPU can be used; {}: {}: {}", present[0].index, present[0].name,
                                       present[0].obstacle));
    }
    for (const int index : choice.indices) {
        const auto device = std::find_if(present.begin(), present.end(),
                                         [index](const CudaDevice& candidate) { return candidate.index == index; });
        if (device == present.end()) {
            std::vector<int> indices;
            for (const CudaDevice& candidate : present) indices.push_back(candidate.index);
            fail_device(fmt::format("{}", index), "there is no such GPU",
                        fmt::format("this machine has {}",
                                    indices.empty() ? "none" : fmt::format("{}", fmt::join(indices, ", "))));
        }
        if (!device->obstacle.empty())
            fail_device(fmt::format("{}", index), fmt::format("{} cannot be used: {}", device->name, device->obstacle));
        picked.push_back(*device);
    }
    return picked;
}

std::string list_devices_text(const std::vector<CudaDevice>& devices) {
    if (devices.empty()) return "no GPU\n";
    std::string text;
    for (const CudaDevice& device : devices)
        text += describe(device) +
                (device.obstacle.empty() ? "" : fmt::format("; cannot be used: {}", one_line(device.obstacle))) + "\n";
    return text;
}

ChosenDevices choose_devices(Backend backend, const DeviceChoice& choice) {
    ChosenDevices chosen;
    chosen.options.devices.clear();
    if (backend != Backend::cuda) return chosen;
    for (const CudaDevice& device : pick_devices(choice, list_cuda_devices())) {
        chosen.options.devices.push_back(device.index);
        chosen.names.push_back(device.name);
    }
    begin_cuda_devices(chosen.options.devices);
    chosen.driver = cuda_driver_version();
    return chosen;
}

std::string list_devices_text() {
    if (!has_cuda_backend()) return "no GPU: this build has no CUDA backend\n";
    try {
        return list_devices_text(list_cuda_devices());
    } catch (const Error& error) {
        return one_line(error.what()) + "\n";
    }
}

template <class Real>
std::unique_ptr<Renderer> make_renderer(Backend backend, std::shared_ptr<const CompiledScene<Real>> scene,
                                        const CudaOptions& options) {
    if (backend == Backend::cuda) return make_cuda_renderer<Real>(std::move(scene), options);
    return make_embree_renderer<Real>(std::move(scene));
}

template std::unique_ptr<Renderer> make_renderer<float>(Backend, std::shared_ptr<const CompiledScene<float>>,
                                                        const CudaOptions&);
template std::unique_ptr<Renderer> make_renderer<double>(Backend, std::shared_ptr<const CompiledScene<double>>,
                                                         const CudaOptions&);

namespace {

std::unique_ptr<Renderer> make_still_renderer(Backend backend, const Scene& scene, const CudaOptions& options) {
    return scene.visit([&](const auto& compiled) { return make_renderer(backend, compiled, options); });
}

/// Renders each frame of a scene that changes by a renderer of its own. Questions about rays are about the frame that
/// the scene was compiled as.
class MovingRenderer : public Renderer {
  public:
    MovingRenderer(Backend backend, Scene scene, const CudaOptions& options)
        : backend_(backend), scene_(std::move(scene)), options_(options) {
        show(scene_.shown(), {});
    }

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        try {
            show(camera.frame, progress.stop);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::interrupted) throw;
            return false;
        }
        return renderer_->render(camera, settings, film, progress);
    }
    RayHits intersect(std::span<const glm::dvec3> origins, std::span<const glm::dvec3> directions) override {
        show(scene_.shown(), {});
        return renderer_->intersect(origins, directions);
    }
    std::vector<glm::dvec3> transmittance(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) override {
        show(scene_.shown(), {});
        return renderer_->transmittance(from, to);
    }
    PixelTree pixel_tree(const CameraFrame& camera, const FrameSettings& settings, int x, int y,
                         const PixelTreeLimits& limits) override {
        show(camera.frame, limits.stop);
        return renderer_->pixel_tree(camera, settings, x, y, limits);
    }
    size_t frames_ahead() const override { return 0; }
    uint32_t effects() const override { return asked(&Renderer::effects); }
    int lanes() const override { return asked(&Renderer::lanes); }
    std::string intersector() const override { return asked(&Renderer::intersector); }
    RenderTimes times() const override { return asked(&Renderer::times); }
    std::vector<std::string> notes() const override {
        std::vector<std::string> all = asked(&Renderer::notes);
        all.insert(all.end(), notes_.begin(), notes_.end());
        return all;
    }
    size_t memory() const override { return asked(&Renderer::memory); }

  private:
    /// What the last frame's renderer says; where none could be made, nothing.
    template <class Answer>
    Answer asked(Answer (Renderer::*question)() const) const {
        return renderer_ ? (renderer_.get()->*question)() : Answer();
    }
    void show(int frame, StopSignal stop) {
        if (renderer_ && shown_ == frame) return;
        const InStage stage(Stage::compile);
        const Scene scene = scene_.at(frame, stop);  // may throw: the renderer of the frame before then stays
        renderer_.reset();
        notes_.clear();
        const auto is_said = [&](const std::string& warning) {
            const std::vector<std::string>& said = scene_.warnings();
            return std::find(said.begin(), said.end(), warning) != said.end();
        };
        for (const std::string& warning : scene.warnings())
            if (!is_said(warning) && !is_said(in_frame(scene_.shown(), warning)))
                notes_.push_back(in_frame(frame, warning));
        renderer_ = make_still_renderer(backend_, scene, options_);
        shown_ = frame;
    }

    const Backend backend_;
    const Scene scene_;
    const CudaOptions options_;
    std::unique_ptr<Renderer> renderer_;
    int shown_ = 0;
    std::vector<std::string> notes_;  // on the frame that is shown
};

}  // namespace

std::string describe_flags(uint32_t flags, Renderer& renderer, const SceneDescription& scene, Precision precision,
                           const CameraFrame& camera, FrameSettings settings) {
    if ((flags & flag_media_overflow) == 0) return describe_flags(flags);
    settings.layers = {};
    settings.parts = {};
    PixelRect& part = settings.crop;
    while (part.width > 1 || part.height > 1) {
        const bool by_width = part.width > part.height;
        int PixelRect::*const size = by_width ? &PixelRect::width : &PixelRect::height;
        const PixelRect all = part;
        part.*size /= 2;
        Film film;
        RenderProgress progress;
        renderer.render(camera, settings, film, progress);
        if ((film.flags & flag_media_overflow) != 0) continue;
        part.*(by_width ? &PixelRect::x : &PixelRect::y) += part.*size;
        part.*size = all.*size - part.*size;
    }
    settings.supersample = settings.grid();  // which has all samples that adaptive sampling may take
    settings.target_error = 0;
    try {
        const Scene shown = Scene(scene, precision).at(camera.frame);
        return describe_flags(flags, make_embree_renderer(shown)->pixel_tree(camera, settings, part.x, part.y).crowd);
    } catch (const Error&) {  // the pixel's rays are too many to be followed one by one
        return describe_flags(flags);
    }
}

std::unique_ptr<Renderer> make_renderer(Backend backend, const Scene& scene, const CudaOptions& options) {
    if (scene.moves()) return std::make_unique<MovingRenderer>(backend, scene, options);
    return make_still_renderer(backend, scene, options);
}

}  // namespace cistula
