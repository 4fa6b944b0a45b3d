// The groups in which lights enter the layers of a film.
#pragma once

#include <string>
#include <string_view>

#include "scene/description/description.h"

namespace cistula {

/// What the names of light layers begin with, before that of a group or of one of these, which every scene has, in the
/// order of LightLayer.
inline constexpr std::string_view light_layer_prefix = "Combined_";
inline constexpr std::string_view common_light_layer_names[] = {"ambient", "environment", "glow"};

/// The group of the scene's i-th light: as given, or one of its own, "light0".
std::string light_group(const LightDescription& light, size_t i);

/// The group of the lights on a solid's edges: as given, or "edges_" and the solid's name, cut where it is too long.
std::string light_group(const EdgeLights& lights, const std::string& solid);

/// What is wrong with the name of a group, as in "has a dot"; empty: nothing.
std::string fault_of_light_group(const std::string& name);

}  // namespace cistula
