#include "bench/gpu/effect_times.h"

#include <fmt/format.h>

#include <array>

#include "backend_cuda/cuda_renderer.h"
#include "bench/effect_scenes.h"
#include "cistula/real.h"
#include "scene/camera_path.h"
#include "scene/compiled_scene.h"
#include "scene/film_picture.h"

namespace cistula::bench {
namespace {

constexpr int warm_up = 3;

struct Choice {
    const char* name;
    uint32_t effects;  // as FrameSettings::effects
    std::vector<double> kernel;
    uint32_t ran;
};

template <class Real>
void time_scene(GpuRecord& record, const EffectScene& scene, int supersample, int runs) {
    const auto renderer = make_cuda_renderer<Real>(compile_scene<Real>(scene.scene));
    FrameSettings settings;
    settings.set_size(1280, 720);
    settings.depth = scene.scene.depth;
    settings.supersample = supersample;
    std::array<Choice, 2> choices = {Choice{"auto", 0, {}, 0}, Choice{"all", all_effects, {}, 0}};
    std::array<std::string, 2> hashes;
    Film film;
    for (int run = -warm_up; run < runs; ++run)
        for (size_t i = 0; i < choices.size(); ++i) {
            RenderProgress progress;
            settings.effects = choices[i].effects;
            renderer->render(camera_at(scene.scene.camera, 0), settings, film, progress);
            if (run >= 0) choices[i].kernel.push_back(renderer->times().kernel * 1e3);
            choices[i].ran = renderer->effects();
            if (run == -warm_up) hashes[i] = film_hash(film);
        }
    const std::string name =
        fmt::format("effects/{}/{}x{}/{}", scene.name, supersample, supersample, RealTraits<Real>::name);
    for (const Choice& choice : choices)
        record.add_times(name + "/" + choice.name, choice.kernel, {{"mask", choice.ran}, {"rays", film.rays.total()}});
    record.add_parity(name, film.pixels.size(), hashes[0] == hashes[1] ? 0 : 1);
}

}  // namespace

void time_effects(GpuRecord& record, const std::string& folder, int runs) {
    // A frame of one sample takes so little of simple scenes that the memory of its pixels counts as much as the kernel.
    for (const EffectScene& scene : effect_scenes(folder))
        for (const int supersample : {1, 4}) {
            if (supersample > 1 && scene.scene.depth > 4) continue;
            time_scene<float>(record, scene, supersample, runs);
            time_scene<double>(record, scene, supersample, runs);
        }
    Json kernels = Json::array();
    for (const KernelResources& k : kernel_resources())
        kernels.push_back({{"kernel", k.name},
                           {"precision", k.precision},
                           {"path", k.path},
                           {"mask", k.mask},
                           {"registers", k.registers},
                           {"local_bytes", k.local_bytes},
                           {"blocks_per_multiprocessor", k.blocks},
                           {"occupancy", k.occupancy}});
    record.add("kernels", std::move(kernels));
}

}  // namespace cistula::bench
