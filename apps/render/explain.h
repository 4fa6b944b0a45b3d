// What --explain prints, and what --explain=measure measures for it: how much of a frame's time each effect takes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/step_progress.h"
#include "explain.h"
#include "render/renderer.h"
#include "scene/compile/materials/required_effects.h"
#include "scene/description/description.h"
#include "sequence/backends.h"

namespace cistula {

/// The cost of a required effect. `share`: the part of the frame's time saved without it; none if it cannot be removed
/// alone.
struct EffectCost {
    uint32_t effect = 0;
    std::optional<double> share;
};

struct EffectCosts {
    double frame_ms = 0;  // median of `runs` frames with all required effects
    int runs = 0;
    std::vector<EffectCost> costs;  // of the required effects, in bit order
};

using MakeRenderer = std::function<std::unique_ptr<Renderer>(const SceneDescription&)>;

/// Renders frame `frame` with and without each required effect in turns, `runs` times after a warm-up, and compares
/// medians of kernel times if the renderer has devices, else of whole frames. Both kinds of shadows are removed
/// together.
EffectCosts measure_effects(const SceneDescription& scene, const std::vector<EffectReason>& reasons, int frame,
                            const FrameSettings& settings, const MakeRenderer& make, StepProgress& progress,
                            int runs = 7);

/// What is explained of a scene.
struct Explanation {
    std::vector<EffectReason> effects;
    std::vector<std::string> overlaps;  // a sentence for each two transparent bodies that overlap
};
Explanation explain_scene(SceneSource source, Precision precision);

/// A table of effects, one per line: its name, whether the scene needs it, whether the code to be run includes it, and
/// why. Then what the code leaves out, and which transparent bodies overlap. With `costs` also each effect's share of
/// the time.
std::string explain_table(const std::string& scene, const Explanation& explanation, Backend backend,
                          const EffectCosts* costs = nullptr);

}  // namespace cistula
