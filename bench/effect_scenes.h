// The scenes that tell what effects cost: variations of scenes/benchmark.json, and scenes/ itself.
#pragma once

#include <string>
#include <vector>

#include "scene/description/description.h"

namespace cistula::bench {

struct EffectScene {
    std::string name;
    SceneDescription scene;
    bool is_for_bars = false;  // its times are held against a bar
};

/// opaque: the benchmark's three solids, neither mirrors nor transparent, in one light; opaque_floor: on its floor;
/// mirrors: nothing transmits; edge_lights: six seen lights of intensity 0 on every edge; away: opaque behind the
/// camera's back, where a device has nothing to do and a host writes background. Then scenes/*.json by name.
std::vector<EffectScene> effect_scenes(const std::string& folder);

}  // namespace cistula::bench
