// The price of double: frames of scenes/benchmark.json, 640x480, two threads.
#include <tbb/global_control.h>

#include "backend_embree/embree/embree_renderer.h"
#include "base/error.h"
#include "program.h"
#include "scene/description/camera_path.h"
#include "scene/readers/read_scene.h"

namespace cistula::bench {
namespace {

constexpr int width = 640;
constexpr int height = 480;
constexpr int threads = 2;
constexpr int repetitions = 7;

/// Fails where a frame cannot be trusted.
void register_frames(const std::string& name, std::shared_ptr<Renderer> renderer, const CameraFrame& camera,
                     const FrameSettings& settings) {
    const auto time_frame = [=](benchmark::State& state) {
        Film film;
        for (auto _ : state) {
            RenderProgress progress;
            renderer->render(camera, settings, film, progress);
            if (film.flags != 0)
                throw Error(ErrorKind::failed, "the frame cannot be trusted: flags " + std::to_string(film.flags));
        }
        state.counters["rays_per_second"] =
            benchmark::Counter(double(film.rays.total()), benchmark::Counter::kIsIterationInvariantRate);
    };
    benchmark::RegisterBenchmark(name.c_str(), time_frame)->MinTime(0.05)->UseRealTime()->Unit(benchmark::kMillisecond);
}

template <class Real>
void add(const SceneDescription& scene) {
    const std::shared_ptr<Renderer> renderer = make_embree_renderer<Real>(compile_scene<Real>(scene));
    FrameSettings settings;
    settings.set_size(width, height);
    for (const int depth : {4, 16}) {
        settings.depth = depth;
        register_frames(std::string("benchmark.json/") + RealTraits<Real>::name + "/depth:" + std::to_string(depth),
                        renderer, camera_at(scene.camera, 0), settings);
    }
}

void register_all(const std::vector<std::string>&) {
    const SceneDescription scene = read_scene(scene_file("benchmark.json").string());
    add<float>(scene);
    add<double>(scene);
}

}  // namespace
}  // namespace cistula::bench

int main(int argc, char** argv) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, cistula::bench::threads);
    return cistula::bench::run_program(argc, argv, cistula::bench::repetitions, cistula::bench::register_all);
}
