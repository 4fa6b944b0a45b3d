// The primitives that can lie between a solid and a light: computed once for a small scene, so that most shadow rays
// skip most of them.
#pragma once

#include "cistula/model/constant_scene.h"

namespace cistula {

/// Fills `plan` for a view readable here that belongs to a ConstantScene. Conservative: it leaves out no primitive that
/// a shadow ray's test could accept, and marks no light as lying beyond a solid that a ray from inside could reach
/// unhindered.
template <class Real>
void plan_shadows(const SceneView<Real>& scene, ShadowPlan& plan);

}  // namespace cistula
