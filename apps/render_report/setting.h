// A setting of all parameters that trade time for accuracy (knobs). A new knob needs a member here, a line in each
// function of setting.cpp, and values in sweep_plan.cpp.
#pragma once

#include <string>

#include "record_json.h"
#include "render/renderer.h"

namespace cistula::report {

struct Setting {
    int depth = 4;
    double cutoff = 0;
    Precision precision = Precision::single_;
    int supersample = 1;
    double target_error = 0;  // above 0: adaptive sampling; supersample and cutoff are ignored

    bool adaptive() const { return target_error > 0; }
    bool operator==(const Setting&) const = default;
};

void to_json(Json& json, const Setting& setting);
void from_json(const Json& json, Setting& setting);

/// The frame settings for a setting. With a target error the depth is 1024.
FrameSettings frame_settings(const Setting& setting, int width, int height);

/// The setting with a target error: largest depth, one sample and no cutoff, since the target decides these.
Setting with_target(Setting setting, double target_error);

/// The setting's name: "depth:4/cutoff:0/float/samples:1x1", or "target:0.01/float".
std::string setting_name(const Setting& setting);

/// The command that renders with this setting: "render scenes/platonic.json --res 1280x720 --depth 4 ...".
std::string command_line(const std::string& scene, int width, int height, const Setting& setting,
                         const std::string& backend);

}  // namespace cistula::report
