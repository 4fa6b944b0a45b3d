#include "bench/gpu/ray_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "backend_cuda/host/cuda_resources.h"
#include "bench/bumpy_scene.h"
#include "bench/gpu/ray_kernels.h"
#include "scene/compile/scene_arena.h"
#include "scene/frame/frame_view.h"
#include "testing/parity/ray_compare.h"

namespace cistula::bench {
namespace {

constexpr int warm_up = 3;
constexpr uint32_t rays_at_once = uint32_t{1} << 18;  // compared
constexpr int unwritten = 0xee;                       // bytes of what no kernel wrote must not look right

/// The light is beside the camera, so that some of the sphere is in shadow.
SceneDescription lit_scene() {
    SceneDescription scene = bumpy_scene(40);
    LightDescription light;
    light.position = {4, -3, 3};
    light.place = "/lights/0";
    scene.lights.push_back(light);
    return scene;
}

/// Calls visit(array) for each.
template <class Real, class Visit>
void for_each_array(RayArrays<Real>& arrays, const Visit& visit) {
    visit(arrays.primary);
    visit(arrays.bounced);
    visit(arrays.shadow);
    visit(arrays.primary_hits);
    visit(arrays.bounced_hits);
    visit(arrays.light);
}

/// One block of memory for all arrays.
template <bool on_device, class Real>
RayArrays<Real> arrays_in(CudaMemory<on_device>& memory, size_t count) {
    constexpr size_t alignment = 256;
    RayArrays<Real> arrays;
    size_t bytes = 0;
    const auto place = [&]<class T>(T*&) {
        const size_t offset = bytes;
        bytes += (count * sizeof(T) + alignment - 1) / alignment * alignment;
        return offset;
    };
    for_each_array(arrays, place);
    memory.reserve(bytes);
    bytes = 0;
    for_each_array(arrays, [&]<class T>(T*& array) {
        array = reinterpret_cast<T*>(memory.template as<std::byte>() + place(array));
    });
    return arrays;
}

template <class Real>
class RayBenchmark {
  public:
    explicit RayBenchmark(const SceneDescription& scene)
        : compiled_(compile_scene<Real>(scene)), view_(compiled_->view()) {
        const auto start = std::chrono::steady_clock::now();
        tree_ = facet_tree(view_);
        tree_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        tree_.put_into(view_);
        FrameSettings settings;
        settings.full_width = picture_width;
        settings.full_height = picture_height;
        job_.frame = frame_view(*compiled_, camera_at(scene.camera, 0), settings);
        camera_solids(view_, BvhIntersector<Real>{view_}, job_.frame.camera.position, job_.frame.camera_media);
        if (!job_.frame.camera_media.empty() || view_.solids.size != 1 || view_.lights.size != 1)
            throw Error(ExitCode::failed, "the ray benchmark needs one mesh, a camera outside of it, and a light");
        const SceneArena<Real> arena(view_);
        arena_bytes_ = arena.bytes().size();
        arena_.reserve(arena_bytes_);
        CISTULA_CUDA_CHECK(cudaMemcpy(arena_.as<void>(), arena.bytes().data(), arena_bytes_, cudaMemcpyHostToDevice));
        job_.scene = arena.at(arena_.as<void>());
        job_.arrays = arrays_in<true, Real>(memory_, ray_count);
        CISTULA_CUDA_CHECK(cudaMemset(memory_.as<void>(), unwritten, memory_.size()));
        CISTULA_CUDA_CHECK(cudaDeviceSynchronize());
    }

    void run(GpuRecord& record, int runs) {
        launch_rays(RayStep::primary_rays, job_, stream_);
        const std::vector<double> primary = times_of(RayStep::primary_hits, runs);
        launch_rays(RayStep::further_rays, job_, stream_);
        const std::vector<double> bounced = times_of(RayStep::bounced_hits, runs);
        const std::vector<double> shadow = times_of(RayStep::light, runs);
        const RayTallies tallies = compare();
        add(record, "primary", RayStep::primary_hits, primary, tallies.primary);
        add(record, "bounced", RayStep::bounced_hits, bounced, tallies.bounced);
        add(record, "occlusion", RayStep::light, shadow, tallies.shadow);
    }

  private:
    /// In milliseconds.
    std::vector<double> times_of(RayStep step, int runs) {
        std::vector<double> times;
        for (int run = -warm_up; run < runs; ++run) {
            CISTULA_CUDA_CHECK(cudaEventRecord(begin_, stream_));
            launch_rays(step, job_, stream_);
            CISTULA_CUDA_CHECK(cudaEventRecord(end_, stream_));
            CISTULA_CUDA_CHECK(cudaEventSynchronize(end_));
            if (run >= 0) times.push_back(end_.since(begin_));
        }
        return times;
    }

    RayTallies compare() {
        PinnedMemory memory;
        RayArrays<Real> theirs = arrays_in<false, Real>(memory, rays_at_once);
        RayTallies all;
        for (uint32_t first = 0; first < ray_count; first += rays_at_once) {
            const uint32_t count = std::min(rays_at_once, ray_count - first);
            const auto fetch = [&]<class T>(T* to, const T* from) {
                from += first;
                CISTULA_CUDA_CHECK(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, stream_));
            };
            fetch(theirs.primary, job_.arrays.primary);
            fetch(theirs.bounced, job_.arrays.bounced);
            fetch(theirs.shadow, job_.arrays.shadow);
            fetch(theirs.primary_hits, job_.arrays.primary_hits);
            fetch(theirs.bounced_hits, job_.arrays.bounced_hits);
            fetch(theirs.light, job_.arrays.light);
            CISTULA_CUDA_CHECK(cudaStreamSynchronize(stream_));
            all.add(compare_rays(view_, job_.frame, first, count, theirs));
        }
        return all;
    }

    void add(GpuRecord& record, const std::string& kind, RayStep step, const std::vector<double>& times,
             const RayTally& tally) const {
        const std::string name = fmt::format("bumpy_sphere/{}/{}", kind, RealTraits<Real>::name);
        const KernelFacts facts = ray_kernel_facts<Real>(step);
        record.add_times(name, times,
                         {{"rays", tally.rays},
                          {"hits", tally.hits},
                          {"rays_per_second", double(tally.rays) / (median_of(times) * 1e-3)},
                          {"triangles", triangles()},
                          {"registers", facts.registers},
                          {"local_bytes", facts.local_bytes},
                          {"threads_per_multiprocessor", facts.blocks * facts.block_rays},
                          {"tree_build_seconds", tree_seconds_},
                          {"arena_bytes", arena_bytes_}});
        Json more = Json::object();
        if (tally.differing != 0) {
            int x, y;
            ray_pixel(tally.first_differing, x, y);
            more["first"] = {{"x", x}, {"y", y}};
        }
        record.add_parity(name, ray_count, tally.differing, std::move(more));
    }

    uint64_t triangles() const {
        uint64_t count = 0;
        for (const Cluster<Real>& cluster : view_.clusters) count += cluster.count;
        return count;
    }

    std::unique_ptr<CompiledScene<Real>> compiled_;
    SceneView<Real> view_;
    FacetTree<Real> tree_;
    double tree_seconds_ = 0;
    size_t arena_bytes_ = 0;
    CudaStream stream_;
    CudaEvent begin_, end_;
    DeviceMemory arena_, memory_;
    RayJob<Real> job_;
};

}  // namespace

void time_rays(GpuRecord& record, int runs) {
    const SceneDescription scene = lit_scene();
    RayBenchmark<float>(scene).run(record, runs);
    RayBenchmark<double>(scene).run(record, runs);
}

}  // namespace cistula::bench
