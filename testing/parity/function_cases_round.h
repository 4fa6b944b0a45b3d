// Function parity, balls and disks: rays that start outside, inside and on them, aimed at centers, rims and tangents.
#pragma once

#include "cistula/geometry/ball.h"
#include "cistula/geometry/disk.h"
#include "testing/parity/function_case.h"

namespace cistula::parity {

/// A ball, and another that may be of its family.
template <class Real>
struct BallInput {
    Ball<Real> balls[2];
    Solid solids[2];
    uint32_t convex[2];
    Ray<Real> ray;
};

/// A ray from `origin` to `target`, or anywhere where they are one place.
template <class Real>
CISTULA_HD inline void aim(Draw& draw, const Vec3<Real>& origin, const Vec3<Real>& target, Ray<Real>& ray) {
    ray.origin = origin;
    const Vec3<Real> way = target - origin;
    ray.direction = dot(way, way) > Real(0x1p-60) ? normalized(way) : draw.direction<Real>();
    if (!draw.one_in(8)) return;
    const int axis = draw.between(0, 2);
    ray.direction = Vec3<Real>(Real(0));
    ray.direction[axis] = Real(draw.sign());
}

/// A place on a ball, inside it, just beside its surface, its center, or anywhere.
template <class Real>
CISTULA_HD inline Vec3<Real> draw_near_ball(Draw& draw, const Ball<Real>& ball) {
    const Vec3<Real> way = draw.direction<Real>();
    switch (draw.below(6)) {
        case 0:
            return ball.center;
        case 1:
            return along(ball.center, ball.radius * draw.unit<Real>(), way);
        case 2:
            return along(ball.center, ball.radius * (Real(1) + draw.centered(Real(0x1p-20))), way);
        case 3:
            return draw.in_cube<Real>(Real(3));
        default:
            return along(ball.center, ball.radius, way);
    }
}

/// Case: the first two crossings of a ball, the first again with `best` just before or behind it, chord and normal.
template <class Real>
struct BallCase : CaseOf<Real, 12> {
    static constexpr const char* name = "ball";
    using Input = BallInput<Real>;
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        for (uint32_t i = 0; i < 2; ++i) {
            in.balls[i] = {};
            in.balls[i].center = draw.one_in(2) ? Vec3<Real>(Real(0)) : draw.in_cube<Real>(Real(0.5));
            in.balls[i].radius = draw.one_in(2) ? Real(1) : magnitude(draw.scaled<Real>(-14, -1));
            in.balls[i].family = i;
            in.solids[i] = {};
            in.solids[i].kind = SolidKind::convex;
            in.solids[i].first_slab = i;
            in.convex[i] = i;
        }
        if (draw.one_in(2)) {
            in.balls[1] = in.balls[0];
            in.balls[0].has_kin = in.balls[1].has_kin = 1;
        }
        const Vec3<Real> origin = draw_near_ball(draw, in.balls[0]);
        aim(draw, origin, draw_near_ball(draw, in.balls[0]), in.ray);
        if (draw.one_in(3)) {  // along the surface
            const Vec3<Real> beside = cross(origin - in.balls[0].center, draw.direction<Real>());
            if (dot(beside, beside) > Real(0x1p-40)) in.ray.direction = normalized(beside);
        }
        if (draw.one_in(3)) in.ray.media.add(0, 1);
        if (draw.one_in(3)) in.ray.from_solid = draw.below(2);
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        SceneView<Real> scene;
        scene.solids = {in.solids, 2};
        scene.balls = {in.balls, 2};
        scene.convex = {in.convex, 2};
        scene.extent = Real(1.5);
        Ray<Real> ray = in.ray;
        const bool inside = ray.media.contains(0);
        Hit<Real> first, second;
        closest_ball(scene, 0, ray, inside, !inside, first);
        const Vec3<Real> normal = ball_normal(in.balls[0].center, ray, first.found() ? first.t : Real(0));
        if (first.found()) {
            ray.after = {first.t, first.key};
            closest_ball(scene, 0, ray, !inside, inside, second);
        }
        Hit<Real> tied = first;
        tied.key = first.key + (in.ray.from_solid & 2u) - 1;
        closest_ball(scene, 0, in.ray, inside, !inside, tied);
        const auto chord = BallChord<Real>::of(in.balls[0], in.ray.origin, in.ray.direction);
        out.real(first.t);
        out.bits(first.key);
        out.bits(first.enters);
        out.real(second.t);
        out.bits(second.key);
        out.bits(tied.key);
        out.real(chord.middle);
        out.real(chord.square);
        out.bits(chord.is_ahead);
        out.vec(normal);
    }
};

/// A disk on its plane, near a ball or not, and a ball for rays to start on.
template <class Real>
struct DiskInput {
    Disk<Real> disk;
    SharedPlane<Real> plane;
    BallPlane<Real> near_ball;
    Solid solids[2];
    Ray<Real> ray;
};

/// A place on a disk, on its rim, on its plane beside it, or anywhere.
template <class Real>
CISTULA_HD inline Vec3<Real> draw_near_disk(Draw& draw, const DiskInput<Real>& in) {
    const Real turn = draw.centered(Real(2)), radius = square_root(min_or_second(in.disk.square, Real(9)));
    const Vec3<Real> way = normalized(along(in.disk.axes[0], turn, in.disk.axes[1])) * Real(draw.sign());
    switch (draw.below(5)) {
        case 0:
            return in.disk.center;
        case 1:
            return along(in.disk.center, radius, way);
        case 2:
            return along(in.disk.center, radius * Real(2) * draw.unit<Real>(), way);
        case 3: {
            const Real distance = radius * draw.unit<Real>();
            return along(along(in.disk.center, distance, way), draw.centered(Real(0x1p-20)), in.plane.normal);
        }
        default:
            return draw.in_cube<Real>(Real(3));
    }
}

/// Case: the next crossing of a disk, that after it, where its plane is crossed, and a start moved near the scene.
template <class Real>
struct DiskCase : CaseOf<Real, 14> {
    static constexpr const char* name = "disk";
    using Input = DiskInput<Real>;
    CISTULA_HD static Input make(Draw& draw) {
        Input in;
        in.plane = {};
        in.plane.normal = draw.direction<Real>();
        if (draw.one_in(2)) {
            const int axis = draw.between(0, 2);
            in.plane.normal = Vec3<Real>(Real(0));
            in.plane.normal[axis] = Real(draw.sign());
        }
        in.disk = {};
        in.disk.center = draw.one_in(2) ? Vec3<Real>(Real(0)) : draw.in_cube<Real>(Real(0.5));
        const Real radius = draw.one_in(4) ? Real(0x1p12) : magnitude(draw.scaled<Real>(-10, 0));
        in.disk.square = radius * radius;
        in.disk.least_slope = radius > Real(1000) ? horizon<Real> : Real(2);
        const bool upright = magnitude(in.plane.normal.x) < Real(0.5);
        in.disk.axes[0] = normalized(cross(
            in.plane.normal, upright ? Vec3<Real>(Real(1), Real(0), Real(0)) : Vec3<Real>(Real(0), Real(1), Real(0))));
        in.disk.axes[1] = cross(in.plane.normal, in.disk.axes[0]);
        for (Real& shift : in.disk.shift) shift = draw.centered(Real(1));
        in.plane.offset = dot(in.plane.normal, in.disk.center);
        in.near_ball = {in.plane.normal, in.plane.offset, draw.one_in(2) ? 0 : no_plane};
        for (Solid& solid : in.solids) solid = {};
        in.solids[0].kind = SolidKind::sheet;
        in.solids[0].slab_count = disk_slabs;
        in.solids[0].first_group = draw.below(2);
        in.solids[1].kind = SolidKind::convex;
        const Vec3<Real> origin = draw_near_disk(draw, in);
        aim(draw, origin, draw_near_disk(draw, in), in.ray);
        if (draw.one_in(8)) in.ray.origin = along(origin, Real(-1000) * draw.unit<Real>(), in.ray.direction);
        if (draw.one_in(16)) in.ray.from_plane = 0;
        if (draw.one_in(4)) {
            in.ray.from_solid = 1;
            in.ray.from_face = 2 + draw.below(2);
        }
        return in;
    }
    CISTULA_HD static void run(const Input& in, Words& out) {
        SceneView<Real> scene;
        scene.solids = {in.solids, 2};
        scene.shared_planes = {&in.plane, 1};
        scene.ball_planes = {&in.near_ball, 1};
        scene.disks = {&in.disk, 1};
        scene.extent = Real(1.5);
        using All = Effects<all_effects>;
        Ray<Real> ray = in.ray;
        const Real moved = start_near<All>(scene, ray);
        Hit<Real> first, second;
        closest_disk<All>(scene, true, ray, first);
        Real t(0);
        Vec3<Real> at(Real(0));
        const bool crossed = cross_disk(scene, in.disk, ray, t, at);
        if (first.found()) {
            ray.after = {first.t, first.key};
            closest_disk<All>(scene, true, ray, second);
        }
        out.real(first.t);
        out.bits(first.key);
        out.real(first.u);
        out.real(first.v);
        out.bits(first.enters);
        out.bits(second.key);
        out.bits(crossed);
        out.real(t);
        out.vec(at);
        out.real(moved);
        out.real(ray.after.t);
        out.real(begin_of(in.ray));
    }
};

}  // namespace cistula::parity
