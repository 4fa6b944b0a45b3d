// The table printed by --explain.
#pragma once

#include <string>
#include <vector>

#include "effect_costs.h"
#include "scene/compile/required_effects.h"

namespace cistula {

/// A table of effects, one per line: its name, whether the scene needs it, whether the code to be run includes it, and
/// why. Then the compiled mask to be run and what it leaves out. With `costs` also each effect's share of the time.
std::string explain_table(const std::string& scene, const std::vector<EffectReason>& reasons,
                          const EffectCosts* costs = nullptr);

}  // namespace cistula
