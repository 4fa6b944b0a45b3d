// Which primitives can lie between a solid and a light at all: found once for a small scene, so that most shadow rays
// are spared most of them.
#pragma once

#include "cistula/model/constant_scene.h"

namespace cistula {

/// `plan` for a view that can be read here and that a ConstantScene holds. Exact in that it leaves out no primitive
/// that a shadow ray's test could accept, and calls no light beyond a solid that a ray from inside could reach
/// unhindered.
template <class Real>
void plan_shadows(const SceneView<Real>& scene, ShadowPlan& plan);

}  // namespace cistula
