// Brewster's angle: light polarized in the plane of incidence is not reflected; reflected and refracted ray are
// perpendicular.
#pragma once

#include "apps/render_verify/refraction/fresnel.h"

namespace cistula::verify::refraction {

/// Appends a record whose direction is at Brewster's angle, tan = n, rounded; the expected share is that of the exact
/// angle.
inline void brewster_record(Draw& draw, std::vector<double>& numbers) {
    const double from = 1 + draw.unit<double>(), to = from * (1.0625 + 1.5 * draw.unit<double>());
    const Vec3<double> normal = axis_normal(draw);
    const Quad n = Quad(to) / Quad(from), cosine = 1 / root(1 + n * n);
    const size_t first = numbers.size();
    // The tangent along an axis as well: the other components are zeros, and stay so.
    Vec3<double> tangent(0.0);
    for (int k = 0; k < 3; ++k)
        if (normal[k] != 0) tangent[(k + 1 + draw.between(0, 1)) % 3] = draw.sign();
    add_records(double(n * cosine) * tangent - double(cosine) * normal, normal, from, to, numbers);
    const Quad amplitude = (n * n - 1) / (n * n + 1), share = amplitude * amplitude / 2;
    for (const size_t at : {first + record_reflectance, first + record_size + record_reflectance}) {
        numbers[at] = double(share);
        numbers[at + 1] = double(share - Quad(double(share)));
    }
}

/// Reflectance at Brewster's angle, ((n^2 - 1)/(n^2 + 1))^2 / 2. The amplitude perpendicular to the plane has the
/// derivative 2 D / (g h^2) by c, so its square changes by the share 4 c / g = 4 / n^2 of c's change; the other
/// amplitude's square has derivative 0 there. c is rounded by at most u, which is at most one ulp of the share: 4 ulps
/// for n >= 1, and one rounding.
struct BrewsterShare {
    static constexpr const char* name = "refraction/brewster/share";
    static constexpr const char* exact = "half of ((n^2 - 1)/(n^2 + 1))^2: none of the light in the plane";
    static constexpr Bound bound = at_most(4 + rounded_once, "ulps");
    static constexpr bool own_traversal = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Refraction<Real> found = refracted(record.direction(), record.normal(), record.from(), record.to());
        tally.expect(!found.total);
        tally.measure(record.reflectance_off(found.reflectance));
    }
    static void plan(Plan& plan) { plan_records<BrewsterShare>(plan, 4, 100000, 4000, brewster_record); }
};

/// Perpendicularity of the reflected and the refracted ray. The angle between them changes by 1 + c / g = 1 + 1 / n^2
/// <= 2 times that of incidence, which is off by at most u: 2 u. The reflected ray is rounded by its last factor, u;
/// the other by 2 u (any-angle). 5 u.
struct BrewsterAngle {
    static constexpr const char* name = "refraction/brewster/right-angle";
    static constexpr const char* exact = "mirrored and refracted ray at right angles";
    static constexpr Bound bound = at_most(5, "u");
    static constexpr bool own_traversal = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Vec3<Real> direction = record.direction(), normal = record.normal();
        const Refraction<Real> found = refracted(direction, normal, record.from(), record.to());
        tally.expect(!found.total);
        if (found.total) return;
        const Vec3<Real> mirrored = reflected(direction, normal);
        // Two components at most are not zero: the difference of two equal products, its sign and digits kept.
        double across = 0;
        for (int k = 0; k < 3; ++k) {
            const int j = k == 2 ? 0 : k + 1;
            if (mirrored[k] != Real(0) && mirrored[j] != Real(0))
                across = difference_of_products(double(mirrored[k]), double(found.direction[k]), -double(mirrored[j]),
                                                double(found.direction[j]));
        }
        tally.measure(magnitude(across) / double(RealTraits<Real>::unit));
    }
    static void plan(Plan& plan) { plan_records<BrewsterAngle>(plan, 5, 100000, 4000, brewster_record); }
};

}  // namespace cistula::verify::refraction
