#include "backend_cuda/host/cuda_renderer.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <deque>

#include "backend_cuda/host/device_worker.h"
#include "base/default_rounding.h"
#include "base/stages.h"
#include "render/frame/frame_view.h"
#include "render/frame/ray_questions.h"
#include "render/record/film_difference.h"

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
        {
            const InStage stage(Stage::device);
            const std::vector<CudaDevice> known = list_cuda_devices();
            for (const int index : options_.devices) require(known, index);
        }
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
        const DefaultRounding rounding;
        notes_.clear();
        times_ = {};
        prepare_film(film, settings, *scene_, camera);
        const bool others_follow = !expected_.empty();
        if (begun_.empty() || !same(begun_.front().camera, camera) || begun_.front().settings != settings) {
            if (!begun_.empty())
                drop();
            else if (is_announced_)
                expected_.pop_front();
            FramePlan fresh = planned(camera, settings, others_follow);
            if (!has_kernel(fresh)) {
                take_tree();
                fresh = planned(camera, settings, others_follow);
            }
            reserve(fresh);
            begin(std::move(fresh));
        }
        const FramePlan plan = begun_.front();
        begun_.pop_front();
        if (!plan.fits) film.flags |= flag_media_overflow;
        effects_ = effect_masks[plan.mask];
        for (auto& worker : workers_) worker->totals = {};
        bool whole = true;
        int part = 0;
        try {
            for (; part < plan.parts && whole && !is_unreliable(film.flags); ++part)
                whole = !progress.stop && finish(plan, part, film, progress);
        } catch (...) {
            drop();
            throw;
        }
        if (!whole || part < plan.parts) drop();
        if (!whole) return false;
        if (settings.adaptive()) film.totals = totals_of(film);
        for (const auto& worker : workers_) {
            if (!settings.adaptive()) film.totals.add(worker->totals.counts.totals);
            times_.kernel = std::max(times_.kernel, worker->totals.kernel_seconds);
            times_.transfer = std::max(times_.transfer, worker->totals.transfer_seconds);
        }
        is_announced_ = !begun_.empty() || !expected_.empty();
        return !progress.stop;
    }

    RayHits intersect(std::span<const glm::dvec3> origins, std::span<const glm::dvec3> directions) override {
        take_tree();
        return ray_hits<Real>(*scene_, origins, directions,
                              [&](auto questions, auto answers) { workers_.front()->answer(questions, answers); });
    }
    std::vector<glm::dvec3> transmittance(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) override {
        take_tree();
        return segment_shares<Real>(*scene_, from, to,
                                    [&](auto questions, auto shares) { workers_.front()->answer(questions, shares); });
    }

    void expect(const CameraFrame& camera, const FrameSettings& settings) override {
        expected_.push_back({camera, settings});
    }
    size_t frames_ahead() const override { return workers_.size(); }
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
            throw Error(ErrorKind::device, "there is no such GPU",
                        fmt::format("this machine has 0 to {}", known.size() - 1))
                .of("device", fmt::format("{}", index));
        if (!known[size_t(index)].obstacle.empty())
            throw Error(ErrorKind::device, known[size_t(index)].name + ": " + known[size_t(index)].obstacle)
                .of("device", fmt::format("{}", index));
    }

    /// Brings the scene to the devices in the form that a path needs.
    void take_path(DevicePath path) {
        path_ = path;
        if (path_ == DevicePath::tree) {
            const InStage stage(Stage::tree);
            tree_ = facet_tree(view_);
            tree_.put_into(view_);
        }
        const InStage stage(Stage::upload);
        const SceneArena<Real> arena(view_);
        bytes_ = arena.bytes().size();
        workers_.clear();
        workers_.resize(options_.devices.size());
        tbb::parallel_for(size_t{0}, workers_.size(), [&](size_t d) {
            use_device(options_.devices[d]);
            workers_[d] = std::make_unique<DeviceWorker<Real>>(options_.devices[d], arena, view_, path_);
        });
    }

    /// Takes the path that serves whatever is asked for.
    void take_tree() {
        if (path_ == DevicePath::tree) return;
        drop();
        take_path(DevicePath::tree);
    }

    /// The plan of a frame, in parts as large as they are to be. Where others follow, so that no device waits for want
    /// of frames, a frame of one part is a single device's: to share it would take as much time of the host for each.
    FramePlan planned(const CameraFrame& camera, const FrameSettings& settings, bool others_follow) const {
        const InStage stage(Stage::plan);
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
        const PixelRect& rect = settings.crop;
        constexpr int width = BlockPlan::width;
        plan.strips = (rect.height + strip_rows - 1) / strip_rows;
        plan.strip_pixels = size_t((rect.width + width - 1) / width * width) * strip_rows;
        size_t most = std::max<size_t>(part_samples / (plan.strip_pixels * plan.samples()), 1);
        if (largest_part_ != 0) most = std::clamp<size_t>(largest_part_ / plan.strip_pixels, 1, most);
        plan.devices = int(workers_.size());
        if (others_follow && size_t(plan.strips) <= most) {
            plan.devices = 1;
            plan.first_device = next_device_;
        }
        divide(plan, int(std::min(most, size_t(plan.strips))));
        return plan;
    }

    /// Whether there is a kernel of the mask for the path that the scene has (launch_mask).
    bool has_kernel(const FramePlan& plan) const {
        if (path_ == DevicePath::ball_loop) return plan.mask == ball_mask;
        return path_ == DevicePath::tree || plan.mask != layered_mask;
    }

    /// Divides a frame into parts of `strips` strips for each device, at most.
    static void divide(FramePlan& plan, int strips) {
        plan.part_strips = std::min(strips, plan.strips_per_device());
        plan.parts = (plan.strips_per_device() + plan.part_strips - 1) / plan.part_strips;
    }

    /// Allocates memory for a frame's parts on all devices, or for parts of half as many strips until it fits.
    void reserve(FramePlan& plan) {
        const InStage stage(Stage::device);
        const size_t wanted = size_t(plan.part_strips) * plan.strip_pixels;
        const auto has_room = [&] {
            std::atomic<bool> all{true};
            tbb::parallel_for(size_t{0}, workers_.size(), [&](size_t d) {
                if (!workers_[d]->reserve(part_pixels(plan), options_.memory_limit, plan)) all = false;
            });
            return all.load();
        };
        while (!has_room()) {
            if (plan.part_strips == 1)
                throw Error(ErrorKind::device,
                            fmt::format("the GPU has no memory for {} pixels at a time", plan.strip_pixels),
                            "a smaller `resolution` or `crop` needs less, or free memory that other programs hold");
            divide(plan, (plan.part_strips + 1) / 2);
        }
        if (part_pixels(plan) == wanted) return;
        largest_part_ = part_pixels(plan);
        notes_.push_back(
            fmt::format("the GPU's memory is short: {} pixels at a time instead of {}", largest_part_, wanted));
    }
    static size_t part_pixels(const FramePlan& plan) { return size_t(plan.part_strips) * plan.strip_pixels; }

    /// Starts the first part of a frame for which there is memory.
    void begin(FramePlan plan) {
        start(plan, 0);
        next_device_ = (plan.first_device + plan.devices) % int(workers_.size());
        begun_.push_back(std::move(plan));
    }

    DeviceWorker<Real>& worker(const FramePlan& plan, int d) { return *workers_[size_t(plan.first_device + d)]; }

    void start(const FramePlan& plan, int part) {
        for (int d = 0; d < plan.devices; ++d)
            if (const Strips strips = plan.strips_of(part, d); strips.count > 0) worker(plan, d).start(plan, strips);
    }

    /// Begins expected frames behind the last part of the one that runs, for as long as their devices have free slots.
    /// They must need no other memory and no other kernel: a kernel's first launch waits for all that runs, and writes
    /// into a slot.
    void begin_early() {
        const auto is_full = [](const auto& worker) { return worker->in_work() == DeviceWorker<Real>::slots; };
        while (!expected_.empty() && (begun_.empty() || begun_.back().parts == 1) &&
               !std::all_of(workers_.begin(), workers_.end(), is_full)) {
            FramePlan next = planned(expected_.front().camera, expected_.front().settings, true);
            const auto first = workers_.begin() + next.first_device;
            if (std::any_of(first, first + next.devices, is_full)) return;
            const auto is_ready = [&](const auto& worker) { return worker->is_ready(part_pixels(next), next); };
            if (!has_kernel(next) || !std::all_of(workers_.begin(), workers_.end(), is_ready)) return;
            begin(std::move(next));
            expected_.pop_front();
        }
    }

    /// Starts the next part and puts this one into the film; false if that was stopped.
    bool finish(const FramePlan& plan, int part, Film& film, RenderProgress& progress) {
        if (part + 1 < plan.parts)
            start(plan, part + 1);
        else
            begin_early();
        std::atomic<bool> stopped{false};
        tbb::parallel_for(0, plan.devices, [&](int d) {
            if (plan.strips_of(part, d).count > 0 && !worker(plan, d).fetch(film, progress.stop)) stopped = true;
        });
        if (stopped) return false;
        const uint64_t before = film.rays.total();
        film.rays = RayCounts();
        for (const auto& worker : workers_) {
            film.rays.add(worker->totals.counts.rays);
            film.flags |= worker->totals.counts.flags;
        }
        progress.rays += film.rays.total() - before;
        progress.pixels_done += plan.pixels_of(part);
        return true;
    }

    /// Stops and forgets everything that was started. All workers are stopped before any is waited for, since one GPU
    /// may have several.
    void drop() {
        for (auto& worker : workers_) worker->stop();
        for (auto& worker : workers_) worker->wait();
        begun_.clear();
        expected_.clear();
        is_announced_ = false;
    }

    std::shared_ptr<const CompiledScene<Real>> scene_;
    const CudaOptions options_;
    SceneView<Real> view_;
    FacetTree<Real> tree_;
    DevicePath path_;
    std::vector<std::unique_ptr<DeviceWorker<Real>>> workers_;
    std::deque<Request> expected_;  // announced and not begun
    std::deque<FramePlan> begun_;   // in the order in which they are to be rendered
    bool is_announced_ = false;     // the next frame that is asked for is the first of these
    int next_device_ = 0;           // of frames that are not shared
    RenderTimes times_;
    std::vector<std::string> notes_;
    size_t bytes_ = 0;
    size_t largest_part_ = 0;
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
