// Rays under flips of axes, and single steps of shading: cells of textures, powers of cosines.
#pragma once

#include "cistula/numerics/double_double.h"
#include "cistula/shading/phong.h"
#include "cistula/shading/surface.h"
#include "verify/setup.h"

namespace cistula::verify::metamorphic {

// ---- the eight flips of axes, with and without swapping x and y: rays and their images at symmetric scenes give equal
// hits

/// The image of a vector. Bit 3: swap x and y; bits 0 to 2: flip axes after that.
template <class Real>
CISTULA_HD Vec3<Real> mapped(const Vec3<Real>& p, uint32_t map) {
    const Vec3<Real> q = (map & 8u) != 0 ? Vec3<Real>(p.y, p.x, p.z) : p;
    return {(map & 1u) != 0 ? -q.x : q.x, (map & 2u) != 0 ? -q.y : q.y, (map & 4u) != 0 ? -q.z : q.z};
}

/// Crossings of a line with a solid: t and kind of the first ones, and their number.
template <class Real>
struct LineCrossings {
    static constexpr uint32_t most = 8;
    Real t[most];
    CrossingKind kind[most];
    uint32_t count = 0;

    template <class Tracer>
    CISTULA_HD LineCrossings(const Tracer& intersector, Ray<Real> ray) {
        ray.accept_both_sides();
        for (; count < most; ++count) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found()) return;
            t[count] = hit.t;
            kind[count] = key_kind(hit.key);
            ray.media.add(key_solid(hit.key), media_change(kind[count]));
            ray.after = {hit.t, hit.key};
        }
    }
    CISTULA_HD bool same(const LineCrossings& other, bool times) const {
        if (count != other.count) return false;
        for (uint32_t i = 0; i < count; ++i)
            if (kind[i] != other.kind[i] || (times && t[i] != other.t[i])) return false;
        return true;
    }
};

/// Rays at a solid about the origin, from outside and from inside, and at what they become. `maps`: 8, or 16 with the
/// swap. Targets are corners and points of edges, from inside as they are, from outside scattered: there an edge that
/// is met exactly at the silhouette is a hit or none by which side owns it.
struct Flips {
    bool times;
    uint32_t maps;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const bool from_inside = draw.one_in(2);
        Vec3<Real> target = setup.point(i % setup.points.size);
        const Vec3<double> start = from_inside ? in_ball(draw) * 0.4 : on_sphere(draw) * 1.9;
        const Vec3<Real> origin(start);
        if (!from_inside) target = target * draw.centered<Real>(Real(2));
        const Vec3<Real> way = target - origin;
        Ray<Real> ray = ray_from(origin, times || draw.one_in(2) ? normalized(way) : way);
        if (from_inside) ray.media.add(0, 1);
        const LineCrossings<Real> expected(intersector, ray);
        tally.witness(expected.count > 1);
        for (uint32_t map = 1; map < maps; ++map) {
            Ray<Real> turned = ray;
            turned.origin = mapped(ray.origin, map);
            turned.direction = mapped(ray.direction, map);
            tally.expect(LineCrossings<Real>(intersector, turned).same(expected, times));
        }
    }
};

// ---- textures at the borders of cells, and far from their origin

/// i modulo n, for integers.
CISTULA_HD inline uint32_t modulo(int64_t i, int64_t n) {
    const int64_t r = i % n;
    return uint32_t(r < 0 ? r + n : r);
}
/// The floor of x, for |x| up to 2^53.
CISTULA_HD inline int64_t whole_below(double x) {
    return int64_t(floor_of(x));
}

struct Texels {
    Span<Vec3<float>> texels;
};

/// Cells of a checkerboard, exact: they and the repeats are powers of two, so that no product is rounded.
struct CellBorders {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const int log_width = draw.between(0, 2);
        const int log_repeat = draw.between(-3, 3);
        Vec3<float> texels[16];
        for (int t = 0; t < 16; ++t) texels[t] = Vec3<float>(float(t));
        Texture texture{};
        texture.width = texture.height = 1u << log_width;
        texture.filter = TextureFilter::nearest;
        texture.repeat[0] = texture.repeat[1] = elementary::power_of_two(log_repeat);
        const Texels scene{{texels, 16}};
        const double factor = elementary::power_of_two(log_width + log_repeat);
        Vec2<Real> uv;
        int64_t cell[2];
        for (int axis = 0; axis < 2; ++axis) {
            const int bits = draw.between(0, 30);  // to 1.07e9 cells out
            const int64_t border = int64_t(draw.bits() >> (63 - bits)) - (int64_t(1) << bits);
            const Real at = Real(double(border) / factor);
            const Real least = RealTraits<Real>::least_normal;  // numbers by bits end at 0
            const Real beside = at == Real(0) ? (draw.one_in(2) ? least : -least) : draw.near(at, 1);
            uv[axis] = draw.one_in(4) ? at : beside;
            if (draw.one_in(8)) uv[axis] += draw.unit<Real>();
            cell[axis] = whole_below(double(uv[axis]) * factor);
        }
        const uint32_t expected = modulo(cell[1], texture.height) * texture.width + modulo(cell[0], texture.width);
        tally.expect(texture_at(scene, texture, uv) == Vec3<Real>(Real(expected)));
    }
};

/// Texels in rows of any length: near the origin, where floats represent all integers, and beyond.
struct RepeatedTexels {
    int64_t largest;  // |i| + n; 0: what the type holds exactly, up to 2^30

    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t n = draw.one_in(2) ? uint32_t(draw.between(1, 16)) : uint32_t(draw.between(1, 8192));
        const int64_t exact_to = sizeof(Real) == sizeof(float) ? int64_t(1) << 24 : int64_t(1) << 30;
        const int64_t most = (largest > 0 ? largest : exact_to) - n - 1;
        const int64_t range = most >> draw.between(0, 12);
        int64_t whole = int64_t(draw.bits() % uint64_t(2 * range + 1)) - range;
        if (draw.one_in(2)) whole = whole / n * n + draw.between(-1, 1);  // at the row's ends
        const Real x = Real(whole);
        tally.expect(repeated(x, n) == modulo(int64_t(x), n));
    }
};

/// A floor of half width `size` with a checkerboard of `cell`, seen from above at up to 45 degrees.
struct FarFloor {
    // In u M: the point under a ray is off by 8 by the rounding of its slope, height and their product, which all
    // corners share; by 5 by that of the corners against the ray; by 10 by weights, whose edge functions are good to 2
    // u relative and their sum to 3 more, over a floor of width 2; by 6 by the sum over the corners' uv; and corners
    // and uv have been rounded themselves, 1 each: 31. Each of them the worst.
    static constexpr double margin = 32;
    double size, cell;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        // At a border, a little beside it, or anywhere.
        double x[2], start[2];
        for (int axis = 0; axis < 2; ++axis) {
            x[axis] = draw.centered<double>(1.9) * size;
            if (!draw.one_in(4)) x[axis] = floor_of(x[axis] / cell) * cell;
            if (draw.one_in(2)) x[axis] += draw.centered<double>(4) * margin * double(RealTraits<Real>::unit) * size;
            start[axis] = draw.centered<double>(0.9) * extent;
        }
        const double height = (0.25 + draw.unit<double>()) * extent;
        const Vec3<Real> origin(Vec3<double>(start[0] + x[0] * setup.factor, start[1] + x[1] * setup.factor, height) *
                                0.5);
        const Vec3<Real> target(Vec3<double>(x[0], x[1], 0) * setup.factor);
        const Ray<Real> ray = ray_from(origin, normalized(target - origin));
        const Vec3<double> d(ray.direction);
        if (!(-d.z >= magnitude(d.x) && -d.z >= magnitude(d.y))) return;
        const Hit<Real> hit = intersector.closest(ray);
        int64_t low[2], high[2];
        for (int axis = 0; axis < 2; ++axis) {
            const DoubleDouble slope = DoubleDouble(d[axis]) / DoubleDouble(d.z);
            const DoubleDouble at = DoubleDouble(double(ray.origin[axis])) - slope * DoubleDouble(double(ray.origin.z));
            const double world = (at.high + at.low) / setup.factor;
            const double off = margin * double(RealTraits<Real>::unit) * size;
            if (magnitude(world) > size - off) return;
            low[axis] = whole_below((world - off) / cell);
            high[axis] = whole_below((world + off) / cell);
        }
        const bool sure = low[0] == high[0] && low[1] == high[1];
        tally.expect(hit.found());
        if (!hit.found() || !sure) return;
        const Surface<Real> surface = surface_at<Real, Effects<all_effects>>(setup.scene, ray, hit);
        tally.expect((surface.color.x > Real(0.5)) == (modulo(low[0] + low[1], 2) == 0));
        tally.witness(true);
    }
};

// ---- powers of cosines: by squaring for integers up to 1,024, by logarithm for all else

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

/// A random cosine: any, near 1, or a quotient of two small numbers.
template <class Real>
CISTULA_HD Real drawn_cosine(Draw& draw) {
    const Real any = Real(1) - draw.unit<Real>();
    if (draw.one_in(3)) return any;
    if (draw.one_in(2)) return Real(1) - draw.unit<Real>() * Real(0x1p-8);
    return Real(draw.between(1, 16)) / Real(16);
}

struct IntegerPowers {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
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
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
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
    template <class Real>
    CISTULA_HD static Material<Real> material_of(Real exponent) {
        Material<Real> material{};
        material.exponent = exponent;
        const bool integer = exponent <= Real(1024) && floor_of(exponent) == exponent;
        material.integer_exponent = integer ? int32_t(exponent) : -1;
        return material;
    }
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Real u = RealTraits<Real>::unit;
        const Real n = Real(draw.between(1, 1024));
        const Real x = drawn_cosine<Real>(draw);
        const Material<Real> whole = material_of(n);
        const Material<Real> more = material_of(n + Real(0.25));
        const Material<Real> none = material_of(Real(0));
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
