// Function parity, convex solids: rays that start outside, inside and on faces, aimed at corners, edges and planes.
#pragma once

#include "testing/parity/function_cases_triangle.h"
#include "testing/parity/function_platonic.h"

namespace cistula::parity {

template <class Real>
struct ConvexInput {
    Slab<Real> slabs[most_slabs];
    SlabGroup<Real> groups[(most_slabs + slab_lanes - 1) / slab_lanes];
    Solid solid;
    Ray<Real> ray;
    uint32_t skipped;  // a face
};

/// A convex solid in double, for aiming.
struct ConvexShape {
    uint32_t kind;
    Turn turn;
    Vec3<double> center;
    double radius;

    CISTULA_HD Vec3<double> corner(uint32_t i) const { return center + turn(platonic_corner(kind, i)) * radius; }
};

CISTULA_HD inline ConvexShape draw_convex_shape(Draw& draw) {
    ConvexShape shape;
    shape.kind = draw.below(solid_kinds);
    shape.center = draw.one_in(2) ? Vec3<double>(0.0) : draw.in_cube<double>(0.5);
    shape.radius = draw.one_in(2) ? 1.0 : magnitude(draw.scaled<double>(-14, -1));
    if (draw.one_in(2)) {
        const Vec3<double> v = draw.in_cube<double>(1.0);
        const double w = draw.centered(1.0), size = square_root(dot(v, v) + w * w);
        if (size > 0x1p-10) shape.turn = {w / size, v / size};
    }
    return shape;
}

template <class Real>
CISTULA_HD inline void compile_convex(const ConvexShape& shape, ConvexInput<Real>& in) {
    const PlatonicTables tables = platonic_tables(shape.kind);
    for (SlabGroup<Real>& group : in.groups)
        for (int i = 0; i < slab_lanes; ++i) {
            group.nx[i] = group.ny[i] = group.nz[i] = Real(0);
            group.low[i] = -RealTraits<Real>::infinity;
            group.high[i] = RealTraits<Real>::infinity;
        }
    for (uint32_t i = 0; i < tables.slabs; ++i) {
        const Vec3<double> normal = shape.turn(platonic_normal(shape.kind, i));
        const double middle = dot(normal, shape.center), half = shape.radius * tables.inradius;
        Slab<Real>& slab = in.slabs[i];
        slab.normal = Vec3<Real>(normal);
        slab.low = shape.kind == 0 ? -RealTraits<Real>::infinity : Real(middle - half);
        slab.high = Real(middle + half);
        SlabGroup<Real>& group = in.groups[i / slab_lanes];
        const uint32_t lane = i % slab_lanes;
        group.nx[lane] = slab.normal.x;
        group.ny[lane] = slab.normal.y;
        group.nz[lane] = slab.normal.z;
        group.low[lane] = slab.low;
        group.high[lane] = slab.high;
    }
    in.solid = {};
    in.solid.kind = SolidKind::convex;
    in.solid.slab_count = tables.slabs;
    in.solid.center = Vec3<float>(shape.center);
    in.solid.padded_square = float(shape.radius * shape.radius) + sphere_padding;
}

/// A point to aim at: a corner, a point on or close to an edge, the middle of a face, or any point inside.
CISTULA_HD inline Vec3<double> draw_target(Draw& draw, const ConvexShape& shape) {
    const PlatonicTables tables = platonic_tables(shape.kind);
    const uint32_t a = draw.below(tables.corners);
    const Vec3<double> from = platonic_corner(shape.kind, a);
    uint32_t b = a;
    double nearest = -2;
    for (uint32_t i = 0; i < tables.corners; ++i) {  // the other end of an edge
        const double cosine = dot(from, platonic_corner(shape.kind, i));
        if (i != a && cosine > nearest) nearest = cosine, b = i;
    }
    const Vec3<double> start = shape.corner(a), edge = shape.corner(b) - start;
    switch (draw.below(6)) {
        case 0:
            return start;
        case 1:
            return start + edge * 0.5;
        case 2:
            return start + edge * draw.unit<double>();
        case 3: {
            const Vec3<double> point = start + edge * draw.unit<double>() - shape.center;
            return shape.center + point * (1 + draw.centered(0x1p-20));
        }
        case 4: {
            const Vec3<double> normal = shape.turn(platonic_normal(shape.kind, draw.below(tables.slabs)));
            return shape.center + normal * (shape.radius * tables.inradius);
        }
        default:
            return shape.center + draw.in_cube<double>(shape.radius * 0.5);
    }
}

template <class Real>
CISTULA_HD inline void draw_convex_ray(Draw& draw, const ConvexShape& shape, ConvexInput<Real>& in) {
    const Vec3<Real> target(draw_target(draw, shape));
    Ray<Real>& ray = in.ray;
    const int axis = draw.between(0, 2);
    switch (draw.below(8)) {
        case 0:  // parallel to an axis
            ray.origin = target;
            ray.origin[axis] = Real(draw.sign()) * Real(3);
            break;
        case 1:
            ray.origin = target;
            break;  // on a face, an edge, a corner
        case 2:
            ray.origin = Vec3<Real>(shape.center) + draw.in_cube<Real>(Real(shape.radius)) * Real(0.25);
            break;
        case 3:
        case 4:
            ray.origin = Vec3<Real>(draw_target(draw, shape));
            break;
        default:
            ray.origin = draw.in_cube<Real>(Real(3));
    }
    const Vec3<Real> way = target - ray.origin;
    ray.direction = dot(way, way) > Real(0x1p-60) ? normalized(way) : draw.direction<Real>();
    if (draw.one_in(8)) ray.direction = draw.direction<Real>();
    if (draw.one_in(6)) {  // parallel to a slab, to within rounding
        const Vec3<Real> normal = in.slabs[draw.below(in.solid.slab_count)].normal;
        const Vec3<Real> along_it = cross(normal, draw.direction<Real>());
        if (dot(along_it, along_it) > Real(0x1p-10)) ray.direction = normalized(along_it);
    }
    if (draw.one_in(16)) ray.direction[axis] = draw.scaled<Real>(1 - Layout<Real>::bias, -100);
    if (draw.one_in(16)) ray.origin[axis] = draw.scaled<Real>(1 - Layout<Real>::bias, 20);
}

/// `in_three`: how many of three rays start inside.
template <class Real>
CISTULA_HD inline ConvexShape draw_convex_input(Draw& draw, uint32_t in_three, ConvexInput<Real>& in) {
    const ConvexShape shape = draw_convex_shape(draw);
    compile_convex(shape, in);
    draw_convex_ray(draw, shape, in);
    in.skipped = draw.below(2 * in.solid.slab_count);
    if (shape.kind == 0) in.skipped |= 1u;  // a tetrahedron's low sides are no faces
    const bool inside = draw.below(3) < in_three;
    if (inside) in.ray.media.add(0, 1);
    if (draw.one_in(inside ? 2 : 16)) {
        in.ray.from_solid = 0;
        in.ray.from_face = in.skipped;
    }
    return shape;
}

template <class Real>
CISTULA_HD inline SceneView<Real> view_of(const ConvexInput<Real>& in) {
    SceneView<Real> scene;
    scene.solids = {&in.solid, 1};
    scene.slabs = {in.slabs, most_slabs};
    scene.slab_groups = {in.groups, 2};
    scene.extent = Real(1.5);
    return scene;
}

/// Case: the first two crossings of a straight ray, and the first one again with `after` just before or behind its t.
template <class Real>
struct ConvexCase : CaseOf<Real, 7> {
    static constexpr const char* name = "convex";
    using Input = ConvexInput<Real>;
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        draw_convex_input(draw, 1, in);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        const SceneView<Real> scene = view_of(in);
        Ray<Real> ray = in.ray;
        Hit<Real> first, second;
        closest_convex(scene, 0, ray, first);
        if (first.found()) {
            ray.after = {first.t, first.key};
            ray.media.add(0, key_kind(first.key) == CrossingKind::enter ? 1 : -1);
            closest_convex(scene, 0, ray, second);
        }
        Hit<Real> tied = first;
        tied.key = first.key + (in.skipped & 2u) - 1;
        closest_convex(scene, 0, in.ray, tied);
        out.real(first.t);
        out.bits(first.key);
        out.bits(first.enters);
        out.real(second.t);
        out.bits(second.key);
        out.bits(second.enters);
        out.bits(tied.key);
    }
};

/// Case: intervals. Their ends may be zeros of either sign: host and device test the slabs in different orders, and no
/// caller looks at the sign.
template <class Real>
struct ConvexIntervalCase : CaseOf<Real, 5> {
    static constexpr const char* name = "convex_interval";
    using Input = ConvexInput<Real>;
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        draw_convex_input(draw, 1, in);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        const SceneView<Real> scene = view_of(in);
        const Vec3<Real>&o = in.ray.origin, &d = in.ray.direction;
        const auto all = convex_here::interval_of(scene, in.solid, o, d, false);
        const auto rest = convex_here::exit_of(scene, in.solid, o, d, in.skipped);
        out.unsigned_zero(all.enter);
        out.unsigned_zero(all.leave);
        out.unsigned_zero(rest.t);
        out.bits(is_met(all, scene.extent));
        // Whether the ray misses the sphere, and whether the solid lies beyond half the distance to it.
        const bool misses = misses_bounds(BoundingSphere<Real>::of(in.solid), o, d, RealTraits<Real>::infinity);
        const bool beyond = misses_bounds(BoundingSphere<Real>::of(in.solid), o, d, all.enter * Real(0.5));
        out.bits(4 * uint64_t(beyond) + 2 * uint64_t(inside_convex(scene, in.solid, o)) + uint64_t(misses));
    }
};

template <class Real>
struct ConvexShadowCase : CaseOf<Real, 10> {
    static constexpr const char* name = "convex_shadow";
    struct Input {
        ConvexInput<Real> shape;
        ShadowInput<Real> shadow;
    };
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        draw_convex_input(draw, 1, in.shape);
        draw_shadow(draw, 2 * in.shape.solid.slab_count, in.shadow);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        SceneView<Real> scene = view_of(in.shape);
        scene.materials = {&in.shadow.material, 1};
        scene.incidents = {in.shadow.incidents, 2};
        ShadowRay<Real> shadow{in.shape.ray, in.shadow.distance, &in.shadow.light};
        if (in.shadow.ends_at_hit) {
            Hit<Real> hit;
            closest_convex(scene, 0, shadow.ray, hit);
            shadow.distance = hit.t;
        }
        ShadowSum<> sum;
        shadow_convex<Real, Effects<all_effects>>(scene, 0, shadow, sum);
        add_shadow(scene, sum, out);
    }
};

}  // namespace cistula::parity
