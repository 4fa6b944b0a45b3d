// The table printed by --explain.
#pragma once

#include <string>
#include <vector>

#include "effect_costs.h"
#include "scene/compile/materials/required_effects.h"
#include "sequence/backends.h"

namespace cistula {

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
