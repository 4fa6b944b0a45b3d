#include "bench/gpu/frame_times.h"

#include <fmt/format.h>

#include "backend_cuda/cuda_renderer.h"
#include "scene/camera_path.h"
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
