// Where lines within a solid begin to look for seen lights. Inside libcore/scene.
#pragma once

#include "cistula/small_scene.h"

namespace cistula {

/// Of each convex solid of a scene that can be read here and that a SmallScene holds: the deepest node of the tree over
/// seen lights that has all below it that touch the solid, give or take far more than rounding; the root where none
/// does.
template <class Real>
void find_light_roots(const SceneView<Real>& scene, int32_t (&roots)[ShadowPlan::solids]);

}  // namespace cistula
