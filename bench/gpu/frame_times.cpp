#include "bench/gpu/frame_times.h"

#include <fmt/format.h>

#include <chrono>

#include "backend_cuda/host/cuda_renderer.h"
#include "scene/description/camera_path.h"
#include "scene/film/film_picture.h"
#include "scene/readers/read_scene.h"

namespace cistula::bench {
namespace {

FrameSettings settings_of(int width, int height, int depth, int supersample) {
    FrameSettings settings;
    settings.set_size(width, height);
    settings.depth = depth;
    settings.supersample = supersample;
    return settings;
}

/// Times of the runs after warm-up, in milliseconds.
struct FrameRuns {
    std::vector<double> kernel, transfer, frame;
    Film film;  // the last
};

FrameRuns timed(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings, int warm_up,
                int runs) {
    FrameRuns result;
    for (int run = -warm_up; run < runs; ++run) {
        RenderProgress progress;
        const auto start = std::chrono::steady_clock::now();
        renderer.render(camera_at(scene.camera, 0), settings, result.film, progress);
        if (run < 0) continue;
        result.frame.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() * 1e3);
        result.kernel.push_back(renderer.times().kernel * 1e3);
        result.transfer.push_back(renderer.times().transfer * 1e3);
    }
    return result;
}

template <class Real>
void time_one(GpuRecord& record, const SceneDescription& scene, int width, int height, int depth, int runs) {
    const auto renderer = make_cuda_renderer<Real>(compile_scene<Real>(scene));
    const FrameRuns r = timed(*renderer, scene, settings_of(width, height, depth, 1), 3, runs);
    const RayCounts& rays = r.film.rays;
    record.add_times(fmt::format("benchmark.json/{}x{}/depth:{}/{}", width, height, depth,
                                 sizeof(Real) == sizeof(float) ? "float" : "double"),
                     r.kernel,
                     {{"rays", rays.total()},
                      {"surfaces", rays.primary + rays.reflected + rays.transmitted},
                      {"rays_per_second", double(rays.total()) / (median_of(r.kernel) * 1e-3)},
                      {"transfer_ms", median_of(r.transfer)}});
}

}  // namespace

void time_devices(GpuRecord& record, const std::string& folder, int runs) {
    const SceneDescription scene = read_scene(folder + "/scenes/benchmark.json");
    const std::shared_ptr<const CompiledScene<float>> compiled = compile_scene<float>(scene);
    const size_t present = list_cuda_devices().size();
    constexpr int samples = 6;  // along a pixel's side: some 100 ms on an H200
    std::string hash;
    for (size_t count = 1; count <= present; count *= 2) {
        CudaOptions options;
        options.devices.clear();
        for (size_t d = 0; d < count; ++d) options.devices.push_back(int(d));
        const auto renderer = make_cuda_renderer<float>(compiled, options);
        const FrameRuns r = timed(*renderer, scene, settings_of(3840, 2160, 8, samples), 1, runs);
        record.add_times(fmt::format("benchmark.json/3840x2160/{0}x{0}/depth:8/float/devices:{1}", samples, count),
                         r.kernel, {{"rays", r.film.rays.total()}, {"frame_ms", median_of(r.frame)}});
        if (count == 1)
            hash = film_hash(r.film);
        else
            record.add_parity(fmt::format("devices:{}", count), r.film.pixels.size(),
                              film_hash(r.film) == hash ? 0 : 1);
    }
}

void time_frames(GpuRecord& record, const std::string& folder, int runs) {
    const SceneDescription scene = read_scene(folder + "/scenes/benchmark.json");
    for (const int depth : {4, 8}) {
        time_one<float>(record, scene, 3840, 2160, depth, runs);
        time_one<double>(record, scene, 3840, 2160, depth, runs);
    }
    time_one<float>(record, scene, 640, 480, 8, runs);
    time_one<double>(record, scene, 640, 480, 8, runs);
}

}  // namespace cistula::bench
