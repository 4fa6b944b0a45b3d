#include "scene/compile/constant_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scene/compile/solids/compile_solids.h"

namespace cistula {
namespace {

using dvec3 = Vec3<double>;

/// Margin of the plan's tests in the frame: far above the rounding of shadow tests, of shadow ray origins, and of the
/// corners below.
constexpr double margin = 0x1p-9;
/// Solids with more slabs are replaced by bounding balls, since corners are found by trying all triples of planes.
constexpr uint32_t most_slabs = 16;
/// Iterations of the search for a separating axis; bodies not separated by then count as near.
constexpr int most_axis_steps = 64;

/// The convex hull of balls of equal radius around some points.
struct Body {
    std::vector<dvec3> points;
    double radius = 0;

    /// The point with the largest coordinate along `axis`.
    const dvec3& farthest(const dvec3& axis) const {
        return *std::max_element(points.begin(), points.end(),
                                 [&](const dvec3& a, const dvec3& b) { return dot(a, axis) < dot(b, axis); });
    }
};

/// Whether a plane separates two bodies by the margin (Gilbert 1966: the point of their difference nearest to the
/// origin).
bool apart(const Body& a, const Body& b) {
    dvec3 between = b.points[0] - a.points[0];
    for (int step = 0; step < most_axis_steps; ++step) {
        const double distance = length(between);
        if (!(distance > margin)) return false;
        const dvec3 axis = between / distance;
        const dvec3 least = b.farthest(-axis) - a.farthest(axis);
        if (dot(least, axis) > a.radius + b.radius + margin) return true;
        const dvec3 way = least - between;
        const double square = dot(way, way);
        if (!(square > 0)) return false;
        between += way * std::clamp(-dot(between, way) / square, 0.0, 1.0);
    }
    return false;
}

/// Intersections of three planes that lie clearly outside no plane: all corners, and perhaps some points near them.
std::vector<dvec3> corners_of(const std::vector<SolidPlane>& planes) {
    std::vector<dvec3> corners;
    for (size_t i = 0; i < planes.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            for (size_t k = 0; k < j; ++k) {
                const SolidPlane &p = planes[i], &q = planes[j], &r = planes[k];
                const double volume = dot(p.normal, cross(q.normal, r.normal));
                if (std::abs(volume) < 0x1p-40) continue;  // nearly parallel beyond what rounding resolves
                const dvec3 corner = (cross(q.normal, r.normal) * p.offset + cross(r.normal, p.normal) * q.offset +
                                      cross(p.normal, q.normal) * r.offset) /
                                     volume;
                if (std::all_of(planes.begin(), planes.end(),
                                [&](const SolidPlane& s) { return dot(s.normal, corner) < s.offset + margin / 2; }))
                    corners.push_back(corner);
            }
    return corners;
}

template <class Real>
Body body_of(const SceneView<Real>& scene, uint32_t index) {
    const Solid& solid = scene.solids[index];
    Body body;
    if (solid.kind == SolidKind::convex) {
        if (solid.slab_count <= most_slabs) body.points = corners_of(solid_planes(scene, solid));
        if (body.points.empty()) body = {{dvec3(solid.center)}, std::sqrt(double(solid.padded_square))};
        return body;
    }
    for (const Cluster<Real>& cluster : scene.clusters)
        for (uint32_t lane = 0; lane < cluster.count && cluster.solid == index; ++lane)
            for (int c = 0; c < 3; ++c)
                body.points.push_back(
                    {cluster.corner[c][0][lane], cluster.corner[c][1][lane], cluster.corner[c][2][lane]});
    return body;
}

}  // namespace

template <class Real>
void plan_shadows(const SceneView<Real>& scene, ShadowPlan& plan) {
    std::vector<Body> bodies;
    for (uint32_t i = 0; i < scene.solids.size; ++i) bodies.push_back(body_of(scene, i));
    for (uint32_t l = 0; l < scene.lights.size; ++l) {
        const dvec3 light(scene.lights[l].position);
        plan.beyond[l] = 0;
        for (uint32_t i = 0; i < scene.solids.size; ++i) {
            const Solid& from = scene.solids[i];
            if (from.kind == SolidKind::convex)
                for (const SolidPlane& plane : solid_planes(scene, from))
                    if (dot(plane.normal, light) > plane.offset + margin) plan.beyond[l] |= 1u << i;
            if (bodies[i].points.empty()) continue;
            Body way = bodies[i];
            way.points.push_back(light);
            uint32_t& near = plan.near[i][l] = 0;
            for (uint32_t p = 0; p < scene.convex.size; ++p)
                if (scene.convex[p] != i && !apart(way, bodies[scene.convex[p]])) near |= 1u << p;
            for (uint32_t p = 0; p < scene.clusters.size; ++p) {
                const uint32_t solid = scene.clusters[p].solid;
                if (solid == i ? !from.flat : !apart(way, bodies[solid])) near |= 1u << (ShadowPlan::first_cluster + p);
            }
        }
    }
}

template void plan_shadows<float>(const SceneView<float>&, ShadowPlan&);
template void plan_shadows<double>(const SceneView<double>&, ShadowPlan&);
}  // namespace cistula
