// The knobs between time and accuracy, as one setting. A new knob is a member here and a line in each function of
// setting.cpp; its values stand in sweep_plan.cpp.
#pragma once

#include <string>

#include "record_json.h"
#include "scene/film/renderer.h"

namespace cistula::report {

struct Setting {
    int depth = 4;
    double cutoff = 0;
    Precision precision = Precision::single_;
    int supersample = 1;
    std::string intersector = "exact";  // see renderers.h
    double target_error = 0;            // above 0: adaptive samples; supersample and cutoff then say nothing

    bool adaptive() const { return target_error > 0; }
    bool operator==(const Setting&) const = default;
};

void to_json(Json& json, const Setting& setting);
void from_json(const Json& json, Setting& setting);

/// The settings of a frame of this size; with a target error the depth is 1024.
FrameSettings frame_settings(const Setting& setting, int width, int height);

/// The setting with a target error, as deep as a render goes, with one sample and no cutoff: what they say is the
/// target's business.
Setting with_target(Setting setting, double target_error);

/// "depth:4/cutoff:0/float/samples:1x1", or "target:0.01/float"; names of intersectors other than the exact ones are
/// added.
std::string setting_name(const Setting& setting);

/// The command that renders this: "render scenes/platonic.json --res 1280x720 --depth 4 ...".
std::string command_line(const std::string& scene, int width, int height, const Setting& setting,
                         const std::string& backend);

const char* precision_name(Precision precision);

}  // namespace cistula::report
