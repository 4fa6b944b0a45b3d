// How far the seen lights along a solid's edges reach from these, for cistula/lights/edge_lights.h.
#pragma once

#include "scene/compile/compiled_scene.h"

namespace cistula {

/// More than rounding adds to all that is asked of a light or a line, in units of M.
inline constexpr double light_slack = 0x1p-14;

/// Sets light_reach, light_square and lights_apart of every solid's first group: a sphere of no size where no seen
/// light lies on its edges, and a reach of infinity for all if any light lies on none or the solids are too many to be
/// asked. `owners`: the convex solid on whose edges each seen light lies, or no_solid.
template <class Real>
void reach_edge_lights(CompiledScene<Real>& scene, const std::vector<uint32_t>& owners);

}  // namespace cistula
