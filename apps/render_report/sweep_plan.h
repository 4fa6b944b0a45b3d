// The settings to measure, and the reference for each knob's own error.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "setting.h"

namespace cistula::report {

struct PlannedSetting {
    Setting setting;
    std::map<std::string, Setting> alone;  // knob -> this setting without that knob's error
};

/// A knob's texts on the page.
struct Knob {
    std::string name;   // the key of PlannedSetting::alone
    std::string title;  // "Depth"
    std::string axis;   // "surfaces along a path"
    bool log_axis = true;
    double (*value)(const Setting&) = nullptr;
};

/// The knobs in page order. A new one needs a line here and values in plan_sweep.
const std::vector<Knob>& knobs();

/// All settings, without duplicates. `base`: the scene's depth, no cutoff, float, one sample.
std::vector<PlannedSetting> plan_sweep(const Setting& base, bool quick);

inline constexpr int deepest = 256;                       // depth of the reference and of references for single knobs
inline constexpr double knob_reference_cutoff = 0x1p-40;  // truncation budget of a pixel in references for single knobs
inline constexpr double reference_cutoff = 0x1p-18,
                        quick_reference_cutoff = 0x1p-11;  // budget of the overall reference
inline constexpr int reference_supersample = 16;

/// The reference's setting: double precision, the full lattice, ray trees of full depth.
Setting reference_setting(const Setting& base, bool quick);

}  // namespace cistula::report
