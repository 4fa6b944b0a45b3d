// The solids of a scene in its frame, in double, as both precisions have them: touching faces are moved into one plane,
// and convex solids are planes, closed meshes too; then the planes that faces share in the scene's precision
// (docs/rules.md, 11). Private to libcore/scene.
#pragma once

#include <optional>
#include <vector>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/contacts/contacts.h"
#include "scene/compile/meshes/normalized_mesh.h"
#include "scene/compile/solids/compile_balls.h"
#include "scene/compile/solids/compile_disks.h"
#include "scene/compile/solids/compile_solids.h"

namespace cistula {

struct PlacedBodies {
    SceneNormalization normalization;
    std::vector<MeshSize> sizes;  // of each solid's mesh; of other solids nothing
    Contacts contacts;
    std::vector<ConvexSolid> convex;  // the solids that are given by planes, by number; in contact as contacts say
    std::vector<PlacedBall> balls;    // by number
    std::optional<BallCoat> coat;     // the thinnest, if float would lose it
    std::vector<PlacedDisk> disks;    // by number

    explicit PlacedBodies(const SceneSource& source);

  private:
    void bind_slabs(ConvexSolid& solid) const;
    void bind_slab(ConvexSolid& solid, uint32_t slab) const;
    void follow(const ConvexSolid& solid, uint32_t face, const glm::dvec3& opposite, PlanePair& pair) const;
};

/// Fills the scene's shared_planes, one for each contact plane.
template <class Real>
void add_shared_planes(CompiledScene<Real>& scene, const Contacts& contacts);

/// Fills the scene's triangle_planes, near_planes and plane_solids, once its triangles are numbered, and bounds the
/// meshes that have faces on shared planes. `boxes`: of each solid.
template <class Real>
void list_shared_planes(CompiledScene<Real>& scene, const PlacedBodies& bodies, const std::vector<Box>& boxes);

/// The largest mesh that is searched for planes, in triangles.
inline constexpr uint32_t most_convex_triangles = 4096;

/// The planes of a solid that is a mesh, if planes reproduce its surface (docs/rules.md, 3). None for Platonic solids,
/// for a mesh with a texture, one that keeps its triangles or has too many, and one that is not closed, not convex, not
/// flat-faced, too sharp or too thin. Slabs are in the order of their first triangles; faces that contacts put into a
/// plane have its number.
std::optional<ConvexSolid> convex_mesh(const SceneSource& source, uint32_t number,
                                       const SceneNormalization& normalization, const Contacts& contacts);

}  // namespace cistula
