#include "bench/gpu/frame_times.h"

#include <fmt/format.h>

#include <algorithm>

#include "backend_cuda/host/cuda_renderer.h"
#include "render/record/film_difference.h"
#include "scene/description/camera_path.h"
#include "scene/readers/read_scene.h"

namespace cistula::bench {
namespace {

/// Adds the kernels' times of a frame and returns its film.
Film time_frame(GpuRecord& record, const std::string& name, Renderer& renderer, const SceneDescription& scene,
                const FrameSettings& settings, int runs) {
    constexpr int warm_up = 3;
    Film film;
    Timing time;
    for (int run = -warm_up; run < runs; ++run) {
        RenderProgress progress;
        renderer.render(camera_at(scene.camera, 0), settings, film, progress);
        if (run >= 0) time.runs.push_back(renderer.times().kernel * 1e3);
    }
    record.add_times(name, time, {{"rays", film.rays.total()}});
    return film;
}

FrameSettings settings_of(int width, int height, int depth, int supersample, const KeptParts& parts = {}) {
    FrameSettings settings;
    settings.set_size(width, height);
    settings.depth = depth;
    settings.supersample = supersample;
    settings.parts = parts;
    return settings;
}

}  // namespace

void time_frames(GpuRecord& record, const std::string& folder, int runs) {
    const SceneDescription scene = read_scene(folder + "/scenes/benchmark.json");
    const auto time_depths = [&]<class Real>(Real) {
        const auto renderer = make_cuda_renderer<Real>(compile_scene<Real>(scene));
        for (const int depth : {4, 8})
            time_frame(record, fmt::format("benchmark.json/3840x2160/depth:{}/{}", depth, RealTraits<Real>::name),
                       *renderer, scene, settings_of(3840, 2160, depth, 1, {false, false}), runs);
    };
    time_depths(float());
    time_depths(double());
    const SceneDescription balls = read_scene(folder + "/scenes/spheres.json");
    const auto renderer = make_cuda_renderer<float>(compile_scene<float>(balls));
    time_frame(record, "spheres.json/1280x720/3x3/depth:12/float", *renderer, balls, settings_of(1280, 720, 12, 3),
               std::min(runs, 5));
}

void time_devices(GpuRecord& record, const std::string& folder, int runs) {
    const SceneDescription scene = read_scene(folder + "/scenes/benchmark.json");
    const std::shared_ptr<const CompiledScene<float>> compiled = compile_scene<float>(scene);
    const size_t present = list_cuda_devices().size();
    constexpr int samples = 6;  // along a pixel's side: some 70 ms on an H200
    std::string hash;
    for (size_t count = 1; count <= present; count *= 2) {
        CudaOptions options;
        options.devices.clear();
        for (size_t d = 0; d < count; ++d) options.devices.push_back(int(d));
        const auto renderer = make_cuda_renderer<float>(compiled, options);
        const Film film = time_frame(
            record, fmt::format("benchmark.json/3840x2160/{0}x{0}/depth:8/float/devices:{1}", samples, count),
            *renderer, scene, settings_of(3840, 2160, 8, samples), runs);
        if (count == 1)
            hash = record_hash(film);
        else
            record.add_parity(fmt::format("devices:{}", count), film.pixels.size(), record_hash(film) == hash ? 0 : 1);
    }
}

}  // namespace cistula::bench
