#include "scene/compile/solids/placed_bodies.h"

#include <algorithm>

#include "cistula/geometry/ray.h"

namespace cistula {
namespace {

using glm::dvec3;

constexpr double steady = 4;  // u M: a plane's slack grows where rounding puts corners farther off

/// Bounds a mesh by the sphere around its box.
void bound_mesh(const Box& box, Solid& solid) {
    const dvec3 half = (box.high - box.low) / 2.0;
    solid.center = Vec3<float>(box.low + half);
    solid.padded_square = float(dot(half, half)) + sphere_padding;
}

/// Lists the solids with a face on each plane: those given by planes, then closed meshes.
template <class Real>
void list_solids(CompiledScene<Real>& scene, const PlacedBodies& bodies, const std::vector<Box>& boxes) {
    std::vector<std::vector<uint32_t>> convex(scene.shared_planes.size()), meshes(scene.shared_planes.size());
    for (const ConvexSolid& solid : bodies.convex)
        for (const uint32_t plane : solid.face_planes)
            if (plane != no_plane && (convex[plane].empty() || convex[plane].back() != solid.solid))
                convex[plane].push_back(solid.solid);
    for (uint32_t i = 0; i < scene.solids.size(); ++i) {
        if (scene.solids[i].kind != SolidKind::mesh) continue;
        for (const PartOnPlane& part : bodies.contacts.solids[i].parts)
            if (std::vector<uint32_t>& listed = meshes[part.plane]; listed.empty() || listed.back() != i)
                listed.push_back(i);
        if (!bodies.contacts.solids[i].parts.empty()) bound_mesh(boxes[i], scene.solids[i]);
    }
    for (size_t plane = 0; plane < scene.shared_planes.size(); ++plane) {
        SharedPlane<Real>& shared = scene.shared_planes[plane];
        shared.first_solid = uint32_t(scene.plane_solids.size());
        shared.solid_count = uint32_t(convex[plane].size());
        shared.mesh_count = uint32_t(meshes[plane].size());
        for (const auto* list : {&convex[plane], &meshes[plane]})
            scene.plane_solids.insert(scene.plane_solids.end(), list->begin(), list->end());
    }
}

}  // namespace

template <class Real>
void add_shared_planes(CompiledScene<Real>& scene, const Contacts& contacts) {
    const double unit = double(RealTraits<Real>::unit) * double(scene.extent);
    for (const ContactPlane& plane : contacts.planes) {
        const Vec3<Real> normal(plane.normal);
        const Real offset(dot(dvec3(normal), plane.middle));
        double farthest = 0;
        for (const dvec3& corner : plane.corners)
            farthest =
                max_or_second(magnitude(dot(dvec3(normal), dvec3(Vec3<Real>(corner))) - double(offset)), farthest);
        const double grown = farthest <= steady * unit ? 1 : 1 + farthest / (8 * unit);
        scene.shared_planes.push_back({normal, offset, static_cast<Real>(grown * unit), 0, 0, 0});
    }
}

template <class Real>
void list_shared_planes(CompiledScene<Real>& scene, const PlacedBodies& bodies, const std::vector<Box>& boxes) {
    if (scene.shared_planes.empty()) return;
    uint32_t triangles = 0;
    for (const Cluster<Real>& cluster : scene.clusters) triangles += cluster.count;
    triangles += triangles_of_disk * uint32_t(bodies.disks.size());
    scene.triangle_planes.assign(triangles, no_plane);
    for (uint32_t i = 0; i < scene.solids.size(); ++i) {
        Solid& solid = scene.solids[i];
        const SolidContacts& contacts = bodies.contacts.solids[i];
        if (solid.kind != SolidKind::convex)
            for (const PartOnPlane& part : contacts.parts)
                scene.triangle_planes[solid.first_triangle + part.part] = part.plane;
        solid.first_near = uint32_t(scene.near_planes.size());
        solid.near_count = uint32_t(contacts.near.size());
        scene.near_planes.insert(scene.near_planes.end(), contacts.near.begin(), contacts.near.end());
    }
    list_solids(scene, bodies, boxes);
}

template void add_shared_planes(CompiledScene<float>&, const Contacts&);
template void add_shared_planes(CompiledScene<double>&, const Contacts&);
template void list_shared_planes(CompiledScene<float>&, const PlacedBodies&, const std::vector<Box>&);
template void list_shared_planes(CompiledScene<double>&, const PlacedBodies&, const std::vector<Box>&);

}  // namespace cistula
