// Which solids come near one another: what may touch, what nothing else is inside of, and what may lie within the
// bulges of smooth meshes. Private to libcore/scene.
#pragma once

#include <vector>

#include "scene/compile/lights/radiance_bound.h"
#include "scene/compile/solids/compile_disks.h"

namespace cistula {

/// Notes which solids with an inside may share a face with another (surface_event.h). `boxes`: of each solid.
template <class Real>
void find_touching_solids(CompiledScene<Real>& scene, const std::vector<Box>& boxes);

/// Notes inside which convex solids nothing else is, once it is known what is near balls. An optimization, skipped for
/// scenes with very many pairs.
template <class Real>
void find_isolated_solids(CompiledScene<Real>& scene, const std::vector<PlacedDisk>& disks);

/// Notes whether shadow rays may cross faces that rays pass unseen (shadow.h), once it is known what is isolated.
template <class Real>
void find_unseen_faces(CompiledScene<Real>& scene);

/// Notes of which smooth meshes anything else, or another part, may lie within a bulge.
template <class Real>
void find_crossed_bulges(CompiledScene<Real>& scene, const SceneSource& source, const SolidPlaces& places);

}  // namespace cistula
