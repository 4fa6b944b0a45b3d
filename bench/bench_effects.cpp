// What effects cost on the CPU that a scene does not call for, and what lights along edges cost: frames of 640x480, one
// sample, two threads.
#include <tbb/global_control.h>

#include "backend_embree/embree_renderer.h"
#include "effect_scenes.h"
#include "program.h"
#include "scene/camera_path.h"
#include "scene/error.h"

namespace cistula::bench {
namespace {

constexpr int threads = 2, repetitions = 9;

struct Work {
    std::unique_ptr<Renderer> renderer;
    CameraFrame camera;
    FrameSettings settings;
};

void time_frame(benchmark::State& state, Work& work, uint32_t effects) {
    FrameSettings settings = work.settings;
    settings.effects = effects;
    Film film;
    for (auto _ : state) {
        RenderProgress progress;
        work.renderer->render(work.camera, settings, film, progress);
        if (film.flags != 0)
            throw Error(ExitCode::failed, "the frame cannot be trusted: flags " + std::to_string(film.flags));
    }
    state.counters["rays"] = double(film.rays.total());
    state.counters["mask"] = work.renderer->effects();
}

template <class Real>
void add(const EffectScene& scene) {
    const auto work = std::make_shared<Work>();
    work->renderer = make_embree_renderer<Real>(std::shared_ptr<const CompiledScene<Real>>(compile_scene<Real>(scene.scene)));
    work->camera = camera_at(scene.scene.camera, 0);
    work->settings.set_size(640, 480);
    work->settings.depth = scene.scene.depth;
    for (const auto& [name, effects] : {std::pair{"auto", 0u}, std::pair{"all", all_effects}})
        benchmark::RegisterBenchmark(("effects/" + scene.name + "/" + RealTraits<Real>::name + "/" + name).c_str(),
                                     [work, effects = effects](benchmark::State& state) { time_frame(state, *work, effects); })
            ->MinTime(0.05)
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
}

void register_all(const std::vector<std::string>&) {
    for (const EffectScene& scene : effect_scenes(CISTULA_SOURCE_DIR)) {
        add<float>(scene);
        add<double>(scene);
    }
}

}  // namespace
}  // namespace cistula::bench

int main(int argc, char** argv) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, cistula::bench::threads);
    return cistula::bench::run_program(argc, argv, cistula::bench::repetitions, cistula::bench::register_all);
}
