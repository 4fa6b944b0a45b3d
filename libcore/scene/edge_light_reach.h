// How far the seen lights along a solid's edges reach from these, for cistula/edge_lights.h.
#pragma once

#include "scene/compiled_scene.h"

namespace cistula {

/// Sets light_reach, light_square and lights_apart of every solid's first group: a sphere of no size where no seen light lies
/// on its edges, and a reach of infinity for all if any light lies on no edge or the solids are too many to be asked.
template <class Real>
void reach_edge_lights(CompiledScene<Real>& scene);

}  // namespace cistula
