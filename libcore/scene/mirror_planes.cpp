#include "scene/mirror_planes.h"

#include <algorithm>

#include "scene/solid_planes.h"

namespace cistula {
namespace {

/// visit(triangle, slot) for those of a sheet or mesh.
template <class Real, class Visit>
void for_each_triangle(const SceneView<Real>& scene, uint32_t solid, const Visit& visit) {
    for (uint32_t i = 0; i < scene.clusters.size; ++i)
        for (uint32_t lane = 0; lane < scene.clusters[i].count && scene.clusters[i].solid == solid; ++lane)
            visit(scene.clusters[i].triangle[lane], i * cluster_lanes + lane);
}

/// Faces as keys number them: of a convex solid from 0, triangles from its first.
template <class Real>
uint32_t faces_of(const SceneView<Real>& scene, uint32_t index) {
    const Solid& solid = scene.solids[index];
    if (solid.kind == SolidKind::convex) return 2 * solid.slab_count;
    uint32_t faces = 0;
    for_each_triangle(scene, index, [&](uint32_t triangle, uint32_t) {
        faces = std::max(faces, triangle - solid.first_triangle + 1);
    });
    return faces;
}

template <class Real>
MirrorPlane plane_of_triangle(const SceneView<Real>& scene, uint32_t slot) {
    const TriangleSides<Real> sides = TriangleSides<Real>::of(scene, slot);
    Vec3<Real> corner[3];
    triangle_corners(scene, slot, corner);
    MirrorPlane plane{};
    plane.normal = normalized(Vec3<double>(sides.normal));
    double low = RealTraits<double>::infinity, high = -low;
    for (const Vec3<Real>& c : corner) {
        const double offset = dot(plane.normal, Vec3<double>(c));
        low = std::min(low, offset);
        high = std::max(high, offset);
        for (const Apex<Real>& apex : sides.apex)
            plane.shift =
                std::max(plane.shift, double(apex.share) * length(Vec3<double>(apex.place) - Vec3<double>(c)));
    }
    plane.offset = (low + high) / 2;
    plane.thickness = (high - low) / 2;
    return plane;
}

template <class Real>
bool is_small(const SceneView<Real>& scene) {
    return scene.solids.size <= ShadowPlan::solids && scene.convex.size <= ShadowPlan::convex &&
           scene.clusters.size <= ShadowPlan::clusters;
}

}  // namespace

template <class Real>
MirrorNumbers number_mirrors(const SceneView<Real>& scene) {
    MirrorNumbers numbers;
    numbers.clear();
    if (!is_small(scene)) return numbers;
    for (uint32_t i = 0, next = 0; i < scene.solids.size; ++i) {
        const Solid& solid = scene.solids[i];
        const uint32_t faces = faces_of(scene, i);
        if (!(scene.materials[solid.material].reflection > Real(0)) || next + faces > MirrorNumbers::most) continue;
        numbers.first[i] = next - (solid.kind == SolidKind::convex ? 0 : solid.first_triangle);
        next += faces;
    }
    return numbers;
}

template <class Real>
std::vector<MirrorPlane> mirror_planes(const SceneView<Real>& scene) {
    std::vector<MirrorPlane> planes;
    if (!is_small(scene)) return planes;
    const MirrorNumbers numbers = number_mirrors(scene);
    for (uint32_t i = 0; i < scene.solids.size; ++i) {
        if (numbers.first[i] == MirrorNumbers::none) continue;
        const Solid& solid = scene.solids[i];
        const auto add = [&](uint32_t face, MirrorPlane plane) {
            plane.number = numbers.of(i, face);
            plane.solid = i;
            planes.push_back(plane);
        };
        if (solid.kind == SolidKind::convex)
            for (const SolidPlane& plane : solid_planes(scene, solid)) {
                const double size = length(plane.normal);  // 1 but for rounding
                add(plane.face, {0, 0, plane.normal / size, plane.offset / size});
            }
        else
            for_each_triangle(scene, i,
                              [&](uint32_t triangle, uint32_t slot) { add(triangle, plane_of_triangle(scene, slot)); });
    }
    return planes;
}

Camera mirrored(const Camera& camera, const MirrorPlane& mirror) {
    const auto turned = [&](const Vec3<double>& v) { return v - 2 * dot(mirror.normal, v) * mirror.normal; };
    return {turned(camera.position) + 2 * mirror.offset * mirror.normal, turned(camera.forward), turned(camera.right),
            turned(camera.up), camera.tan_half_width};
}

template MirrorNumbers number_mirrors(const SceneView<float>&);
template MirrorNumbers number_mirrors(const SceneView<double>&);
template std::vector<MirrorPlane> mirror_planes(const SceneView<float>&);
template std::vector<MirrorPlane> mirror_planes(const SceneView<double>&);

}  // namespace cistula
