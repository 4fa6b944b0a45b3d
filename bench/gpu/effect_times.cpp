#include "bench/gpu/effect_times.h"

#include <fmt/format.h>

#include <array>

#include "backend_cuda/host/cuda_renderer.h"
#include "bench/effect_scenes.h"
#include "cistula/model/effects.h"
#include "cistula/numerics/real.h"
#include "scene/compile/compiled_scene.h"
#include "scene/description/camera_path.h"
#include "scene/film/film_picture.h"

namespace cistula::bench {
namespace {

constexpr int warm_up = 3;

/// A frame's, and what its figures are named by.
struct Size {
    const char* name;
    int width, height, supersample;
};
constexpr Size one_sample = {"1x1", 1280, 720, 1}, sixteen_samples = {"4x4", 1280, 720, 4},
               large = {"3840x2160", 3840, 2160, 1};

struct Choice {
    const char* name;
    uint32_t effects;  // as FrameSettings::effects
    std::vector<double> kernel;
    uint32_t ran;
};

template <class Real>
void time_scene(GpuRecord& record, const EffectScene& scene, const Size& size, int runs) {
    const auto renderer = make_cuda_renderer<Real>(compile_scene<Real>(scene.scene));
    FrameSettings settings;
    settings.set_size(size.width, size.height);
    settings.depth = scene.scene.depth;
    settings.supersample = size.supersample;
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
    const std::string name = fmt::format("effects/{}/{}/{}", scene.name, size.name, RealTraits<Real>::name);
    for (const Choice& choice : choices)
        record.add_times(name + "/" + choice.name, choice.kernel, {{"mask", choice.ran}, {"rays", film.rays.total()}});
    record.add_parity(name, film.pixels.size(), hashes[0] == hashes[1] ? 0 : 1);
}

}  // namespace

void time_effects(GpuRecord& record, const std::string& folder, int runs) {
    // With one sample a small frame of a simple scene takes some ten microseconds, three of which are a kernel's begin
    // and end.
    const auto time_both = [&](const EffectScene& scene, const Size& size) {
        time_scene<float>(record, scene, size, runs);
        time_scene<double>(record, scene, size, runs);
    };
    for (const EffectScene& scene : effect_scenes(folder)) {
        time_both(scene, one_sample);
        if (scene.scene.depth > 4) continue;
        time_both(scene, sixteen_samples);
        if (scene.is_for_bars) time_both(scene, large);
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
