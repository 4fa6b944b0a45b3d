// Directions with zeros of either sign and with subnormal components.
#pragma once

#include "apps/render_verify/geometry/upright_solids.h"

namespace cistula::verify::geometry {

/// Whether two rays, which differ in the signs of zeros only, have the same crossings to the bit.
template <class Real, class Intersector>
CISTULA_HD inline bool same_crossings(const Intersector& intersector, Ray<Real> a, Ray<Real> b) {
    for (uint32_t i = 0; i < 64; ++i) {
        const Hit<Real> at = intersector.closest(a), other = intersector.closest(b);
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
    static constexpr const char* name = "geometry/signed-zeros";
    static constexpr const char* exact = "-0 in origin or direction gives the bits of +0";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) { plan_upright<SignedZeros>(plan, plan.rays(1'000'000, 4000)); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> target = setup.point(draw.below(setup.points.size));
        Ray<Real> ray = ray_from(Vec3<Real>(on_sphere(draw) * (1.9 * double(setup.extent()))), Vec3<Real>(Real(0)));
        ray.direction = normalized(target - ray.origin);
        const int axis = draw.between(0, 2), other = draw.between(0, 2);
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

struct Subnormals {
    static constexpr const char* name = "geometry/subnormal-directions";
    static constexpr const char* exact =
        "components down to the least subnormal: as many ways in as out, one each inside";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_upright<Subnormals>(plan, plan.rays(1'000'000, 4000)); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        constexpr int lowest = 1 - parity::Layout<Real>::bias - parity::Layout<Real>::digits;
        const int axis = draw.between(0, 2);
        Ray<Real> ray = ray_from(setup.point(draw.below(setup.points.size)), Vec3<Real>(Real(0)));
        for (int k = 0; k < 3; ++k) {
            if (draw.one_in(4)) ray.origin[k] = draw.centered(setup.extent());
            const Real tiny = parity::two_to<Real>(
                draw.between(lowest, draw.one_in(2) ? lowest + parity::Layout<Real>::digits : -60));
            ray.direction[k] = draw.one_in(2) ? tiny : -tiny;
        }
        ray.direction[axis] = Real(draw.sign());
        ray.origin[axis] = Real(-1.25) * setup.extent() * ray.direction[axis];
        const Crossings found = cross_all(intersector, ray);
        const double margin = 1e-4;
        const Vec3<double> from(ray.origin), way(ray.direction);
        const bool through = chord(setup.numbers, margin, from, way) > margin;
        const bool past = chord(setup.numbers, -margin, from, way) < 0;
        tally.witness(through);
        tally.expect(found.balanced() && (!through || found.are(1, 1)) && (!past || found.are(0, 0)));
    }
};

}  // namespace cistula::verify::geometry
