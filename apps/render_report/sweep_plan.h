// Which settings are measured, and what each knob's own error is taken against.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "setting.h"

namespace cistula::report {

struct PlannedSetting {
    Setting setting;
    std::map<std::string, Setting> alone;  // knob -> the same frame without that knob's error
};

/// A knob as the page shows it.
struct Knob {
    std::string name;   // the key of PlannedSetting::alone
    std::string title;  // "Depth"
    std::string axis;   // "surfaces along a path"
    bool log_axis = true;
    double (*value)(const Setting&) = nullptr;
};

/// In the order of the page. A new knob: a line here, its values in plan_sweep.
const std::vector<Knob>& knobs();

/// Every setting once. `base`: the scene's depth, no cutoff, float, one sample. `others`: intersectors beside the exact
/// one.
std::vector<PlannedSetting> plan_sweep(const Setting& base, bool quick, const std::vector<std::string>& others = {});

inline constexpr int deepest = 256;                  // of the reference and of yardsticks
inline constexpr double yardstick_cutoff = 0x1p-40;  // radiance that a pixel of a yardstick may lose
inline constexpr double reference_cutoff = 0x1p-18, quick_reference_cutoff = 0x1p-11;  // the same of the reference
inline constexpr int reference_supersample = 16;

/// Double precision, the full lattice, whole trees.
Setting reference_setting(const Setting& base, bool quick);

}  // namespace cistula::report
