// Cameras that lie on faces (docs/rules.md, 11, line 17).
#pragma once

#include "cistula/transport/pixel.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// Sets where a frame's rays start: at the camera, or, where it lies on faces to within 16 times the rounding of its
/// distance from their planes, 32 u M off each plane, on either side. Of more than three planes the first three count.
/// The camera's position is already in the frame, and so is `half_unit`, which rounding may have moved it by.
template <class Real>
void set_camera_sides(const CompiledScene<Real>& scene, const glm::dvec3& half_unit, FrameView& frame);

}  // namespace cistula
