#include "scene/compile/solids/placed_bodies.h"

#include <optional>

#include <tbb/parallel_for.h>

#include "cistula/lights/edge_lights.h"
#include "scene/compile/scene_source.h"
#include "scene/compile/solids/smallest_part.h"

namespace cistula {
namespace {

using glm::dvec3;

/// Gives one side of a slab the plane of a contact.
void take(PlanePair& pair, const ContactPlane& plane, bool high) {
    const bool same = dot(plane.normal, pair.normal) > 0;
    const double offset = dot(plane.normal, plane.middle);
    pair.normal = same ? plane.normal : -plane.normal;
    (high ? pair.high : pair.low) = same ? offset : -offset;
}

/// Convex solids with the vertices that contacts moved.
void move_vertices(std::vector<ConvexSolid>& convex, const Contacts& contacts) {
    for (ConvexSolid& solid : convex) {
        const SolidContacts& moved = contacts.solids[solid.solid];
        solid.face_planes.assign(2 * solid.planes.size(), no_plane);
        for (const PartOnPlane& part : moved.parts) solid.face_planes[part.part] = part.plane;
        if (moved.points.empty()) continue;
        solid.vertices = moved.points;
        solid.box = {};
        for (const dvec3& p : solid.vertices) solid.box.add(p);
    }
}

}  // namespace

PlacedBodies::PlacedBodies(const SceneSource& source) : normalization(find_normalization(source)) {
    const auto count = uint32_t(source.solids.size());
    sizes.resize(count);
    std::vector<std::optional<ConvexSolid>> by_planes(count);
    tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
        source.stop.check();
        const SourceSolid& solid = source.solids[i];
        if (solid.polyhedron)
            by_planes[i] = convex_solid(*solid.polyhedron, i, normalization);
        else if (solid.is_mesh())
            sizes[i] = mesh_size(solid.mesh, normalization, least_share(Precision::double_) * normalization.extent);
    });
    for (uint32_t i = 0; i < count; ++i)
        if (source.solids[i].sphere) balls.emplace_back(*source.solids[i].sphere, i, normalization);
    coat = thinnest_coat(source, balls, normalization);
    std::vector<ConvexSolid> polyhedra;
    for (std::optional<ConvexSolid>& solid : by_planes)
        if (solid) polyhedra.push_back(std::move(*solid));
    source.stop.check();
    contacts = find_contacts(source, normalization, polyhedra, sizes);
    move_vertices(polyhedra, contacts);
    for (uint32_t i = 0; i < count; ++i)
        if (source.solids[i].disk) disks.emplace_back(source, i, normalization, contacts);
    tbb::parallel_for(uint32_t(0), count, [&](uint32_t i) {
        source.stop.check();
        if (!source.solids[i].polyhedron) by_planes[i] = convex_mesh(source, i, normalization, contacts);
    });
    for (ConvexSolid& solid : polyhedra) by_planes[solid.solid] = std::move(solid);
    for (std::optional<ConvexSolid>& solid : by_planes)
        if (solid) convex.push_back(std::move(*solid));
    for (ConvexSolid& solid : convex) bind_slabs(solid);
}

/// Gives a solid's faces the planes of its contacts.
void PlacedBodies::bind_slabs(ConvexSolid& solid) const {
    const size_t slabs = solid.planes.size();
    for (uint32_t slab = 0; slab < slabs; ++slab) bind_slab(solid, slab);
}

/// Gives a slab the normals and the offsets of the contact planes on its sides. If these have different normals, or
/// one side cannot follow the other, the low side becomes a slab of its own, the last.
void PlacedBodies::bind_slab(ConvexSolid& solid, uint32_t slab) const {
    const uint32_t low = solid.face_planes[2 * slab];
    const uint32_t high = solid.face_planes[2 * slab + 1];
    if (low == no_plane && high == no_plane) return;
    PlanePair& pair = solid.planes[slab];
    PlanePair of_low = pair;
    PlanePair of_high = pair;
    if (low != no_plane) take(of_low, contacts.planes[low], false);
    if (high != no_plane) take(of_high, contacts.planes[high], true);
    if (pair.low != -INFINITY) {
        if (low == no_plane) follow(solid, 2 * slab, of_high.normal, of_low);
        if (high == no_plane) follow(solid, 2 * slab + 1, of_low.normal, of_high);
    }
    pair = {of_high.normal, of_low.low, of_high.high};
    if (of_low.normal == pair.normal || pair.low == -INFINITY) return;
    solid.face_planes[2 * slab] = no_plane;
    solid.face_planes.push_back(no_plane);
    solid.face_planes.push_back(low);
    pair.low = -INFINITY;
    solid.planes.push_back({-of_low.normal, -INFINITY, -of_low.low});
}

/// Gives a face the normal of the one opposite, through its middle, unless that moves a corner off: a small face may
/// tilt much more than a large one.
void PlacedBodies::follow(const ConvexSolid& solid, uint32_t face, const dvec3& opposite, PlanePair& pair) const {
    const std::vector<dvec3> corners = solid.face_corners(face);
    if (!corners.empty()) {
        const double most = contacts.solids[solid.solid].reach.own / 2;
        dvec3 middle(0);
        for (const dvec3& p : corners) middle += p / double(corners.size());
        const double through = dot(opposite, middle);
        for (const dvec3& p : corners)
            if (magnitude(dot(opposite, p) - through) > most) return;
        (face % 2 == 0 ? pair.low : pair.high) = through;
    }
    pair.normal = opposite;
}

}  // namespace cistula
