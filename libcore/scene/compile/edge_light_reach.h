// Extent of the visible lights along a solid's edges, for cistula/lights/edge_lights.h.
#pragma once

#include "scene/compile/compiled_scene.h"

namespace cistula {

/// Bound on the rounding in all tests of a light or a ray's line, in units of M.
inline constexpr double light_slack = 0x1p-14;

/// Sets light_reach, light_square and lights_apart of every solid's first group. A solid without visible lights on its
/// edges gets radius 0. All reaches are infinite if any light lies on no solid or if there are too many solids to test.
/// `owners`: for each visible light the convex solid on whose edges it lies, or no_solid.
template <class Real>
void reach_edge_lights(CompiledScene<Real>& scene, const std::vector<uint32_t>& owners);

}  // namespace cistula
