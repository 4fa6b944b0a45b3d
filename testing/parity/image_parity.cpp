#include "testing/parity/image_parity.h"

#include <fmt/format.h>

#include <vector>

#include "backend_cuda/host/cuda_renderer.h"
#include "backend_embree/embree/embree_renderer.h"
#include "cistula/model/effects.h"
#include "render/record/film_difference.h"
#include "scene/readers/read_scene.h"
#include "testing/support/golden.h"
#include "testing/support/golden_suite.h"
#include "verify/scenes/generated_scene.h"

namespace cistula::bench {
namespace {

/// The first pixel that differs, for the record.
Json first_pixel(const FilmDifference& difference, const Film& cpu, const Film& gpu) {
    if (!difference.first) return Json::object();
    const size_t i = *difference.first;
    return {{"x", i % size_t(cpu.rect.width)},
            {"y", i / size_t(cpu.rect.width)},
            {"cpu", cpu.pixels[i].radiance},
            {"gpu", gpu.pixels[i].radiance}};
}

template <class Real>
void check(GpuRecord& record, const std::string& name, const SceneDescription& scene, const FrameSettings& settings,
           const std::string& hash) {
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
    const Film cpu = golden::render_with(*make_embree_renderer<Real>(compiled, {.always_tree = true}), scene, settings);
    const char* precision = sizeof(Real) == sizeof(float) ? "float" : "double";
    FrameSettings with_all = settings;
    with_all.effects = all_effects;
    const auto compare = [&](const CudaOptions& options, const FrameSettings& how, const std::string& what) {
        const Film gpu = golden::render_with(*make_cuda_renderer<Real>(compiled, options), scene, how);
        FilmDifference d = film_difference(cpu, gpu);
        if (!hash.empty()) {
            ++d.compared;
            d.differing += film_hash(gpu) != hash;
        }
        record.add_parity(fmt::format("{}/{}/{}/{}", name, precision, options.always_tree ? "tree" : "chosen", what),
                          d.compared, d.differing, first_pixel(d, cpu, gpu));
    };
    for (const bool always_tree : {false, true}) {
        CudaOptions options;
        options.always_tree = always_tree;
        compare(options, settings, "needed_effects");
        compare(options, with_all, "all_effects");
    }
}

/// Compares adaptive sampling, on small frames since their pixels take many samples.
void check_adaptive(GpuRecord& record, const std::string& name, const SceneDescription& scene, FrameSettings settings,
                    double target) {
    settings.set_size(settings.full_width / 2, settings.full_height / 2);
    settings.target_error = target;
    check<float>(record, name + "/adaptive", scene, settings, "");
    check<double>(record, name + "/adaptive", scene, settings, "");
}

}  // namespace

void check_scenes(GpuRecord& record, const std::string& folder) {
    for (const std::string& name : golden::scene_names(folder + "/scenes")) {
        const SceneDescription scene = read_scene(folder + "/scenes/" + name + ".json");
        const FrameSettings settings = golden::settings_for(scene);
        check<float>(record, "scenes/" + name, scene, settings, golden::expected(folder, name, "float").film_hash);
        check<double>(record, "scenes/" + name, scene, settings, golden::expected(folder, name, "double").film_hash);
        check_adaptive(record, "scenes/" + name, scene, settings, 0.01);
    }
}

void check_generated(GpuRecord& record, const std::string& folder, uint64_t count) {
    for (uint64_t seed = 0; seed < count; ++seed) {
        const SceneDescription scene = generated_scene(seed, folder + "/scenes");
        const FrameSettings settings = generated_settings(scene);
        check<float>(record, fmt::format("generated/{}", seed), scene, settings, "");
        check<double>(record, fmt::format("generated/{}", seed), scene, settings, "");
        if (seed % 4 == 0) check_adaptive(record, fmt::format("generated/{}", seed), scene, settings, 0.05);
    }
}

}  // namespace cistula::bench
