// Reversibility of light paths: a refracted direction, reversed and refracted back, is the original direction.
#pragma once

#include "apps/render_verify/refraction/fresnel.h"

namespace cistula::verify::refraction {

/// What rounding makes of a direction that is refracted and refracted back, in u, over the numbers that multiply it.
/// With s, c the sine and cosine of incidence and g = n times the cosine beyond: the first refraction is off by 2 u
/// across (any-angle), and what comes back by g / c times that, and 2 u of its own. A direction longer than 1 by e
/// turns by s |D| / (n^2 g) e, which comes back as s |D| / (n^2 c) e; the one in between by s |D| / c e. e is 3 u at
/// most. So 2 + 2 g/c + 3 s |D| / c (1 + 1/n^2) + 2.5 of length, at most 4.5 (1 + g/c + s |D| / c (1 + 1/n^2)).
struct Condition {
    double cosine, g, value;
};
CISTULA_HD inline Condition condition_of(const Vec3<double>& direction, const Vec3<double>& normal, double from,
                                         double to) {
    const double n = to / from, excess = (n - 1) * (n + 1), c = -dot(direction, normal);
    const double g2 = excess + c * c, g = g2 > 0 ? square_root(g2) : 0, s = square_root(max_or_second(1 - c * c, 0.0));
    return {c, g, 1 + g / c + s * magnitude(excess) / c * (1 + 1 / (n * n))};
}

struct Reversibility {
    static constexpr const char* name = "refraction/reversibility";
    static constexpr const char* exact = "refracted back, a ray returns on itself, at the same share";
    static constexpr Bound bound = at_most(4.5, "u x condition");
    static constexpr bool own_traversal = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double from = 1 + 1.5 * draw.unit<double>(), to = 1 + 1.5 * draw.unit<double>();
        const Vec3<Real> normal(on_sphere(draw));
        const Vec3<Real> direction(on_sphere(draw));
        const Condition condition = condition_of(Vec3<double>(direction), Vec3<double>(normal), from, to);
        // Grazing rays come back at the critical angle, where rounding may turn them round.
        if (condition.cosine < 0x1p-5 || condition.g < 0x1p-5) return;
        const Refraction<Real> there = refracted(direction, normal, from, to);
        tally.expect(!there.total);
        if (there.total) return;
        const Refraction<Real> back = refracted(-there.direction, -normal, to, from);
        tally.expect(!back.total);
        if (back.total) return;
        const Vec3<double> off = Vec3<double>(back.direction) + Vec3<double>(direction);
        tally.measure(length(off) / (double(RealTraits<Real>::unit) * condition.value));
        tally.witness(true);
    }
    static constexpr bool needs_witness = true;

    static void plan(Plan& plan) {
        plan.add("any angle", empty_scene(), Reversibility(), {}, plan.rays(1000000, 20000));
    }
};

}  // namespace cistula::verify::refraction
