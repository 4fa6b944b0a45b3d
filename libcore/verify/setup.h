// What a ray of a case is given, equal on host and device: scene, lists of its part, random draws; and what it counts.
#pragma once

#include "cistula/traversal/bvh.h"
#include "verify/draw.h"

namespace cistula::verify {

/// A part's scene and lists in memory readable by the running code. All lengths are in the scene's frame.
template <class Real>
struct Setup {
    SceneView<Real> scene;
    Span<Vec3<double>> points;  // targets, before they are rounded to Real as vertices are
    Span<double> numbers;       // data of the case
    double factor = 1;          // frame lengths per world length, a power of two
    uint64_t seed = 0;          // of the random draws of this part

    CISTULA_HD Draw draw(uint64_t i) const { return Draw(i, seed); }
    CISTULA_HD Vec3<Real> point(uint64_t i) const { return Vec3<Real>(points[uint32_t(i)]); }
    CISTULA_HD Vec3<Real> any_point(Draw& draw) const { return point(draw.below(points.size)); }
    CISTULA_HD Real extent() const { return scene.extent; }
    /// The numbers from `first` on, and three of them as a vector.
    CISTULA_HD Span<double> numbers_from(uint32_t first) const { return {numbers.data + first, numbers.size - first}; }
    CISTULA_HD Vec3<double> vector(uint32_t first) const {
        return {numbers[first], numbers[first + 1], numbers[first + 2]};
    }
    /// k u M.
    CISTULA_HD double units(double k) const { return k * double(RealTraits<Real>::unit) * double(scene.extent); }
};

/// Encoding of a place in a case: number of the part in the upper bits, number of the ray in the lower 40.
inline constexpr int place_shift = 40;
inline constexpr uint64_t no_place = ~uint64_t(0);

/// The results of a case so far: sums and extremes only, so that they do not depend on the order of threads, tiles and
/// devices.
struct Tally {
    uint64_t tried = 0;
    uint64_t failures = 0;
    uint64_t witnesses = 0;        // tries in which the hazard occurred; cases with needs_witness need some
    double worst = 0;              // the largest deviation; 1 if something failed
    uint64_t worst_at = no_place;  // the smallest place with that deviation
    uint64_t place = no_place;     // of the current ray; set by the framework

    CISTULA_HD void expect(bool holds) {
        ++tried;
        if (holds) return;
        ++failures;
        note(1, place);
    }
    /// Records a deviation >= 0. NaN counts as infinite.
    CISTULA_HD void measure(double deviation) {
        ++tried;
        note(deviation == deviation ? deviation : RealTraits<double>::infinity, place);
    }
    CISTULA_HD void witness(bool met) { witnesses += met ? 1 : 0; }

    CISTULA_HD void merge(const Tally& other) {
        tried += other.tried;
        failures += other.failures;
        witnesses += other.witnesses;
        note(other.worst, other.worst_at);
    }

  private:
    CISTULA_HD void note(double deviation, uint64_t at) {
        if (deviation > worst || (deviation == worst && deviation > 0 && at < worst_at))
            worst = deviation, worst_at = at;
    }
};

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
    uint32_t enters = 0;
    uint32_t leaves = 0;
    uint32_t sheets = 0;
    bool in_order = true;  // (t, key) increased throughout, and the crossings ended

    CISTULA_HD bool balanced() const { return in_order && enters == leaves; }
    CISTULA_HD bool are(uint32_t entered, uint32_t left) const {
        return in_order && enters == entered && leaves == left;
    }
};

inline constexpr uint32_t most_crossings = 1u << 18;

/// Follows a line through all crossings until nothing is hit; a line that starts on no face hits all. `only`: the solid
/// whose crossings count; no_solid: all.
template <class Real, class Tracer>
CISTULA_HD inline Crossings cross_all(const Tracer& intersector, Ray<Real> ray, uint32_t only = no_solid) {
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
        const double nd = dot(normal, direction);
        const double rest = planes[i + 3] - margin - dot(normal, origin);
        if (nd == 0 && rest <= 0) return -1;
        if (nd < 0) enter = max_or_second(enter, rest / nd);
        if (nd > 0) leave = min_or_second(leave, rest / nd);
    }
    return leave - enter;
}

/// Expects as many ways into a convex body as out of it: one each where the line is inside by a margin, none where it
/// is outside by as much. `planes` as for chord().
CISTULA_HD inline void expect_ways(Tally& tally, const Crossings& found, const Span<double>& planes, double margin,
                                   const Vec3<double>& origin, const Vec3<double>& direction) {
    const bool through = chord(planes, margin, origin, direction) > margin;
    const bool past = chord(planes, -margin, origin, direction) < 0;
    tally.witness(through);
    tally.expect(found.balanced() && (!through || found.are(1, 1)) && (!past || found.are(0, 0)));
}

}  // namespace cistula::verify
