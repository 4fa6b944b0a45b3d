#include "backend_cuda/cuda_renderer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <type_traits>

#include "backend_cuda/device_worker.h"
#include "scene/frame_view.h"

namespace cistula {
namespace {

/// Up to this many primitives a plain loop is faster than any tree.
constexpr uint32_t plain_loop_primitives = 16;
/// Samples of a part: what is copied while the next is in the kernels.
constexpr size_t part_samples = size_t{1} << 25;
template <class Real>
bool fits_plain_loop(const SceneView<Real>& scene) {
    if (scene.convex.size + scene.clusters.size > plain_loop_primitives) return false;
    const auto small = std::make_unique<SmallScene<Real>>();
    return small->assign(scene, scene);
}

bool same(const CameraFrame& a, const CameraFrame& b) {
    const Camera &p = a.camera, &q = b.camera;
    return p.position == q.position && p.forward == q.forward && p.right == q.right && p.up == q.up &&
           p.tan_half_width == q.tan_half_width;
}

template <class Real>
class CudaRenderer : public Renderer {
  public:
    CudaRenderer(std::shared_ptr<const CompiledScene<Real>> scene, const CudaOptions& options)
        : scene_(std::move(scene)), options_(options), view_(scene_->view()) {
        const std::vector<CudaDevice> known = list_cuda_devices();
        for (const int index : options_.devices) require(known, index);
        path_ = !options_.always_tree && fits_plain_loop(view_) ? DevicePath::plain_loop : DevicePath::tree;
        if (path_ == DevicePath::tree) {
            tree_ = facet_tree(view_);
            tree_.put_into(view_);
        }
        const SceneArena<Real> arena(view_);
        bytes_ = arena.bytes().size();
        for (const int index : options_.devices) {
            use_device(index);
            workers_.push_back(std::make_unique<DeviceWorker<Real>>(index, arena, view_, path_));
        }
    }

    ~CudaRenderer() override {
        try {
            drop();  // or freeing memory would wait for a frame that nobody wants
        } catch (...) {
        }
    }

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        notes_.clear();
        times_ = {};
        prepare_film(film, settings, *scene_, camera);
        if (!begun_ || !same(begun_->camera, camera) || begun_->settings != settings) {
            if (begun_) drop();
            begun_ = begin(camera, settings);
        }
        Frame frame = *begun_;
        begun_.reset();
        if (!frame.fits) film.flags |= flag_media_overflow;
        for (auto& worker : workers_) {
            worker->kernel_seconds = worker->transfer_seconds = 0;
            worker->rays = RayCounts();
            worker->flags = 0;
        }
        RayCounts before;
        for (int part = 0; part < frame.parts; ++part) {
            if (progress.stop) {
                drop();
                return false;
            }
            if (part + 1 < frame.parts)
                start(frame, part + 1);
            else if (expected_ && expected_->settings == settings)  // others may need memory that this one still has
                begun_ = begin(expected_->camera, expected_->settings, frame.first_slot + part + 1);
            const int slot = (frame.first_slot + part) % DeviceWorker<Real>::slots;
            std::atomic<bool> stopped{false};
            tbb::parallel_for(size_t{0}, workers_.size(), [&](size_t d) {
                if (strips_of(frame, part, d) > 0 && !workers_[d]->fetch(slot, film, progress.stop)) stopped = true;
            });
            if (stopped) {
                drop();
                return false;
            }
            film.rays = RayCounts();
            for (const auto& worker : workers_) film.rays.add(worker->rays);
            progress.rays += film.rays.total() - before.total();
            progress.pixels_done += pixels_of(frame, part);
            before = film.rays;
        }
        expected_.reset();
        for (const auto& worker : workers_) {
            film.flags |= worker->flags;
            times_.kernel = std::max(times_.kernel, worker->kernel_seconds);
            times_.transfer = std::max(times_.transfer, worker->transfer_seconds);
        }
        return !progress.stop;
    }

    void expect(const CameraFrame& camera, const FrameSettings& settings) override { expected_ = {camera, settings}; }
    uint32_t effects() const override { return effects_; }
    std::string intersector() const override { return "cuda"; }
    RenderTimes times() const override { return times_; }
    std::vector<std::string> notes() const override { return notes_; }
    size_t memory() const override { return bytes_; }

  private:
    struct Request {
        CameraFrame camera;
        FrameSettings settings;
    };
    struct Frame : Request {
        FrameView view;
        std::shared_ptr<const FrameHints> hints;
        BlockPlan plan;
        bool fits = true;  // the camera's list of media
        int mask = 0;
        int strips = 0;       // of the whole rectangle
        int part_strips = 0;  // of a part, per device
        int parts = 0;
        int first_slot = 0;
    };

    static void require(const std::vector<CudaDevice>& known, int index) {
        if (index < 0 || size_t(index) >= known.size())
            throw Error(ExitCode::device, fmt::format("--device {}: there is no such GPU; this machine has 0 to {}",
                                                      index, known.size() - 1));
        if (!known[size_t(index)].obstacle.empty())
            throw Error(ExitCode::device, fmt::format("--device {}: {}: {}", index, known[size_t(index)].name,
                                                      known[size_t(index)].obstacle));
    }

    int devices() const { return int(workers_.size()); }

    static Sampling sampling_of(const FrameSettings& settings) {
        return settings.adaptive() ? Sampling::adaptive : Sampling::uniform;
    }

    static PixelMapping mapping_for(const Frame& frame) {
        return frame.view.supersample > 1 ? PixelMapping::shared_tile : PixelMapping::own_tiles;
    }

    /// A pixel's, more or less.
    static size_t samples_of(const FrameSettings& settings) {
        constexpr size_t adaptive = 16;
        return settings.adaptive() ? adaptive : size_t(settings.supersample) * size_t(settings.supersample);
    }

    /// The frame's plan, its first part on its way.
    Frame begin(const CameraFrame& camera, const FrameSettings& settings, int slot = 0) {
        Frame frame;
        frame.camera = camera;
        frame.settings = settings;
        frame.view = frame_view(*scene_, camera, settings);
        const Vec3<double> position = frame.view.camera.position;
        frame.fits = path_ == DevicePath::tree
                         ? camera_solids(view_, BvhIntersector<Real>{view_}, position, frame.view.camera_media)
                         : camera_solids(view_, BruteIntersector<Real>{view_}, position, frame.view.camera_media);
        frame.mask = mask_to_run(scene_->effects, settings, frame.view);
        effects_ = effect_masks[frame.mask];
        const PixelRect& rect = settings.crop;
        frame.strips = (rect.height + strip_rows - 1) / strip_rows;
        frame.hints = std::make_shared<const FrameHints>(frame_hints(*scene_, frame.view, settings));
        frame.plan = {mapping_for(frame), kernel_shapes[frame.mask].warps};
        constexpr int width = BlockPlan::width;
        const size_t strip_pixels = size_t((rect.width + width - 1) / width * width) * strip_rows;
        const size_t samples = samples_of(settings);
        const int per_device = (frame.strips + devices() - 1) / devices();
        int wanted = int(std::clamp<size_t>(part_samples / (strip_pixels * samples), 1, size_t(per_device)));
        if (largest_part_ != 0) wanted = int(std::clamp<size_t>(largest_part_ / strip_pixels, 1, size_t(wanted)));
        frame.part_strips = reserve(wanted, strip_pixels, frame);
        frame.parts = (per_device + frame.part_strips - 1) / frame.part_strips;
        frame.first_slot = slot % DeviceWorker<Real>::slots;
        start(frame, 0);
        return frame;
    }

    /// Memory for parts of `strips`, or of half as many until it is enough.
    int reserve(int strips, size_t strip_pixels, Frame& frame) {
        const int wanted = strips;
        const auto has_room = [&] {
            bool room = true;
            for (auto& worker : workers_)
                room = room && worker->reserve(size_t(strips) * strip_pixels, options_.memory_limit,
                                               sampling_of(frame.settings), frame.mask);
            return room;
        };
        for (;; strips = (strips + 1) / 2) {
            if (has_room()) break;
            if (strips == 1)
                throw Error(ExitCode::device,
                            fmt::format("the GPU has no memory for {} pixels at a time; a smaller --res or "
                                        "--crop needs less, or free memory that other programs hold",
                                        strip_pixels));
        }
        if (strips < wanted) {
            largest_part_ = size_t(strips) * strip_pixels;
            notes_.push_back(fmt::format("the GPU's memory is short: {} pixels at a time instead of {}",
                                         size_t(strips) * strip_pixels, size_t(wanted) * strip_pixels));
        }
        return strips;
    }

    /// How many strips of a part are device d's: strip s of the rectangle is device s % devices()'s.
    int strips_of(const Frame& frame, int part, size_t d) const {
        const int own = (frame.strips - int(d) + devices() - 1) / devices();
        return std::clamp(own - part * frame.part_strips, 0, frame.part_strips);
    }

    uint64_t pixels_of(const Frame& frame, int part) const {
        const int first = part * frame.part_strips * devices() * strip_rows;
        const int last = std::min((part + 1) * frame.part_strips * devices() * strip_rows, frame.settings.crop.height);
        return uint64_t(std::max(last - first, 0)) * uint64_t(frame.settings.crop.width);
    }

    void start(const Frame& frame, int part) {
        for (size_t d = 0; d < workers_.size(); ++d) {
            FramePart job;
            job.strips = {part * frame.part_strips * devices() + int(d), devices(), strips_of(frame, part, d)};
            if (job.strips.count == 0) continue;
            job.frame = frame.view;
            job.hints = frame.hints;
            job.plan = frame.plan;
            job.sampling = sampling_of(frame.settings);
            job.mask = frame.mask;
            workers_[d]->start(job, (frame.first_slot + part) % DeviceWorker<Real>::slots);
        }
    }

    /// Ends all that was begun and forgets it. All workers first: one GPU may have several.
    void drop() {
        for (auto& worker : workers_) worker->stop();
        for (auto& worker : workers_) worker->wait();
        begun_.reset();
    }

    std::shared_ptr<const CompiledScene<Real>> scene_;
    const CudaOptions options_;
    SceneView<Real> view_;
    FacetTree<Real> tree_;
    DevicePath path_;
    std::vector<std::unique_ptr<DeviceWorker<Real>>> workers_;
    std::optional<Request> expected_;
    std::optional<Frame> begun_;
    RenderTimes times_;
    std::vector<std::string> notes_;
    size_t bytes_ = 0, largest_part_ = 0;
    uint32_t effects_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<Renderer> make_cuda_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             const CudaOptions& options) {
    return std::make_unique<CudaRenderer<Real>>(std::move(scene), options);
}

template std::unique_ptr<Renderer> make_cuda_renderer(std::shared_ptr<const CompiledScene<float>>, const CudaOptions&);
template std::unique_ptr<Renderer> make_cuda_renderer(std::shared_ptr<const CompiledScene<double>>, const CudaOptions&);

}  // namespace cistula
