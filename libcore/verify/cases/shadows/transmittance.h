// How much of a light arrives: through closed bodies, sheets and glass, and beside them, of lights anywhere and on
// faces.
#pragma once

#include "cistula/lights/visible_light.h"
#include "cistula/shading/shadow.h"
#include "verify/setup.h"

namespace cistula::verify::shadows {

using All = Effects<all_effects>;

/// A shadow ray from a point in space to a light, aimed as in add_local_light.
template <class Real>
CISTULA_HD inline ShadowRay<Real> shadow_ray(const Setup<Real>& setup, const Vec3<Real>& origin, uint32_t light) {
    const Light<Real>& to = setup.scene.lights[light];
    Vec3<Real> direction = to.position - origin;
    const Real distance = length(direction);
    direction *= Real(1) / distance;
    return {ray_from(origin, direction), distance, &to};
}

/// What arrives through faces of glass, which take 2^-glass_halvings each, or opaque ones.
inline constexpr int glass_halvings = 2;
template <class Real>
CISTULA_HD inline Vec3<Real> through_faces(int faces, bool glass) {
    if (faces == 0) return Vec3<Real>(Real(1));
    return Vec3<Real>(glass ? two_to<Real>(-glass_halvings * faces) : Real(0));
}

/// Points outside a solid with lights inside. Numbers: the radius, the rounding of scene units, the solid's planes from
/// first_plane on.
struct FromOutside {
    static constexpr uint32_t first_plane = 2;
    uint32_t solid;
    int halvings;  // of the light at each face; negative: opaque

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = draw.below(setup.scene.lights.size);
        const Vec3<double> from(setup.scene.lights[light].position);
        const Vec3<double> target(setup.points[uint32_t(i % setup.points.size)]);
        // Beyond an edge or a corner, in the line of the light; some a hair beside it.
        const double extent = double(setup.extent());
        const double radius = setup.numbers[0];
        double beyond = 1 + two_to<double>(-draw.between(0, 8));
        if (draw.one_in(4)) beyond = 1 + draw.unit<double>() * (extent / radius);
        const Vec3<double> jitter = draw.in_cube<double>(8 * double(RealTraits<Real>::unit) * extent);
        const bool exact = draw.one_in(2);
        const Vec3<Real> origin(from + (target - from) * beyond + (exact ? Vec3<double>(0.0) : jitter));
        if (dot(origin, origin) > Real(4 * extent * extent)) return;
        double over = -1e300;
        for (uint32_t k = first_plane; k + 3 < setup.numbers.size; k += 4)
            over = max_or_second(over, dot(Vec3<double>(setup.numbers[k], setup.numbers[k + 1], setup.numbers[k + 2]),
                                           Vec3<double>(origin)) -
                                           setup.numbers[k + 3]);
        // Outside for sure: planes, corners and points are rounded by a few u M each.
        if (!(over > 32 * double(RealTraits<Real>::unit) * extent + setup.numbers[1])) return;
        const ShadowRay<Real> shadow = shadow_ray(setup, origin, light);
        const Vec3<Real> found = intersector.template transmittance<All>(shadow);
        tally.expect(found == Vec3<Real>(halvings < 0 ? Real(0) : two_to<Real>(-halvings)));
        if (halvings < 0)
            tally.expect(intersector.template transmittance<Effects<opaque_bodies | effect_lights_on_faces>>(shadow) ==
                         Real(0));
    }
};

/// Shadow rays through a pile of sheets, each a grid of triangles. Numbers: the axis of the pile, and the coordinate on
/// it where lines begin.
struct ThroughSheets {
    int loss[3];  // halvings; the last channel is opaque if it is negative

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = draw.below(setup.scene.lights.size);
        const Vec3<double> from(setup.scene.lights[light].position),
            axis(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
        // At a corner, an edge or a diagonal of some sheet; every third line somewhere near, so that all go through all
        // sheets.
        Vec3<double> target(setup.any_point(draw));
        const Vec3<double> aside = draw.in_cube<double>(0.03125);
        if (draw.one_in(3)) target += aside;
        const double down = (setup.numbers[3] - dot(axis, from)) / dot(axis, target - from);
        const Vec3<Real> origin(from + (target - from) * down);
        const Vec3<Real> found = intersector.template transmittance<All>(shadow_ray(setup, origin, light));
        for (int c = 0; c < 3; ++c) tally.expect(found[c] == (loss[c] < 0 ? Real(0) : two_to<Real>(-loss[c])));
    }
};

/// Closed solids of planes and of triangles in a row; solid s takes 2^-(1 << s) at each of its faces, so that the share
/// tells which were crossed, and how often. Numbers: how many numbers the planes of each take, then the planes.
struct ThroughSolids {
    static constexpr uint32_t solids = 5;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = draw.below(setup.scene.lights.size);
        const Vec3<double> from(setup.scene.lights[light].position);
        const Vec3<double> target(setup.any_point(draw));
        // Length of the line beyond the target: past the whole scene.
        const double reach = 1.7 * double(setup.extent());
        const Vec3<double> way = normalized(target - from);
        const double ahead = dot(target, way);
        const double rest = reach * reach - (dot(target, target) - ahead * ahead);
        if (!(rest > 0)) return;
        const Vec3<Real> origin(target + way * (square_root(rest) - ahead));
        const ShadowRay<Real> shadow = shadow_ray(setup, origin, light);
        const Vec3<Real> found = intersector.template transmittance<All>(shadow);
        // 64 u M: points, corners, planes and direction round by a few u M each over a way of 4 M.
        const double doubt = setup.units(64);
        const Vec3<double> start(shadow.ray.origin), direction = normalized(Vec3<double>(shadow.ray.direction));
        uint32_t sure = 0;
        uint32_t possible = 0;
        uint32_t first = solids;
        for (uint32_t s = 0; s < solids; ++s) {
            const uint32_t size = uint32_t(setup.numbers[s]);
            const Span<double> planes{setup.numbers.data + first, size};
            first += size;
            if (chord(planes, doubt, start, direction) > doubt) sure |= 1u << s;
            if (chord(planes, -doubt, start, direction) >= -doubt) possible |= 1u << s;
        }
        uint32_t losses = 1;
        while (losses < 100 && found.x != two_to<Real>(-int(losses) + 1)) ++losses;
        --losses;  // the share is 2^-losses; two faces a solid make it even
        const uint32_t crossed = losses / 2;
        tally.witness(sure != possible);
        tally.expect(losses < 99 && losses % 2 == 0 && (crossed & sure) == sure && (crossed & ~possible) == 0 &&
                     found.y == found.x && found.z == found.x);
    }
};

/// Shadow rays from random points. Numbers: for each light and solid the faces on which the light lies; then the planes
/// of each solid.
struct HalfSpaces {
    uint32_t solids, faces, lights;
    bool glass;

    CISTULA_HD double height(const Span<double>& numbers, uint32_t s, uint32_t f, const Vec3<double>& p) const {
        const uint32_t k = lights * solids + 4 * (s * faces + f);
        return dot(Vec3<double>(numbers[k], numbers[k + 1], numbers[k + 2]), p) - numbers[k + 3];
    }

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        const uint32_t light = draw.below(lights);
        const Vec3<double> at(setup.scene.lights[light].position);
        const Vec3<double> somewhere = in_ball(draw) * (1.9 * extent);
        const double nearer = draw.one_in(2) ? 1 : two_to<double>(-draw.between(0, 10));
        const Vec3<Real> origin(at + (somewhere - at) * nearer);
        // A point this close to a plane is on neither side for sure: normal, dot product, distance and the corners of
        // triangles round by 11 u M together, and a face's plane by ten times its corners' u M at the scene's far end.
        const double doubt = setup.units(64);
        ShadowRay<Real> shadow = shadow_ray(setup, origin, light);
        int crossed = 0;
        for (uint32_t s = 0; s < solids; ++s) {
            const uint32_t incident = uint32_t(setup.numbers[light * solids + s]);
            double over_incident = -1e300, over = -1e300;
            for (uint32_t f = 0; f < faces; ++f) {
                const double h = height(setup.numbers, s, f, Vec3<double>(origin));
                over = max_or_second(over, h);
                if (incident >> f & 1u) over_incident = max_or_second(over_incident, h);
            }
            if (magnitude(over_incident) <= doubt || magnitude(over) <= doubt) return;
            if (over_incident > 0) continue;
            if (over < 0)
                shadow.ray.media.add(s, 1);
            else
                ++crossed;
        }
        const Vec3<Real> found = intersector.template transmittance<All>(shadow);
        tally.witness(crossed != 0);
        tally.expect(found == through_faces<Real>(crossed, glass));
    }
};

/// Lights on edges and corners of a nonconvex mesh: they are hidden by what lies between, not by the triangles that
/// they lie on. Numbers: the corners of the mesh's triangles, nine per triangle; then for each light the triangles on
/// which it lies, 30 bits per number.
struct LightsOnStar {
    uint32_t triangles, lights;
    bool glass;

    CISTULA_HD Vec3<double> corner(const Span<double>& numbers, uint32_t triangle, uint32_t c) const {
        const uint32_t k = 9 * triangle + 3 * c;
        return {numbers[k], numbers[k + 1], numbers[k + 2]};
    }

    /// Relation of the segment from p to l to a triangle: 0 misses it, 1 crosses it, 2 too close to its border to
    /// decide.
    CISTULA_HD int meets(const Span<double>& numbers, uint32_t triangle, const Vec3<double>& p, const Vec3<double>& l,
                         double doubt) const {
        const Vec3<double> a = corner(numbers, triangle, 0);
        const Vec3<double> b = corner(numbers, triangle, 1);
        const Vec3<double> c = corner(numbers, triangle, 2);
        const Vec3<double> normal = normalized(cross(b - a, c - a));
        const double from = dot(normal, p - a);
        const double to = dot(normal, l - a);
        if (magnitude(from) <= doubt || magnitude(to) <= doubt) return 2;
        if ((from > 0) == (to > 0)) return 0;
        const Vec3<double> x = p + (l - p) * (from / (from - to));
        const double aside = doubt * (1 + length(l - p) / magnitude(from - to));
        double least_in = 1e300;
        for (uint32_t e = 0; e < 3; ++e) {
            const Vec3<double> first = corner(numbers, triangle, e);
            const Vec3<double> edge = corner(numbers, triangle, (e + 1) % 3) - first;
            least_in = min_or_second(least_in, dot(cross(edge, x - first), normal) / length(edge));
        }
        return least_in > aside ? 1 : least_in < -aside ? 0 : 2;
    }

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = draw.below(lights);
        const Vec3<double> at(setup.scene.lights[light].position);
        const Vec3<double> somewhere = in_ball(draw) * (1.9 * double(setup.extent()));
        const double nearer = draw.one_in(2) ? 1 : two_to<double>(-draw.between(0, 8));
        const Vec3<Real> origin(at + (somewhere - at) * nearer);
        const uint32_t k = 9 * triangles + 2 * light;
        const uint64_t holding = uint64_t(setup.numbers[k]) | uint64_t(setup.numbers[k + 1]) << 30;
        const double doubt = setup.units(64);  // as for HalfSpaces
        int between = 0;
        for (uint32_t t = 0; t < triangles; ++t) {
            if (holding >> t & 1u) continue;
            const int met = meets(setup.numbers, t, Vec3<double>(origin), at, doubt);
            if (met == 2) return;
            between += met;
        }
        const Vec3<Real> found = intersector.template transmittance<All>(shadow_ray(setup, origin, light));
        tally.witness(between != 0);
        tally.expect(found == through_faces<Real>(between, glass));
    }
};

/// The tree over lights that are seen compared with a plain loop.
struct VisibleLightTree {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t aim = draw.below(setup.scene.visible_lights.size);
        const VisibleLight<Real>& light = setup.scene.visible_lights[aim];
        const Vec3<double> from = in_ball(draw);
        const Vec3<double> aside = on_sphere(draw);
        const int graze = draw.between(0, 3);  // the middle, the rim, half of it, anywhere
        const double share = graze == 0 ? 0 : graze == 1 ? 1 : graze == 2 ? 0.5 : 40 * draw.unit<double>();
        const Vec3<Real> origin(draw.one_in(8) ? Vec3<double>(light.center) : from * (1.9 * double(setup.extent())));
        const Vec3<Real> target(Vec3<double>(light.center) + aside * (share * double(light.radius)));
        const Ray<Real> ray = ray_from(origin, normalized(target - origin));
        if (!is_finite(ray)) return;
        const Real limit = draw.one_in(2) ? RealTraits<Real>::infinity : Real(4) * draw.unit<Real>();
        const VisibleLightHit<Real> found = closest_visible_light(setup.scene, ray, limit);
        VisibleLightHit<Real> expected;
        expected.t = limit;
        for (uint32_t k = 0; k < setup.scene.visible_lights.size; ++k)
            intersect_visible_light(setup.scene, k, ray, expected);
        tally.witness(expected.light != no_light);
        tally.expect(found.t == expected.t && found.light == expected.light);
    }
};

}  // namespace cistula::verify::shadows
