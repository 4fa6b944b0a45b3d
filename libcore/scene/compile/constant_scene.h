// Conversion of a small scene to the form that is passed among a kernel's parameters.
#pragma once

#include <memory>

#include "cistula/model/constant_scene.h"

namespace cistula {

/// The maximum number of primitives for which a loop over all of them is faster than any tree.
inline constexpr uint32_t most_in_loop = 16;

/// Whether a scene has no more.
template <class Real>
bool takes_loop(const SceneView<Real>& scene) {
    return scene.convex.size + scene.clusters.size <= most_in_loop;
}

/// The ConstantScene of a view readable here, with everything precomputed for it. Null if the scene is too large, or if
/// a ray may be inside more than one solid or inside a mesh, which SingleInterior rules out. `there`: the scene where
/// kernels read it.
template <class Real>
std::unique_ptr<ConstantScene<Real>> constant_scene(const SceneView<Real>& here, const SceneView<Real>& there);
template <class Real>
std::unique_ptr<ConstantScene<Real>> constant_scene(const SceneView<Real>& scene) {
    return constant_scene(scene, scene);
}

/// Whether constant_scene() would have a result, without finding out anything.
template <class Real>
bool fits_constant_scene(const SceneView<Real>& scene);

/// The BallScene of a view readable here, by the same rules; null if it has no balls, or some that lines inside another
/// solid may meet.
template <class Real>
std::unique_ptr<BallScene<Real>> ball_scene(const SceneView<Real>& here, const SceneView<Real>& there);

/// Fills `plan` for a view readable here that belongs to a ConstantScene. Conservative: it leaves out no primitive that
/// a shadow ray's test could accept, and marks no light as lying beyond a solid that a ray from inside could reach
/// unhindered.
template <class Real>
void plan_shadows(const SceneView<Real>& scene, ShadowPlan& plan);

}  // namespace cistula
