// The price of double, and of effects that a scene does not use: frames of scenes/benchmark.json, 640x480, two threads.
#include <tbb/global_control.h>

#include "backend_embree/embree_renderer.h"
#include "program.h"
#include "scene/error.h"
#include "scene/read_scene.h"

namespace cistula::bench {
namespace {

constexpr int width = 640, height = 480, threads = 2, repetitions = 7;

std::unique_ptr<Renderer> renderers[2];  // by Precision
CameraFrame camera;

void time_frame(benchmark::State& state, Precision precision, int depth, uint32_t effects) {
    Renderer& renderer = *renderers[size_t(precision)];
    FrameSettings settings;
    settings.set_size(width, height);
    settings.depth = depth;
    settings.effects = effects;
    Film film;
    for (auto _ : state) {
        RenderProgress progress;
        renderer.render(camera, settings, film, progress);
        if (film.flags != 0)
            throw Error(ExitCode::failed, "the frame cannot be trusted: flags " + std::to_string(film.flags));
    }
    state.counters["rays"] = double(film.rays.total());
    state.counters["rays_per_second"] =
        benchmark::Counter(double(film.rays.total()), benchmark::Counter::kIsIterationInvariantRate);
}

void register_all(const std::vector<std::string>&) {
    const SceneDescription scene = read_scene(scene_file("benchmark.json").string());
    camera = camera_at(scene.camera, 0);
    renderers[size_t(Precision::single_)] =
        make_embree_renderer<float>(std::shared_ptr<const CompiledScene<float>>(compile_scene<float>(scene)));
    renderers[size_t(Precision::double_)] =
        make_embree_renderer<double>(std::shared_ptr<const CompiledScene<double>>(compile_scene<double>(scene)));
    const auto add = [](const std::string& name, Precision precision, int depth, uint32_t effects) {
        benchmark::RegisterBenchmark(name.c_str(),
                                     [=](benchmark::State& state) { time_frame(state, precision, depth, effects); })
            ->MinTime(0.05)
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    };
    for (const int depth : {4, 16}) {
        const std::string suffix = "/depth:" + std::to_string(depth);
        add("benchmark.json/float" + suffix, Precision::single_, depth, 0);
        add("benchmark.json/double" + suffix, Precision::double_, depth, 0);
    }
    add("benchmark.json/float/all_effects/depth:4", Precision::single_, 4, all_effects);
}

}  // namespace
}  // namespace cistula::bench

int main(int argc, char** argv) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, cistula::bench::threads);
    return cistula::bench::run_program(argc, argv, cistula::bench::repetitions, cistula::bench::register_all);
}
