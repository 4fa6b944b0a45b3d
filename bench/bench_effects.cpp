// What effects cost on the CPU that a scene does not call for, and what lights along edges cost: frames of 640x480, one
// sample, two threads.
#include <tbb/global_control.h>

#include <set>

#include "backend_embree/embree/embree_renderer.h"
#include "cistula/model/effects.h"
#include "effect_scenes.h"
#include "program.h"
#include "scene/description/camera_path.h"

namespace cistula::bench {
namespace {

constexpr int threads = 2, repetitions = 9;

template <class Real>
void add(const EffectScene& scene) {
    const std::shared_ptr<Renderer> renderer = make_embree_renderer<Real>(compile_scene<Real>(scene.scene));
    FrameSettings settings;
    settings.set_size(640, 480);
    settings.depth = scene.scene.depth;
    for (const auto& [name, effects] : {std::pair{"auto", 0u}, std::pair{"all", all_effects}}) {
        settings.effects = effects;
        register_frames("effects/" + scene.name + "/" + RealTraits<Real>::name + "/" + name, renderer,
                        camera_at(scene.scene.camera, 0), settings);
    }
}

void register_all(const std::vector<std::string>&) {
    const std::set<std::string> chosen = {"opaque",      "opaque_floor", "mirrors", "benchmark",
                                          "edge_lights", "away",         "mesh"};
    for (const EffectScene& scene : effect_scenes(CISTULA_SOURCE_DIR)) {
        if (chosen.count(scene.name) == 0) continue;
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
