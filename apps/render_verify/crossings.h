// Rays and their crossings, shared by cases on host and device.
#pragma once

#include "apps/render_verify/setup.h"

namespace cistula::verify {

/// A uniform point in the unit ball, by rejection; terminates for every sequence of draws.
CISTULA_HD inline Vec3<double> in_ball(Draw& draw) {
    for (int i = 0; i < 64; ++i) {
        const Vec3<double> p = draw.in_cube<double>(1.0);
        if (dot(p, p) <= 1) return p;
    }
    return Vec3<double>(0.0);
}
CISTULA_HD inline Vec3<double> on_sphere(Draw& draw) {
    for (int i = 0; i < 64; ++i) {
        const Vec3<double> p = draw.in_cube<double>(1.0);
        const double square = dot(p, p);
        if (square <= 1 && square > 0x1p-20) return p / square_root(square);
    }
    return Vec3<double>(0.0, 0.0, 1.0);
}

template <class Real>
CISTULA_HD inline Ray<Real> ray_from(const Vec3<Real>& origin, const Vec3<Real>& direction) {
    Ray<Real> ray;
    ray.origin = origin;
    ray.direction = direction;
    return ray;
}

/// A ray from `origin` at `target`. Convex solids need unit directions; among triangles alone, half of the directions
/// are not normalized, so that more of the sheared corners are exactly 0.
template <class Real>
CISTULA_HD inline Ray<Real> aimed(const Setup<Real>& setup, Draw& draw, const Vec3<Real>& origin,
                                  const Vec3<Real>& target) {
    const Vec3<Real> way = target - origin;
    const bool unit = draw.one_in(2) || !setup.scene.convex.empty();
    return ray_from(origin, unit ? normalized(way) : way);
}

template <class Real>
CISTULA_HD inline Ray<Real> inside(Ray<Real> ray, uint32_t solid) {
    ray.media.add(solid, 1);
    return ray;
}

/// Starts a new line on a face as the ray tree does.
template <class Real>
CISTULA_HD inline Ray<Real> leaving(const Vec3<Real>& origin, const Vec3<Real>& direction, const Hit<Real>& hit,
                                    const InteriorList& media) {
    Ray<Real> ray = ray_from(origin, direction);
    ray.from_solid = key_solid(hit.key);
    ray.from_face = key_face(hit.key);
    ray.media = media;
    return ray;
}

struct Crossings {
    uint32_t enters = 0, leaves = 0, sheets = 0;
    bool in_order = true;  // (t, key) increased throughout, and the crossings ended

    CISTULA_HD bool balanced() const { return in_order && enters == leaves; }
    CISTULA_HD bool are(uint32_t entered, uint32_t left) const {
        return in_order && enters == entered && leaves == left;
    }
};

inline constexpr uint32_t most_crossings = 1u << 18;

/// Follows a line through all crossings until nothing is hit; a line that starts on no face hits all. `only`: the solid
/// whose crossings count; no_solid: all.
template <class Real, class Intersector>
CISTULA_HD inline Crossings cross_all(const Intersector& intersector, Ray<Real> ray, uint32_t only = no_solid) {
    Crossings found;
    if (ray.from_solid == no_solid && ray.fresh()) ray.accept_both_sides();
    for (uint32_t i = 0; i < most_crossings; ++i) {
        const Hit<Real> hit = intersector.closest(ray);
        if (!hit.found()) return found;
        if (!ray.after.before(hit.t, hit.key)) break;
        const CrossingKind kind = key_kind(hit.key);
        if (only == no_solid || key_solid(hit.key) == only)
            ++(kind == CrossingKind::enter ? found.enters : kind == CrossingKind::leave ? found.leaves : found.sheets);
        if (media_change(kind) != 0) ray.media.add(key_solid(hit.key), media_change(kind));
        ray.after = {hit.t, hit.key};
    }
    found.in_order = false;
    return found;
}

/// Length of a line inside a convex body whose planes are moved inward by `margin`; negative if it misses the body.
/// `planes`: outward unit normal and distance, four numbers each. Closed form, in double.
CISTULA_HD inline double chord(const Span<double>& planes, double margin, const Vec3<double>& origin,
                               const Vec3<double>& direction) {
    double enter = -1e300, leave = 1e300;
    for (uint32_t i = 0; i + 3 < planes.size; i += 4) {
        const Vec3<double> normal(planes[i], planes[i + 1], planes[i + 2]);
        const double nd = dot(normal, direction), rest = planes[i + 3] - margin - dot(normal, origin);
        if (nd == 0 && rest <= 0) return -1;
        if (nd < 0) enter = max_or_second(enter, rest / nd);
        if (nd > 0) leave = min_or_second(leave, rest / nd);
    }
    return leave - enter;
}

}  // namespace cistula::verify
