// The groups in which lights enter the layers of a film.
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

#include "scene/description/description.h"

namespace cistula {

/// What the names of light layers begin with, before that of a group or of one of these, which every scene has, in the
/// order of LightLayer.
inline constexpr std::string_view light_layer_prefix = "Combined_";
inline constexpr std::string_view common_light_layer_names[] = {"ambient", "environment", "glow"};

/// The groups of a scene's lights. One that is not given gets a name that no other has: that below, with "_2", "_3"
/// behind it if it is another's.
class LightGroups {
  public:
    explicit LightGroups(const SceneDescription& scene);

    /// The group of the scene's i-th light: as given, or one of its own, "light0".
    std::string of_light(size_t i);

    /// The group of the lights on a solid's edges: as given, or "edges_" and the solid's name, cut where it is too
    /// long.
    std::string of_edges(const EdgeLights& lights, const std::string& solid);

  private:
    std::string own(const std::string& name);

    const SceneDescription& scene_;
    std::unordered_set<std::string> used_;
};

/// What is wrong with the name of a group, as in "has a dot"; empty: nothing.
std::string fault_of_light_group(const std::string& name);

}  // namespace cistula
