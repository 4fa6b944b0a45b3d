// The planes that faces of several solids share, in a scene's precision (docs/rules.md, 11). Private to libcore/scene.
#pragma once

#include <vector>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/solids/placed_bodies.h"

namespace cistula {

/// Fills the scene's shared_planes, one for each contact plane.
template <class Real>
void add_shared_planes(CompiledScene<Real>& scene, const Contacts& contacts);

/// Fills the scene's triangle_planes, near_planes and plane_solids, once its triangles are numbered, and bounds the
/// meshes that have faces on shared planes. `boxes`: of each solid.
template <class Real>
void list_shared_planes(CompiledScene<Real>& scene, const PlacedBodies& bodies, const std::vector<Box>& boxes);

}  // namespace cistula
