// Convex solids as planes in the frame, in double. Private to libcore/scene and libcore/render.
#pragma once

#include <cmath>
#include <vector>

#include "base/box.h"
#include "cistula/model/scene_view.h"
#include "cistula/numerics/real.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"

namespace cistula {

/// The least number of type Real that is not below x.
template <class Real>
Real rounded_up(double x) {
    const auto r = static_cast<Real>(x);
    return r < x ? std::nextafter(r, RealTraits<Real>::infinity) : r;
}

/// A pair of parallel planes: low <= normal.x <= high. A single plane has low = -infinity.
struct PlanePair {
    glm::dvec3 normal;
    double low, high;
};

struct ConvexSolid {
    uint32_t solid = 0;  // index in the scene
    std::vector<glm::dvec3> vertices;
    std::vector<PlanePair> planes;
    std::vector<uint32_t> face_planes;  // the contact plane of each face 2 i + side, or no_plane (contacts.h)
    Box box;
    double flatness = 0;  // how far corners may lie from their faces beyond rounding

    /// The corners of a face in cyclic order; none for the missing side of a single plane.
    std::vector<glm::dvec3> face_corners(uint32_t face) const;
};

/// A solid's planes, rotated, then translated and scaled into the frame.
ConvexSolid convex_solid(const SolidObject& object, uint32_t number, const SceneNormalization& normalization);

/// Sets the sphere around a solid.
void bound_sphere(const ConvexSolid& convex, Solid& solid);

/// Appends the groups of a solid's slabs and sets the first one.
template <class Real>
void group_slabs(const std::vector<Slab<Real>>& slabs, Solid& solid, std::vector<SlabGroup<Real>>& groups);

/// The half-space normal.x <= offset. `face` is numbered as in hit keys: 2 slab + side.
struct SolidPlane {
    Vec3<double> normal;
    double offset;
    uint32_t face;
};

/// The half-spaces of a solid in face order. Slabs without a lower side give one.
template <class Real>
std::vector<SolidPlane> solid_planes(const SceneView<Real>& scene, const Solid& solid) {
    std::vector<SolidPlane> planes;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
        const Vec3<double> normal(slab.normal);
        if (slab.low > -RealTraits<Real>::infinity) planes.push_back({-normal, -double(slab.low), 2 * i});
        planes.push_back({normal, double(slab.high), 2 * i + 1});
    }
    return planes;
}

}  // namespace cistula
