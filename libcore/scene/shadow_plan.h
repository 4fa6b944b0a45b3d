// Which primitives can lie between a solid and a light at all: found once for a small scene, so that most shadow rays
// are spared most of them.
#pragma once

#include <memory>

#include "cistula/small_scene.h"

namespace cistula {

/// `plan` for a view that can be read here and that a SmallScene holds. Exact in that it leaves out no primitive that a
/// shadow ray's test could accept, and calls no light beyond a solid that a ray from inside could reach unhindered.
template <class Real>
void plan_shadows(const SceneView<Real>& scene, ShadowPlan& plan);

/// The form of a scene that a plain loop reads, with all that is found out for it beforehand; null where it fits into
/// none. `here` and `there` as of SmallScene::assign.
template <class Real>
std::unique_ptr<SmallScene<Real>> small_scene(const SceneView<Real>& here, const SceneView<Real>& there);
template <class Real>
std::unique_ptr<SmallScene<Real>> small_scene(const SceneView<Real>& scene) {
    return small_scene(scene, scene);
}

}  // namespace cistula
