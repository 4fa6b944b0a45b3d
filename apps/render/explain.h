// The table that --explain prints.
#pragma once

#include <string>
#include <vector>

#include "effect_costs.h"
#include "scene/compile/required_effects.h"

namespace cistula {

/// One line per effect: its name, whether the scene needs it, whether the code that would run has it, because of what.
/// Then which of the instantiated masks would run and what it leaves out. With `costs` also each one's share of the
/// time.
std::string explain_table(const std::string& scene, const std::vector<EffectReason>& reasons,
                          const EffectCosts* costs = nullptr);

}  // namespace cistula
