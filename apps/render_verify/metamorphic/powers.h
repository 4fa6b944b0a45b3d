// Powers of cosines: by squaring for integers up to 1,024, by logarithm for all else.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/crossings.h"
#include "apps/render_verify/scenes.h"
#include "cistula/numerics/double_double.h"
#include "cistula/shading/phong.h"

namespace cistula::verify::metamorphic {

/// x^n in double-double, for n > 0: each of the n - 1 products that it amounts to is off by 2^-101 relative at most
/// (5 times 2^-106 and more), so that 8,192 are off by 2^-88. No result that is looked at is below 2^-900.
CISTULA_HD inline DoubleDouble power_pair(double x, int n) {
    DoubleDouble base(x), result(1);
    for (;; base = base * base) {
        if (n & 1) result = result * base;
        n >>= 1;
        if (n == 0) return result;
    }
}

/// Size of an ulp of Real at `value` > 0; for subnormal values that of the smallest normal number.
template <class Real>
CISTULA_HD double ulp_at(double value) {
    const double least = double(RealTraits<Real>::least_normal);
    const double normal = value < least ? least : value;
    const uint64_t exponent = bits_as<uint64_t>(normal) >> 52;
    return elementary::scaled(2 * double(RealTraits<Real>::unit), int(exponent) - 1023);
}

template <class Real>
CISTULA_HD double ulps_off(Real found, const DoubleDouble& exact) {
    const DoubleDouble off = DoubleDouble(double(found)) - exact;
    return magnitude(off.high + off.low) / ulp_at<Real>(exact.high);
}

template <class Case>
void plan_powers(Plan& plan) {
    SceneDescription scene = empty_scene();
    add_object(scene, solid_object(PlatonicSolid::cube));
    plan.add("cos^n", scene, Case{}, {}, plan.rays(20'000'000, 300'000));
}

/// A random cosine: any, near 1, or a quotient of two small numbers.
template <class Real>
CISTULA_HD Real drawn_cosine(Draw& draw) {
    const Real any = Real(1) - draw.unit<Real>();
    if (draw.one_in(3)) return any;
    if (draw.one_in(2)) return Real(1) - draw.unit<Real>() * Real(0x1p-8);
    return Real(draw.between(1, 16)) / Real(16);
}

struct IntegerPowers {
    static constexpr const char* name = "metamorphic/powers/by-squaring";
    static constexpr const char* exact = "cos^n for n to 1,024; powers of 1/2, 0.5^200 among them, exactly";
    // x^(2^j) has the relative error of 2^j - 1 roundings, the product of those in n that of n - 1 in all, each u at
    // most: (n - 1) u, so under n - 1 ulps. What underflows on the way is off by half the least number once more for
    // each of up to 10 products; it is a factor below 1 of what follows. Second-order terms: n^2 u / 2, 0.03 ulps in
    // float.
    static constexpr Bound bound = at_most(1, "n ulps");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_powers<IntegerPowers>(plan); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        if (i <= 1024) {  // every power of 1/2, of 1 and of 0
            const int n = int(i);
            const Real expected = n <= 1074 ? Real(elementary::scaled(1, -n)) : Real(0);
            tally.expect(elementary::power_by_squaring(Real(0.5), n) == expected);
            tally.expect(elementary::power_by_squaring(Real(1), n) == Real(1));
            tally.expect(elementary::power_by_squaring(Real(0), n) == (n == 0 ? Real(1) : Real(0)));
            return;
        }
        const int n = draw.one_in(4) ? 1 << draw.between(0, 10) : draw.between(1, 1024);
        const Real x = drawn_cosine<Real>(draw);
        const DoubleDouble reference = power_pair(double(x), n);
        if (reference.high < 0x1p-900) return;
        tally.measure(ulps_off(elementary::power_by_squaring(x, n), reference) / n);
    }
};

struct RealPowers {
    static constexpr const char* name = "metamorphic/powers/by-logarithm";
    static constexpr const char* exact = "x^y for y in eighths to 1,024, against roots and products in double-double";
    // What elementary.h states for results that are normal, as all are here; computed in double for either type.
    static constexpr Bound bound = at_most(elementary::pow_worst_ulp, "ulps");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_powers<RealPowers>(plan); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        // y = n / 8: x = r^8 exactly for a root r of few bits, r^n then is x^y.
        const bool by_root = draw.one_in(2);
        const int n = draw.between(1, by_root ? 8192 : 1024);
        const double root = double(draw.between(33, 63)) / 64;
        const double x = by_root ? double(power_pair(root, 8)) : double(drawn_cosine<Real>(draw));
        const DoubleDouble reference = power_pair(by_root ? root : x, n);
        if (reference.high < 0x1p-900) return;
        tally.measure(ulps_off(elementary::pow(x, by_root ? n / 8.0 : double(n)), reference));
        tally.expect(elementary::pow(0.5, double(i % 1024)) == elementary::scaled(1, -int(i % 1024)));
    }
};

/// The highlight itself, for integer and other exponents, and cosines that rounding moved outside [0, 1].
struct Highlights {
    static constexpr const char* name = "metamorphic/powers/highlight";
    static constexpr const char* exact = "at most 1; 0 on the far side; never more at a larger angle or exponent";
    static constexpr Bound bound = no_failures("highlights");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_powers<Highlights>(plan); }

    template <class Real>
    CISTULA_HD static Material<Real> material_of(Real exponent) {
        Material<Real> material{};
        material.exponent = exponent;
        const bool integer = exponent <= Real(1024) && floor_of(exponent) == exponent;
        material.integer_exponent = integer ? int32_t(exponent) : -1;
        return material;
    }
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Real u = RealTraits<Real>::unit, n = Real(draw.between(1, 1024)), x = drawn_cosine<Real>(draw);
        const Material<Real> whole = material_of(n), more = material_of(n + Real(0.25)), none = material_of(Real(0));
        tally.expect(highlight(whole, Real(1)) == Real(1) && highlight(more, Real(1)) == Real(1));
        tally.expect(highlight(whole, Real(1) + 8 * u) == Real(1) && highlight(more, Real(1) + 8 * u) == Real(1));
        tally.expect(highlight(whole, -x) == Real(0) && highlight(more, -x) == Real(0) &&
                     highlight(whole, Real(0)) == Real(0));
        tally.expect(highlight(none, x) == Real(1) && highlight(none, -x) == Real(1));
        const Real there = highlight(whole, x);
        tally.expect(there >= Real(0) && there <= x);
        // Products of larger factors are never less once rounded; so are powers of an exponent that is not an integer,
        // within their error, which the rounding to float may hide or not: a step of 1/64 is more than both.
        const Real further = x * Real(63.0 / 64);
        tally.expect(highlight(whole, further) <= there && highlight(more, further) <= highlight(more, x));
        // A quarter more of exponent: log(1/x)/4 less, against errors of n u.
        if (x < Real(0.875) && there > RealTraits<Real>::least_normal) tally.expect(highlight(more, x) <= there);
    }
};

}  // namespace cistula::verify::metamorphic
