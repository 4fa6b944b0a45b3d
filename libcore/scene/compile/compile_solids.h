// Convex solids as planes in the frame, in double. Private to libcore/scene.
#pragma once

#include <vector>

#include "cistula/model/scene_view.h"
#include "scene/base/box.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"

namespace cistula {

/// A pair of parallel planes: low <= normal.x <= high. A single plane has low = -infinity.
struct PlanePair {
    glm::dvec3 normal;
    double low, high;
    bool turned = false;  // the normal is the shape's negated, and the low and high sides are swapped

    /// The compiled slab's face for the shape's face 2 i + side.
    uint32_t face(uint32_t shape_face) const { return turned ? shape_face ^ 1 : shape_face; }
};

struct ConvexSolid {
    uint32_t solid = 0;  // index in the scene
    std::vector<glm::dvec3> vertices;
    std::vector<PlanePair> planes;
    std::vector<uint32_t> face_planes;  // the shared plane of each face 2 i + side, or none (shared_planes.h)
    Box box;
    double flatness = 0;  // how far corners may lie from their faces beyond rounding

    /// The corners of a face in cyclic order; none for the missing side of a single plane.
    std::vector<glm::dvec3> face_corners(uint32_t face) const;
};

/// A solid's planes, rotated, then translated and scaled into the frame.
ConvexSolid convex_solid(const SolidObject& object, uint32_t number, const SceneNormalization& normalization);

/// Gives planes of different solids that coincide to within 1e-12 one record (n, h), so that touching faces have equal
/// t: normals equal up to sign, offsets equal.
void merge_coplanar(std::vector<ConvexSolid>& solids, double extent);

/// Sets the sphere around a solid.
void bound_sphere(const ConvexSolid& convex, Solid& solid);

/// Appends the groups of a solid's slabs and sets the first one.
template <class Real>
void group_slabs(const std::vector<Slab<Real>>& slabs, Solid& solid, std::vector<SlabGroup<Real>>& groups);

}  // namespace cistula
