// How far the seen lights along a solid's edges reach from these, for cistula/edge_lights.h.
#pragma once

#include "scene/compiled_scene.h"

namespace cistula {

/// Sets light_reach and light_square of every solid's first group: 0 where no seen light lies on its edges; infinity if
/// any light lies on no edge, or the solids are too many to be asked.
template <class Real>
void reach_edge_lights(CompiledScene<Real>& scene);

}  // namespace cistula
