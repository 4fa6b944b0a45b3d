// Function parity, triangles: clusters, and rays aimed at their corners, edges and planes; next crossings and shadows.
#pragma once

#include "cistula/shading/shadow.h"
#include "testing/parity/function_case.h"

namespace cistula::parity {

/// A cluster with corners on a lattice, anywhere, tiny, coplanar or mostly degenerate; corners are shared as in a fan
/// or a tetrahedron, or at random.
template <class Real>
CISTULA_HD inline void draw_cluster(Draw& draw, Cluster<Real>& cluster) {
    constexpr int points = 6;
    Vec3<Real> point[points];
    const uint32_t shape = draw.below(5);
    const Real size = two_to<Real>(shape == 2 ? draw.between(-60, -1) : 0);
    const Vec3<Real> middle = draw.one_in(2) ? Vec3<Real>(Real(0)) : draw.in_cube<Real>(Real(0.5));
    const int flat = shape == 3 ? draw.between(0, 2) : -1;
    for (Vec3<Real>& p : point) {
        for (int k = 0; k < 3; ++k) {
            if (shape == 0) p[k] = Real(draw.between(-8, 8)) * Real(0.125);
            if (shape == 4) p[k] = Real(draw.between(-1, 1));
            if (shape == 1 || shape == 2 || shape == 3) p[k] = k == flat ? Real(0) : draw.centered(size);
        }
        if (shape == 2) p += middle;
    }
    if (draw.one_in(64)) point[draw.below(points)] = draw.any_vector<Real>();
    const uint8_t tetrahedron[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const uint32_t topology = draw.below(3);
    const bool backward = draw.one_in(2);
    cluster = {};
    cluster.count = topology == 1 ? 4 : draw.below(cluster_lanes) + 1;
    for (uint32_t lane = 0; lane < cluster.count; ++lane) {
        uint32_t corner[3] = {0, lane % (points - 1) + 1, (lane + 1) % (points - 1) + 1};
        for (int c = 0; c < 3; ++c) {
            if (topology == 1) corner[c] = tetrahedron[lane][c];
            if (topology == 2) corner[c] = draw.below(points);
            for (int axis = 0; axis < 3; ++axis) cluster.corner[c][axis][lane] = point[corner[c]][axis];
        }
        cluster.triangle[lane] = backward ? 7 - lane : lane;
    }
}

template <class Real>
CISTULA_HD inline Vec3<Real> corner_of(const Cluster<Real>& cluster, uint32_t lane, uint32_t c) {
    return {cluster.corner[c][0][lane], cluster.corner[c][1][lane], cluster.corner[c][2][lane]};
}

/// A ray aimed at a corner, a point of an edge or its middle, a centroid, or anywhere; along an axis, from afar, or
/// from the very point.
template <class Real>
CISTULA_HD inline void draw_aimed_ray(Draw& draw, const Cluster<Real>& cluster, Ray<Real>& ray) {
    const uint32_t lane = draw.below(cluster.count), c = draw.below(3);
    const Vec3<Real> a = corner_of(cluster, lane, c), b = corner_of(cluster, lane, (c + 1) % 3),
                     other = corner_of(cluster, lane, (c + 2) % 3);
    Vec3<Real> target = a;
    switch (draw.below(8)) {
        case 0:
            break;
        case 1:
            target = along(a, Real(0.5), b - a);
            break;
        case 2:
            target = along(a, draw.unit<Real>(), b - a);
            break;
        case 3:
            target = (a + b + other) * Real(1.0 / 3.0);
            break;
        default: {
            const Real u = draw.unit<Real>();
            target = along(along(a, u, b - a), (Real(1) - u) * draw.unit<Real>(), other - a);
        }
    }
    const int axis = draw.between(0, 2);
    switch (draw.below(8)) {
        case 0:  // on a lattice
            for (int k = 0; k < 3; ++k) ray.origin[k] = Real(draw.between(-24, 24)) * Real(0.125);
            break;
        case 1:  // parallel to an axis
            ray.origin = target;
            ray.origin[axis] = Real(draw.sign()) * Real(3);
            break;
        case 2:  // a hair off that
            ray.origin = target;
            ray.origin[axis] = Real(draw.sign()) * Real(3);
            ray.origin[(axis + 1) % 3] += draw.scaled<Real>(-60, -20);
            break;
        case 3:
            ray.origin = target;
            break;
        default:
            ray.origin = draw.in_cube<Real>(Real(3));
    }
    ray.direction = target - ray.origin;
    const uint32_t length_of_it = draw.below(8);
    if (length_of_it < 5) ray.direction = normalized(ray.direction);
    if (length_of_it == 5 || ray.origin == target) ray.direction = draw.direction<Real>();
    if (draw.one_in(64)) ray.direction = draw.any_vector<Real>();
}

template <class Real>
struct ClusterInput {
    Cluster<Real> cluster;
    Solid solid;
    Ray<Real> ray;
};

template <class Real>
CISTULA_HD inline void draw_cluster_input(Draw& draw, ClusterInput<Real>& in) {
    draw_cluster(draw, in.cluster);
    draw_aimed_ray(draw, in.cluster, in.ray);
    in.solid = {};
    in.solid.kind = draw.one_in(3) ? SolidKind::sheet : SolidKind::mesh;
    in.solid.flat = draw.one_in(8);
    if (draw.one_in(4)) {
        in.ray.from_solid = 0;
        in.ray.from_face = draw.below(cluster_lanes);
    }
    if (draw.one_in(3)) in.ray.media.add(0, draw.one_in(8) ? -1 : 1);
}

template <class Real>
CISTULA_HD inline SceneView<Real> view_of(const ClusterInput<Real>& in) {
    SceneView<Real> scene;
    scene.solids = {&in.solid, 1};
    scene.clusters = {&in.cluster, 1};
    scene.extent = Real(1.5);
    return scene;
}

/// Case: the first three crossings of a straight ray.
template <class Real>
struct TriangleCase : CaseOf<Real, 9> {
    static constexpr const char* name = "triangle";
    using Input = ClusterInput<Real>;
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        draw_cluster_input(draw, in);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        const SceneView<Real> scene = view_of(in);
        Ray<Real> ray = in.ray;
        const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(ray.origin, ray.direction);
        for (int i = 0; i < 3; ++i) {
            Hit<Real> hit;
            closest_cluster(scene, 0, ray, triangle_ray, hit);
            out.real(hit.t);
            out.bits(hit.key);
            if (i == 0) {
                out.real(hit.u);
                out.real(hit.v);
                out.bits(2 * hit.slot + uint64_t(hit.enters));
            }
            if (!hit.found()) continue;
            ray.after = {hit.t, hit.key};
            if (key_kind(hit.key) != CrossingKind::sheet)
                ray.media.add(0, key_kind(hit.key) == CrossingKind::enter ? 1 : -1);
        }
    }
};

/// Inputs of the shadow cases besides the shapes.
template <class Real>
struct ShadowInput {
    Material<Real> material;
    Light<Real> light;
    Incident incidents[2];
    Real distance;
    bool ends_at_hit;  // the light is exactly where the ray first meets the shape
};

template <class Real>
CISTULA_HD inline void draw_shadow(Draw& draw, uint32_t faces, ShadowInput<Real>& in) {
    in.material = {};
    in.light = {};
    in.material.opaque = draw.one_in(4) ? draw.below(8) : 0;
    if (draw.one_in(16)) in.material.opaque = 7;
    for (int c = 0; c < 3; ++c) {
        in.material.filter_loss[c] = draw.shifted(8, 63);
        if (!draw.one_in(3)) in.material.absorption[c] = magnitude(draw.scaled<Real>(-10, 10));
    }
    if (draw.one_in(16)) in.material.filter_loss[0] = largest_loss;
    in.light.incident_count = draw.one_in(4) ? draw.below(3) : 0;
    for (Incident& incident : in.incidents) {
        incident.solid = draw.one_in(4) ? 1 : 0;
        incident.face = draw.below(faces);
    }
    in.distance = magnitude(draw.scaled<Real>(-2, 3));
    in.ends_at_hit = draw.one_in(4);
}

template <class Real>
CISTULA_HD inline void add_shadow(const SceneView<Real>& scene, const ShadowSum<>& sum, Words& out) {
    for (int c = 0; c < 3; ++c) out.bits(sum.loss[c]);
    for (int c = 0; c < 3; ++c) out.bits(sum.path[c].sum);
    out.bits(sum.opaque);
    out.vec(sum.template transmittance<Real>(scene));
}

template <class Real>
struct TriangleShadowCase : CaseOf<Real, 10> {
    static constexpr const char* name = "triangle_shadow";
    struct Input {
        ClusterInput<Real> shape;
        ShadowInput<Real> shadow;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        draw_cluster_input(draw, in.shape);
        draw_shadow(draw, cluster_lanes, in.shadow);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        SceneView<Real> scene = view_of(in.shape);
        scene.materials = {&in.shadow.material, 1};
        scene.incidents = {in.shadow.incidents, 2};
        ShadowRay<Real> shadow{in.shape.ray, in.shadow.distance, &in.shadow.light};
        const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(shadow.ray.origin, shadow.ray.direction);
        if (in.shadow.ends_at_hit) {
            Hit<Real> hit;
            closest_cluster(scene, 0, shadow.ray, triangle_ray, hit);
            shadow.distance = hit.t;
        }
        ShadowSum<> sum;
        shadow_start<Real, Effects<all_effects>>(scene, shadow, sum);
        shadow_cluster<Real, Effects<all_effects>>(scene, 0, shadow, triangle_ray, sum);
        add_shadow(scene, sum, out);
    }
};

}  // namespace cistula::parity
