#include "backend_cuda/host/cuda_renderer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "backend_cuda/host/device_worker.h"
#include "scene/base/default_rounding.h"
#include "scene/film/film_difference.h"
#include "scene/frame/frame_view.h"

namespace cistula {
namespace {

/// The number of samples in a part of a frame: one part is copied back while the next is rendered.
constexpr size_t part_samples = size_t{1} << 25;

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
        take_path(options_.always_tree ? DevicePath::tree : path_for(view_));
    }

    ~CudaRenderer() override {
        try {
            drop();  // else freeing memory would wait for an unwanted frame
        } catch (...) {
        }
    }

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        notes_.clear();
        times_ = {};
        prepare_film(film, settings, *scene_, camera);
        if (settings.layers.any() && path_ != DevicePath::tree) {
            drop();
            take_path(DevicePath::tree);
        }
        if (!begun_ || !same(begun_->camera, camera) || begun_->settings != settings) {
            if (begun_) drop();
            FramePlan fresh = planned(camera, settings);
            begin(fresh);
            begun_ = fresh;
        }
        const FramePlan plan = *begun_;
        begun_.reset();
        if (!plan.fits) film.flags |= flag_media_overflow;
        effects_ = effect_masks[plan.mask];
        for (auto& worker : workers_) worker->totals = {};
        bool whole = true;
        try {
            for (int part = 0; part < plan.parts && whole; ++part)
                whole = !progress.stop && finish(plan, part, film, progress);
        } catch (...) {
            drop();
            throw;
        }
        if (!whole) {
            drop();
            return false;
        }
        expected_.reset();
        if (settings.adaptive()) film.totals = totals_of(film);
        for (const auto& worker : workers_) {
            if (!settings.adaptive()) film.totals.add(worker->totals.counts.totals);
            film.flags |= worker->totals.counts.flags;
            times_.kernel = std::max(times_.kernel, worker->totals.kernel_seconds);
            times_.transfer = std::max(times_.transfer, worker->totals.transfer_seconds);
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

    static void require(const std::vector<CudaDevice>& known, int index) {
        if (index < 0 || size_t(index) >= known.size())
            throw Error(ExitCode::device, fmt::format("--device {}: there is no such GPU; this machine has 0 to {}",
                                                      index, known.size() - 1));
        if (!known[size_t(index)].obstacle.empty())
            throw Error(ExitCode::device, fmt::format("--device {}: {}: {}", index, known[size_t(index)].name,
                                                      known[size_t(index)].obstacle));
    }

    /// Brings the scene to the devices in the form that a path needs.
    void take_path(DevicePath path) {
        path_ = path;
        if (path_ == DevicePath::tree) {
            tree_ = facet_tree(view_);
            tree_.put_into(view_);
        }
        const SceneArena<Real> arena(view_);
        bytes_ = arena.bytes().size();
        workers_.clear();
        for (const int index : options_.devices) {
            use_device(index);
            workers_.push_back(std::make_unique<DeviceWorker<Real>>(index, arena, view_, path_));
        }
    }

    /// The plan of a frame, undivided, whose first part is to go to a slot.
    FramePlan planned(const CameraFrame& camera, const FrameSettings& settings, int slot = 0) const {
        use_default_rounding();
        FramePlan plan;
        plan.camera = camera;
        plan.settings = settings;
        plan.view = frame_view(*scene_, camera, settings);
        plan.fits = path_ == DevicePath::tree ? find_camera_solids(view_, BvhIntersector<Real>{view_}, plan.view)
                                              : find_camera_solids(view_, BruteIntersector<Real>{view_}, plan.view);
        plan.mask = mask_to_run(scene_->effects, settings, plan.view);
        plan.sampling = settings.adaptive() ? Sampling::adaptive : Sampling::uniform;
        plan.blocks = {plan.view.supersample > 1 ? PixelMapping::shared_tile : PixelMapping::own_tiles,
                       kernel_shapes[plan.mask].warps};
        plan.hints = std::make_shared<const FrameHints>(frame_hints(*scene_, plan.view, settings));
        plan.devices = int(workers_.size());
        plan.first_slot = slot % DeviceWorker<Real>::slots;
        return plan;
    }

    /// Takes memory for a planned frame and starts its first part.
    void begin(FramePlan& plan) {
        divide(plan);
        start(plan, 0);
    }

    /// Divides a frame into parts that fit into memory.
    void divide(FramePlan& plan) {
        const PixelRect& rect = plan.settings.crop;
        constexpr int width = BlockPlan::width;
        plan.strips = (rect.height + strip_rows - 1) / strip_rows;
        plan.strip_pixels = size_t((rect.width + width - 1) / width * width) * strip_rows;
        const int most = plan.strips_per_device();
        int wanted = int(std::clamp<size_t>(part_samples / (plan.strip_pixels * plan.samples()), 1, size_t(most)));
        if (largest_part_ != 0) wanted = int(std::clamp<size_t>(largest_part_ / plan.strip_pixels, 1, size_t(wanted)));
        plan.part_strips = reserve(wanted, plan);
        plan.parts = (most + plan.part_strips - 1) / plan.part_strips;
    }

    /// Allocates memory for parts of `strips` strips, or of half as many until it fits; returns the number.
    int reserve(int strips, const FramePlan& plan) {
        const int wanted = strips;
        const auto has_room = [&] {
            return std::all_of(workers_.begin(), workers_.end(), [&](const auto& worker) {
                return worker->reserve(size_t(strips) * plan.strip_pixels, options_.memory_limit, plan);
            });
        };
        for (; !has_room(); strips = (strips + 1) / 2)
            if (strips == 1)
                throw Error(
                    ExitCode::device,
                    fmt::format("the GPU has no memory for {} pixels at a time; a smaller --res or --crop needs "
                                "less, or free memory that other programs hold",
                                plan.strip_pixels));
        if (strips < wanted) {
            largest_part_ = size_t(strips) * plan.strip_pixels;
            notes_.push_back(fmt::format("the GPU's memory is short: {} pixels at a time instead of {}",
                                         size_t(strips) * plan.strip_pixels, size_t(wanted) * plan.strip_pixels));
        }
        return strips;
    }

    void start(const FramePlan& plan, int part) {
        for (size_t d = 0; d < workers_.size(); ++d)
            if (const Strips strips = plan.strips_of(part, int(d)); strips.count > 0)
                workers_[d]->start(plan, strips, (plan.first_slot + part) % DeviceWorker<Real>::slots);
    }

    /// Begins the expected frame behind the last part of this one, if it needs no other memory and no other kernel: a
    /// kernel's first launch waits for all that runs, and writes into a slot.
    void begin_early(const FramePlan& running) {
        if (expected_->settings != running.settings) return;
        FramePlan next = planned(expected_->camera, expected_->settings, running.first_slot + running.parts);
        if (next.mask != running.mask) return;
        begin(next);
        begun_ = next;
    }

    /// Starts the next part and puts this one into the film; false if that was stopped.
    bool finish(const FramePlan& plan, int part, Film& film, RenderProgress& progress) {
        if (part + 1 < plan.parts)
            start(plan, part + 1);
        else if (expected_)
            begin_early(plan);
        const int slot = (plan.first_slot + part) % DeviceWorker<Real>::slots;
        std::atomic<bool> stopped{false};
        tbb::parallel_for(size_t{0}, workers_.size(), [&](size_t d) {
            if (plan.strips_of(part, int(d)).count > 0 && !workers_[d]->fetch(slot, film, progress.stop))
                stopped = true;
        });
        if (stopped) return false;
        const uint64_t before = film.rays.total();
        film.rays = RayCounts();
        for (const auto& worker : workers_) film.rays.add(worker->totals.counts.rays);
        progress.rays += film.rays.total() - before;
        progress.pixels_done += plan.pixels_of(part);
        return true;
    }

    /// Stops and forgets everything that was started. All workers are stopped before any is waited for, since one GPU
    /// may have several.
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
    std::optional<FramePlan> begun_;
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
