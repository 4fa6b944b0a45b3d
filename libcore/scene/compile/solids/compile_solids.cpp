#include "scene/compile/solids/compile_solids.h"

#include <algorithm>

#include "cistula/numerics/vec.h"
#include "scene/description/rotation.h"

namespace cistula {
namespace {

constexpr double on_face = 1e-9;  // of the solid's size: far above the rounding of a vertex's distance from its planes

}  // namespace

std::vector<glm::dvec3> ConvexSolid::face_corners(uint32_t face) const {
    const PlanePair& pair = planes[face / 2];
    const double offset = face % 2 == 1 ? pair.high : pair.low;
    std::vector<glm::dvec3> corners;
    if (offset == -INFINITY) return corners;
    const glm::dvec3 size = box.high - box.low;
    // Far from the origin what rounds corners and planes is their distance from it.
    const double reach = max_or_second(largest_component(box.high), largest_component(-box.low));
    const double tolerance = max_or_second(max_or_second(on_face * largest_component(size), flatness),
                                           16 * RealTraits<double>::unit * reach);
    for (const glm::dvec3& p : vertices)
        if (magnitude(dot(pair.normal, p) - offset) <= tolerance) corners.push_back(p);
    sort_around(face % 2 == 1 ? pair.normal : -pair.normal, corners, [](const glm::dvec3& p) { return p; });
    return corners;
}

ConvexSolid convex_solid(const SolidObject& object, uint32_t number, const SceneNormalization& normalization) {
    const Polyhedron& shape = polyhedron_of(object);
    const Rotation rotation(object.rotation);
    const glm::dvec3 center = normalization.point(object.center);
    const double radius = object.radius * normalization.factor;
    ConvexSolid solid;
    solid.solid = number;
    solid.flatness = radius * shape.flatness;
    for (const glm::dvec3& p : shape.vertices) {
        solid.vertices.push_back(center + rotation(radius * p));
        solid.box.add(solid.vertices.back());
    }
    for (const auto& planes : shape.planes) {
        const glm::dvec3 normal = rotation(planes.normal);
        const double middle = dot(normal, center);
        solid.planes.push_back({normal, middle + radius * planes.low, middle + radius * planes.high});
    }
    return solid;
}

void bound_sphere(const ConvexSolid& convex, Solid& solid) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& p : convex.vertices) sum += p;
    solid.center = Vec3<float>(sum / double(convex.vertices.size()));
    double square = 0;
    for (const glm::dvec3& p : convex.vertices) {
        const glm::dvec3 out = p - glm::dvec3(solid.center);
        square = max_or_second(square, dot(out, out));
    }
    solid.padded_square = rounded_up<float>(square) + sphere_padding;
}

template <class Real>
void group_slabs(const std::vector<Slab<Real>>& slabs, Solid& solid, std::vector<SlabGroup<Real>>& groups) {
    solid.first_group = static_cast<uint32_t>(groups.size());
    for (uint32_t first = 0; first < solid.slab_count; first += slab_lanes) {
        SlabGroup<Real> group{};
        for (uint32_t i = 0; i < slab_lanes; ++i) {
            const bool used = first + i < solid.slab_count;
            const Slab<Real> slab = used ? slabs[solid.first_slab + first + i] : Slab<Real>{};
            group.nx[i] = slab.normal.x, group.ny[i] = slab.normal.y, group.nz[i] = slab.normal.z;
            group.low[i] = used ? slab.low : -RealTraits<Real>::infinity;
            group.high[i] = used ? slab.high : RealTraits<Real>::infinity;
        }
        groups.push_back(group);
    }
}

template void group_slabs(const std::vector<Slab<float>>&, Solid&, std::vector<SlabGroup<float>>&);
template void group_slabs(const std::vector<Slab<double>>&, Solid&, std::vector<SlabGroup<double>>&);

}  // namespace cistula
