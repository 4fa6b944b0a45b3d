// From a scene to the form that travels with a kernel's parameters.
#pragma once

#include <memory>

#include "cistula/model/constant_scene.h"

namespace cistula {

/// The ConstantScene of a view that can be read here, with all that is found out for it beforehand. Null if the scene
/// is too large, or if a ray in it may be inside more than one solid or a mesh: OneMedium asks for that. `there`: the
/// same scene where kernels read it.
template <class Real>
std::unique_ptr<ConstantScene<Real>> constant_scene(const SceneView<Real>& here, const SceneView<Real>& there);
template <class Real>
std::unique_ptr<ConstantScene<Real>> constant_scene(const SceneView<Real>& scene) {
    return constant_scene(scene, scene);
}

}  // namespace cistula
