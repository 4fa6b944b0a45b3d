// Which lights that are seen a ray looks for together. Inside libcore/scene.
#pragma once

#include <vector>

#include "scene/compiled_scene.h"

namespace cistula {

/// Fills seen_groups, seen_tree and seen_items from seen_lights. edges[i]: the convex solid on whose edges light i is, or
/// no_solid.
template <class Real>
void group_seen_lights(CompiledScene<Real>& scene, const std::vector<uint32_t>& edges);

}  // namespace cistula
