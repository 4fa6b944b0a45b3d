#include "bench/gpu/frame_times.h"

#include <fmt/format.h>

#include <chrono>

#include "backend_cuda/cuda_renderer.h"
#include "scene/camera_path.h"
#include "scene/film_picture.h"
#include "scene/read_scene.h"

namespace cistula::bench {
namespace {

constexpr int warm_up = 3;

template <class Real>
void time_one(GpuRecord& record, const SceneDescription& scene, int width, int height, int depth, int runs, int split) {
    CudaOptions options;
    options.split = split;
    const auto renderer = make_cuda_renderer<Real>(compile_scene<Real>(scene), options);
    FrameSettings settings;
    settings.full_width = width;
    settings.full_height = height;
    settings.crop = {0, 0, width, height};
    settings.depth = depth;
    std::vector<double> kernel, transfer;
    Film film;
    for (int run = -warm_up; run < runs; ++run) {
        RenderProgress progress;
        renderer->render(camera_at(scene.camera, 0), settings, film, progress);
        if (run < 0) continue;
        kernel.push_back(renderer->times().kernel * 1e3);
        transfer.push_back(renderer->times().transfer * 1e3);
    }
    record.add_times(fmt::format("benchmark.json/{}x{}/depth:{}/{}/split:{}", width, height, depth,
                                 sizeof(Real) == sizeof(float) ? "float" : "double", split),
                     kernel,
                     {{"rays", film.rays.total()},
                      {"surfaces", film.rays.primary + film.rays.reflected + film.rays.transmitted},
                      {"rays_per_second", double(film.rays.total()) / (median_of(kernel) * 1e-3)},
                      {"transfer_ms", median_of(transfer)}});
}

}  // namespace

void time_devices(GpuRecord& record, const std::string& folder, int runs) {
    const SceneDescription scene = read_scene(folder + "/scenes/benchmark.json");
    const std::shared_ptr<const CompiledScene<float>> compiled = compile_scene<float>(scene);
    FrameSettings settings;
    settings.full_width = 3840;
    settings.full_height = 2160;
    settings.crop = {0, 0, 3840, 2160};
    settings.depth = 8;
    settings.supersample = 4;
    const size_t present = list_cuda_devices().size();
    std::string hash;
    for (size_t count = 1; count <= present; count *= 2) {
        CudaOptions options;
        options.devices.clear();
        for (size_t d = 0; d < count; ++d) options.devices.push_back(int(d));
        const auto renderer = make_cuda_renderer<float>(compiled, options);
        std::vector<double> kernel, whole;
        Film film;
        for (int run = -1; run < runs; ++run) {
            RenderProgress progress;
            const auto start = std::chrono::steady_clock::now();
            renderer->render(camera_at(scene.camera, 0), settings, film, progress);
            if (run < 0) continue;
            whole.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() * 1e3);
            kernel.push_back(renderer->times().kernel * 1e3);
        }
        record.add_times(fmt::format("benchmark.json/3840x2160/4x4/depth:8/float/devices:{}", count), kernel,
                         {{"rays", film.rays.total()}, {"frame_ms", median_of(whole)}});
        if (count == 1)
            hash = film_hash(film);
        else
            record.add_parity(fmt::format("devices:{}", count), film.pixels.size(), film_hash(film) == hash ? 0 : 1);
    }
}

void time_frames(GpuRecord& record, const std::string& folder, int runs, int split) {
    const SceneDescription scene = read_scene(folder + "/scenes/benchmark.json");
    for (const int depth : {4, 8}) {
        time_one<float>(record, scene, 3840, 2160, depth, runs, split);
        time_one<double>(record, scene, 3840, 2160, depth, runs, split);
    }
    time_one<float>(record, scene, 640, 480, 8, runs, split);
    time_one<double>(record, scene, 640, 480, 8, runs, split);
}

}  // namespace cistula::bench
