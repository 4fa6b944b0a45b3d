// Convex solids as planes in the frame, in double. Inside libcore/scene.
#pragma once

#include <vector>

#include "scene/base/box.h"
#include "scene/compile/frame.h"
#include "scene/description/platonic.h"

namespace cistula {

/// low <= normal.x <= high. A single plane has low = -infinity.
struct PlanePair {
    glm::dvec3 normal;
    double low, high;
    bool turned = false;  // the normal is the shape's negated: low and high sides have changed places

    /// The face of the compiled slab for the shape's face 2 i + side.
    uint32_t face(uint32_t shape_face) const { return turned ? shape_face ^ 1 : shape_face; }
};

struct ConvexSolid {
    uint32_t solid = 0;  // number in the scene
    std::vector<glm::dvec3> vertices;
    std::vector<PlanePair> planes;
    Box box;
};

/// Rotated, then moved and scaled to the frame.
ConvexSolid convex_solid(const SolidObject& object, uint32_t number, const Frame& frame);

/// Makes planes of different solids that are coplanar to within 1e-12 share one record (n, h), so that touching faces
/// have equal t: normals equal up to an exact sign, offsets equal.
void share_planes(std::vector<ConvexSolid>& solids, double extent);

}  // namespace cistula
