// What --explain=measure adds: how much of a frame's time each effect takes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/step_progress.h"
#include "scene/compile/required_effects.h"
#include "scene/description/description.h"
#include "scene/film/renderer.h"

namespace cistula {

/// What one needed effect costs: the `share` of the frame's time that goes where it is taken out; none where it cannot
/// be taken out alone.
struct EffectCost {
    uint32_t effect = 0;
    std::optional<double> share;
};

struct EffectCosts {
    double frame_ms = 0;  // the median of `runs` frames with all that is needed
    int runs = 0;
    std::vector<EffectCost> costs;  // of the needed effects, in the order of the bits
};

using MakeRenderer = std::function<std::unique_ptr<Renderer>(const SceneDescription&)>;

/// Renders frame `frame` with and without each needed effect in turns, `runs` times after a warm-up, and compares
/// medians: of kernels where the renderer has devices, else of whole frames. Both kinds of shadow are taken out
/// together.
EffectCosts measure_effects(const SceneDescription& scene, const std::vector<EffectReason>& reasons, int frame,
                            const FrameSettings& settings, const MakeRenderer& make, StepProgress& progress,
                            int runs = 7);

}  // namespace cistula
