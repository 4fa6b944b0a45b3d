// Rays and triangles that are special: along axes and faces, subnormal, not finite, from far away, without area, in one
// place; and random ones.
#pragma once

#include "cistula/shading/shadow.h"
#include "cistula/transport/pixel.h"
#include "verify/setup.h"

namespace cistula::verify::geometry {

/// Rays exactly in the plane of a face.
struct FacePlanes {
    enum class Kind { sheet, planes, triangles } kind;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Real half = kind == Kind::sheet    ? Real(0)
                          : kind == Kind::planes ? setup.scene.slabs[0].high
                                                 : magnitude(setup.point(0).x);
        const int axis = kind == Kind::sheet ? 2 : draw.between(0, 2);
        const Real plane = draw.one_in(2) ? half : -half;
        Vec3<Real> target = setup.any_point(draw);
        if (draw.one_in(2)) target = draw.in_cube(setup.extent());
        Vec3<Real> origin = draw.in_cube(setup.extent());
        origin[(axis + (draw.one_in(2) ? 1 : 2)) % 3] = Real(draw.sign() * 1.25) * setup.extent();  // beside the face
        origin[axis] = target[axis] = plane;
        Ray<Real> ray = ray_from(origin, target - origin);
        if (draw.one_in(2) && length(ray.direction) > Real(0)) {
            ray.direction = normalized(ray.direction);
            ray.direction[axis] = draw.one_in(2) ? Real(0) : Real(-0.0);
        }
        const Crossings found = cross_all(intersector, ray);
        if (kind == Kind::triangles)
            tally.expect(found.balanced() && found.enters <= 1);
        else
            tally.expect(found.are(0, 0) && found.sheets == 0);
    }
};

/// Rays along an axis at an upright cube; inside if both other coordinates are strictly between the planes.
struct AxisParallel {
    bool planes;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        // The cube stands about the frame's origin, so that its planes are where its corners are, or where slabs say.
        const Real half = planes ? setup.scene.slabs[0].high : magnitude(setup.point(0).x);
        const int axis = draw.between(0, 2);
        Ray<Real> ray = ray_from(Vec3<Real>(Real(0)), Vec3<Real>(Real(0)));
        bool within = true;
        bool on = false;
        for (int k = 0; k < 3; ++k) {
            if (k == axis) continue;
            const uint32_t kind = draw.below(4);
            Real at = draw.centered(Real(1));
            if (kind == 0) at = half;
            if (kind == 1) at = stepped(half, draw.between(-2, 2));
            if (kind == 2) at = Real(0);
            ray.origin[k] = draw.one_in(2) ? at : -at;
            ray.direction[k] = draw.one_in(2) ? Real(0) : Real(-0.0);
            within = within && at < half && -at < half;
            on = on || at == half || -at == half;
        }
        ray.direction[axis] = Real(draw.sign());
        ray.origin[axis] = Real(-1.25) * setup.extent() * ray.direction[axis];
        tally.witness(on);
        const Crossings found = cross_all(intersector, ray);
        // In the plane of a face of triangles the line may be on either side of it, but must leave if it enters.
        if (!planes && on)
            tally.expect(found.balanced() && found.enters <= 1);
        else
            tally.expect(within ? found.are(1, 1) : found.are(0, 0));
    }
};

/// Rays that start exactly in the plane of a cube's face, without state from a previous hit.
struct OnSlabPlanes {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t face = draw.below(3);
        const Slab<Real>& slab = setup.scene.slabs[face];
        const int axis = slab.normal.x != Real(0) ? 0 : slab.normal.y != Real(0) ? 1 : 2;
        const int side = draw.sign();
        Ray<Real> ray;
        for (int k = 0; k < 3; ++k) ray.origin[k] = draw.centered(Real(0.99) * slab.high);
        ray.origin[axis] = side > 0 ? slab.high : -slab.high;
        Vec3<double> way = on_sphere(draw);
        const uint32_t kind = draw.below(4);
        if (kind == 0) way[axis] = 0;                                     // along the face
        if (kind == 1) way = Vec3<double>(0.0), way[axis] = draw.sign();  // straight
        if (kind >= 2 && magnitude(way[axis]) < 0.01) way[axis] = 0.5;
        ray.direction = Vec3<Real>(way);
        const Real outward = ray.direction[axis] * Real(side);
        if (outward < Real(0)) {
            const Hit<Real> first = intersector.closest(ray);
            tally.expect(first.found() && first.t == Real(0) && first.enters && cross_all(intersector, ray).are(1, 1));
        } else {
            tally.expect(cross_all(intersector, ray).are(0, 0));
        }
    }
};

/// Whether two rays, which differ in the signs of zeros only, have the same crossings to the bit.
template <class Real, class Tracer>
CISTULA_HD inline bool same_crossings(const Tracer& intersector, Ray<Real> a, Ray<Real> b) {
    for (uint32_t i = 0; i < 64; ++i) {
        const Hit<Real> at = intersector.closest(a);
        const Hit<Real> other = intersector.closest(b);
        if (at.key != other.key || at.t != other.t || at.u != other.u || at.v != other.v) return false;
        if (!at.found()) return true;
        const int change = media_change(key_kind(at.key));
        a.media.add(key_solid(at.key), change);
        b.media.add(key_solid(at.key), change);
        a.after = b.after = {at.t, at.key};
    }
    return false;
}

struct SignedZeros {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> target = setup.any_point(draw);
        Ray<Real> ray = ray_from(Vec3<Real>(on_sphere(draw) * (1.9 * double(setup.extent()))), Vec3<Real>(Real(0)));
        ray.direction = normalized(target - ray.origin);
        const int axis = draw.between(0, 2);
        const int other = draw.between(0, 2);
        if (other != axis && draw.one_in(2)) {  // along the third axis
            ray.direction[axis] = ray.direction[other] = Real(0);
            ray.origin[axis] = target[axis], ray.origin[other] = target[other];
            ray.direction[3 - axis - other] = Real(draw.sign());
            ray.origin[3 - axis - other] = Real(-1.25) * setup.extent() * ray.direction[3 - axis - other];
        } else {
            ray.direction[axis] = Real(0);
            ray.origin[axis] = target[axis];
        }
        if (draw.one_in(4)) ray.origin[axis] = Real(0);
        Ray<Real> negative = ray;
        for (int k = 0; k < 3; ++k) {
            if (ray.direction[k] == Real(0)) ray.direction[k] = Real(0), negative.direction[k] = Real(-0.0);
            if (ray.origin[k] == Real(0)) ray.origin[k] = Real(0), negative.origin[k] = Real(-0.0);
        }
        tally.expect(same_crossings(intersector, ray, negative));
    }
};

/// Directions with subnormal components. Numbers: the solid's planes.
struct Subnormals {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        constexpr int lowest = 1 - Layout<Real>::bias - Layout<Real>::digits;
        const int axis = draw.between(0, 2);
        Ray<Real> ray = ray_from(setup.any_point(draw), Vec3<Real>(Real(0)));
        for (int k = 0; k < 3; ++k) {
            if (draw.one_in(4)) ray.origin[k] = draw.centered(setup.extent());
            const Real tiny = two_to<Real>(draw.between(lowest, draw.one_in(2) ? lowest + Layout<Real>::digits : -60));
            ray.direction[k] = draw.one_in(2) ? tiny : -tiny;
        }
        ray.direction[axis] = Real(draw.sign());
        ray.origin[axis] = Real(-1.25) * setup.extent() * ray.direction[axis];
        expect_ways(tally, cross_all(intersector, ray), setup.numbers, 1e-4, Vec3<double>(ray.origin),
                    Vec3<double>(ray.direction));
    }
};

/// Cameras so far away that the scene is a point in float: rays start near the scene, computed in double. Numbers: the
/// solid's planes.
struct FarCameras {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double powers[] = {1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
        const double distance = powers[draw.below(7)] * (1 + draw.unit<double>());
        FrameView frame;
        frame.camera.position = on_sphere(draw) * (distance * double(setup.extent()));
        frame.camera_sides[0].start = frame.camera.position;
        frame.is_far = true;
        const bool at_edge = draw.one_in(2);
        const Vec3<double> inner = in_ball(draw) * double(setup.extent());
        const Vec3<double> target = at_edge ? setup.points[draw.below(setup.points.size)] : inner;
        const Vec3<double> way = normalized(target - frame.camera.position);
        // The line itself, about the point of it that is nearest to the scene's center: 1e9 away its direction, in
        // double, is good to 1e9 * 2^-52 = 2e-7 there.
        const Vec3<double> nearest = along(frame.camera.position, -dot(frame.camera.position, way), way);
        const double margin = 1e-4;
        Ray<Real> ray;
        double start;
        if (!primary_ray<Real>(setup.scene, frame, way, ray, start)) {
            tally.expect(chord(setup.numbers, -margin, nearest, way) < 0);
            return;
        }
        expect_ways(tally, cross_all(intersector, ray), setup.numbers, margin, nearest, way);
    }
};

struct NotFiniteRays {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        Ray<Real> ray = ray_from(Vec3<Real>(on_sphere(draw)), Vec3<Real>(on_sphere(draw)));
        const uint32_t broken = 1 + draw.below(63);  // bits: which of the six numbers
        for (int k = 0; k < 6; ++k) {
            const uint32_t kind = draw.below(3);
            const Real bad = kind == 0   ? no_number<Real>
                             : kind == 1 ? RealTraits<Real>::infinity
                                         : -RealTraits<Real>::infinity;
            if (broken >> k & 1u) (k < 3 ? ray.origin[k] : ray.direction[k - 3]) = bad;
        }
        if (draw.one_in(4)) ray.media.add(draw.below(20), 1);
        const ShadowRay<Real> shadow{ray, Real(1), &setup.scene.lights[0]};
        const Vec3<Real> light = intersector.template transmittance<Effects<all_effects>>(shadow);
        tally.expect(!intersector.closest(ray).found() && light.x == Real(0) && light.y == Real(0) &&
                     light.z == Real(0));
    }
};

/// Rays with finite but extreme directions: hits are in order, and queries terminate. Rays start within 2 M and
/// directions are no longer than 1, as the renderer's are: Embree's own checks abort on numbers above 2^60.
struct ExtremeRays {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Real least = two_to<Real>(1 - Layout<Real>::bias - Layout<Real>::digits);
        Ray<Real> ray = ray_from(Vec3<Real>(on_sphere(draw)), Vec3<Real>(on_sphere(draw)));
        const uint32_t changed = 1 + draw.below(63);
        for (int k = 0; k < 6; ++k) {
            const Real numbers[] = {RealTraits<Real>::least_normal,
                                    -RealTraits<Real>::least_normal,
                                    least,
                                    -least,
                                    Real(0),
                                    Real(-0.0),
                                    Real(1e-20),
                                    Real(-1e-30)};
            const Real extreme = numbers[draw.below(8)];
            if (changed >> k & 1u) (k < 3 ? ray.origin[k] : ray.direction[k - 3]) = extreme;
        }
        if (draw.one_in(8)) ray.direction = Vec3<Real>(Real(0));
        tally.expect(cross_all(intersector, ray).in_order);
    }
};

struct Coincident {
    uint32_t solids;  // 1: all copies in one sheet; else one sheet each

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> a = setup.point(draw.below(3));
        const Vec3<Real> b = setup.point(draw.below(3));
        const Vec3<Real> middle = (setup.point(0) + setup.point(1) + setup.point(2)) * Real(1.0 / 3.0);
        const Vec3<Real> edge = along(a, draw.unit<Real>(), b - a);
        const Vec3<Real> target = draw.one_in(2) ? along(middle, Real(0.9) * draw.unit<Real>(), edge - middle) : edge;
        Ray<Real> ray = aimed(setup, draw, Vec3<Real>(on_sphere(draw) * (1.9 * double(setup.extent()))), target);
        uint32_t met = 0;
        Real t = 0;
        bool in_order = true;
        for (; met <= solids; ++met) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found()) break;
            if (met == 0) t = hit.t;
            const uint32_t last = solids - 1 - met;
            in_order = in_order && hit.t == t && key_face(hit.key) == last && key_solid(hit.key) == last;
            ray.after = {hit.t, hit.key};
        }
        tally.witness(met == solids);
        tally.expect(in_order && (met == 0 || met == solids));
    }
};

/// Rays at degenerate triangles, and a valid one that is number 0.
struct Degenerate {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> a = setup.any_point(draw);
        const Vec3<Real> b = setup.any_point(draw);
        const Vec3<Real> target = draw.one_in(2) ? a : along(a, draw.unit<Real>(), b - a);
        const Ray<Real> ray = aimed(setup, draw, Vec3<Real>(on_sphere(draw) * (1.9 * double(setup.extent()))), target);
        const Hit<Real> hit = intersector.closest(ray);
        tally.witness(hit.found() && key_face(hit.key) == 0);
        tally.expect(!hit.found() || (key_face(hit.key) == 0 && is_finite(hit.t)));
    }
};

/// t, u, v and key of three crossings, as a word.
struct RandomRays {
    template <class Real, class Tracer>
    CISTULA_HD uint64_t fingerprint(const Setup<Real>& setup, const Tracer& intersector, uint64_t i) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        const double far = draw.one_in(5) ? 0.9 : 1.9;
        const Vec3<Real> origin(on_sphere(draw) * (far * extent));
        const uint32_t kind = draw.below(4);
        const Vec3<Real> vertex = setup.any_point(draw);
        const Vec3<Real> other = setup.any_point(draw);
        Vec3<Real> target = draw.in_cube(setup.extent());
        if (kind == 0) target = vertex;
        if (kind == 1) target = along(vertex, draw.unit<Real>(), other - vertex);
        Ray<Real> ray = aimed(setup, draw, origin, target);
        if (draw.one_in(16)) {
            ray.direction = Vec3<Real>(Real(0));
            const int axis = draw.between(0, 2);
            ray.direction[axis] = Real(draw.sign());
            ray.origin = target;
            ray.origin[axis] = Real(-1.25) * setup.extent() * ray.direction[axis];
        }
        uint64_t word = 0;
        for (int crossing = 0; crossing < 3; ++crossing) {
            const Hit<Real> hit = intersector.closest(ray);
            word = mixed(word ^ hit.key);
            word = mixed(word ^ bits(hit.t));
            word = mixed(word ^ bits(hit.u));
            word = mixed(word ^ bits(hit.v));
            word = mixed(word ^ (2 * uint64_t(hit.slot) + uint64_t(hit.enters)));
            if (!hit.found()) break;
            const int change = media_change(key_kind(hit.key));
            if (change != 0) ray.media.add(key_solid(hit.key), change);
            ray.after = {hit.t, hit.key};
        }
        return word;
    }

  private:
    template <class Real>
    CISTULA_HD static uint64_t bits(Real x) {
        return uint64_t(bits_as<typename Layout<Real>::Bits>(x));
    }
};

}  // namespace cistula::verify::geometry
