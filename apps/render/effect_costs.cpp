#include "explain.h"

#include <bit>

#include "base/error.h"
#include "base/timing.h"
#include "scene/description/without_effect.h"

namespace cistula {
namespace {

/// A way to render the frame, and its times.
struct Variant {
    std::unique_ptr<Renderer> renderer;
    FrameSettings settings;
    Timing time;

    void run(const CameraFrame& camera, StepProgress& progress, bool counts) {
        progress.render.pixels_done = 0;
        progress.frame(static_cast<uint64_t>(settings.crop.width) * static_cast<uint64_t>(settings.crop.height));
        Film film;
        bool whole = false;
        const double all = seconds_of([&] { whole = renderer->render(camera, settings, film, progress.render); });
        progress.advance();
        if (!whole) throw Error(ErrorKind::interrupted, "interrupted");
        const double kernel = renderer->times().kernel;
        if (counts) time.runs.push_back((kernel > 0 ? kernel : all) * 1e3);
    }
};

}  // namespace

EffectCosts measure_effects(const SceneDescription& scene, const std::vector<EffectReason>& reasons, int frame,
                            const FrameSettings& settings, const MakeRenderer& make, StepProgress& progress, int runs) {
    const uint32_t needed = required_effects(reasons);
    progress.begin("compiling", std::popcount(needed));
    std::vector<Variant> variants;
    const auto add = [&](const SceneDescription& of) {
        variants.push_back({make(of), settings, {}});
        return variants.size() - 1;
    };
    add(scene);
    std::vector<std::pair<uint32_t, size_t>> taken_out;  // effect and its variant; 0: none
    for (const EffectReason& reason : reasons) {
        if (!reason.needed) continue;
        const auto less = without_effect(scene, reason.effect);
        taken_out.push_back({reason.effect, less ? add(*less) : 0});
        progress.advance();
    }
    const CameraFrame camera = camera_at(scene.camera, frame);
    progress.begin("measuring", static_cast<double>(variants.size()) * (runs + 1));
    for (int run = -1; run < runs; ++run)
        for (Variant& variant : variants) variant.run(camera, progress, run >= 0);

    EffectCosts result{variants[0].time.median(), runs, {}};
    for (const auto& [effect, variant] : taken_out) {
        EffectCost cost{effect, std::nullopt};
        if (variant != 0) cost.share = 1 - variants[variant].time.median() / variants[0].time.median();
        result.costs.push_back(cost);
    }
    return result;
}

}  // namespace cistula
