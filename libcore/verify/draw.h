// Random inputs of cases and of the function parity check, generated from (index, seed) alone, so that host and device
// generate the same ones. They use only integers, exact conversions and IEEE operations. Each draw is its own
// statement: C++ leaves the order of operands and arguments open, and compilers differ in it.
#pragma once

#include "cistula/numerics/vec.h"

namespace cistula::verify {

template <class Real>
struct Layout;
template <>
struct Layout<float> {
    using Bits = uint32_t;
    static constexpr int digits = 23;
    static constexpr int bias = 127;
};
template <>
struct Layout<double> {
    using Bits = uint64_t;
    static constexpr int digits = 52;
    static constexpr int bias = 1023;
};

template <class Real>
inline constexpr Real no_number = std::numeric_limits<Real>::quiet_NaN();

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014).
CISTULA_HD inline uint64_t mixed(uint64_t z) {
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/// The number `steps` representable numbers away in magnitude; beyond infinity come NaNs.
template <class Real>
CISTULA_HD inline Real stepped(Real x, int steps) {
    using Bits = typename Layout<Real>::Bits;
    return bits_as<Real>(Bits(bits_as<Bits>(x) + Bits(int64_t(steps))));
}

/// 2^exponent, including subnormal results.
template <class Real>
CISTULA_HD inline Real two_to(int exponent) {
    using Bits = typename Layout<Real>::Bits;
    constexpr int digits = Layout<Real>::digits;
    constexpr int bias = Layout<Real>::bias;
    if (exponent > -bias) return bits_as<Real>(Bits(exponent + bias) << digits);
    return bits_as<Real>(Bits(1) << (exponent + bias + digits - 1));
}

class Draw {
  public:
    CISTULA_HD Draw(uint64_t index, uint64_t seed) : state_(mixed(index + 1) ^ mixed(~seed)) {}

    CISTULA_HD uint64_t bits() { return mixed(state_ += 0x9e3779b97f4a7c15u); }
    CISTULA_HD uint32_t below(uint32_t n) { return uint32_t((bits() >> 32) * n >> 32); }
    CISTULA_HD bool one_in(uint32_t n) { return below(n) == 0; }
    CISTULA_HD int between(int low, int high) { return low + int(below(uint32_t(high - low + 1))); }
    CISTULA_HD int sign() { return one_in(2) ? -1 : 1; }
    /// An integer of random size: random bits shifted right by low to high.
    CISTULA_HD uint64_t shifted(int low, int high) {
        const int shift = between(low, high);
        return bits() >> shift;
    }
    /// A number within `steps` representable numbers of x. NaN is returned unchanged, since its bits differ between
    /// machines.
    template <class Real>
    CISTULA_HD Real near(Real x, int steps) {
        const Real beside = stepped(x, between(-steps, steps));
        return x == x ? beside : x;
    }

    /// A number in [0, 1).
    template <class Real>
    CISTULA_HD Real unit() {
        constexpr int digits = Layout<Real>::digits;
        return Real(int64_t(bits() >> (63 - digits))) * two_to<Real>(-digits - 1);
    }
    /// A number in [-half, half).
    template <class Real>
    CISTULA_HD Real centered(Real half) {
        return (unit<Real>() - Real(0.5)) * (half + half);
    }
    /// A number with random digits, random sign and an exponent in [low, high].
    template <class Real>
    CISTULA_HD Real scaled(int low, int high) {
        using Bits = typename Layout<Real>::Bits;
        const Bits random = Bits(bits());
        const Bits keep = (Bits(1) << Layout<Real>::digits) - 1;
        const Bits sign = Bits(1) << (8 * sizeof(Real) - 1);
        const Real power = two_to<Real>(between(low, high));
        return bits_as<Real>(Bits((random & (keep | sign)) | bits_as<Bits>(power)));
    }
    /// A random bit pattern: most exponents are extreme; infinities, NaNs and subnormals occur.
    template <class Real>
    CISTULA_HD Real pattern() {
        return bits_as<Real>(typename Layout<Real>::Bits(bits()));
    }

    /// A value at which functions change their behavior.
    template <class Real>
    CISTULA_HD Real special() {
        using Bits = typename Layout<Real>::Bits;
        constexpr Real least = RealTraits<Real>::least_normal;
        const Real size[] = {0,
                             bits_as<Real>(Bits(1)),
                             stepped(least, -1),
                             least,
                             RealTraits<Real>::unit,
                             Real(0.5),
                             1,
                             2,
                             Real(1) / Real(3),
                             RealTraits<Real>::largest,
                             RealTraits<Real>::infinity,
                             no_number<Real>};
        const Real value = size[below(sizeof(size) / sizeof(size[0]))];
        return one_in(2) ? -value : value;
    }
    /// A power of two or a neighbor of one, with any exponent, subnormal ones included.
    template <class Real>
    CISTULA_HD Real power() {
        const Real value = two_to<Real>(between(1 - Layout<Real>::bias - Layout<Real>::digits, Layout<Real>::bias));
        const Real beside = near(value, 2);
        return one_in(2) ? -beside : beside;
    }
    /// A number of any kind: ordinary numbers, random bits, powers of two, special values.
    template <class Real>
    CISTULA_HD Real any() {
        const uint32_t kind = below(5);
        if (kind == 0) return scaled<Real>(-4, 4);
        if (kind == 1) return scaled<Real>(-60, 60);
        if (kind == 2) return pattern<Real>();
        if (kind == 3) return power<Real>();
        return special<Real>();
    }
    /// A finite number of magnitude up to about 2^60, often a simple one.
    template <class Real>
    CISTULA_HD Real tame() {
        const uint32_t kind = below(4);
        if (kind == 0) return Real(between(-8, 8)) * Real(0.125);
        if (kind == 1) return scaled<Real>(-60, 60);
        if (kind == 2) return near(Real(between(1, 4)), 2);
        return centered<Real>(Real(2));
    }

    template <class Real>
    CISTULA_HD Vec3<Real> in_cube(Real half) {
        Vec3<Real> v;
        for (int k = 0; k < 3; ++k) v[k] = centered<Real>(half);
        return v;
    }
    template <class Real>
    CISTULA_HD Vec3<Real> any_vector() {
        Vec3<Real> v;
        const bool tame_ones = !one_in(4);
        for (int k = 0; k < 3; ++k) v[k] = tame_ones ? tame<Real>() : any<Real>();
        return v;
    }
    /// A unit vector to within rounding; at times along an axis, in an axis plane, or slightly off one.
    template <class Real>
    CISTULA_HD Vec3<Real> direction() {
        Vec3<Real> v = in_cube<Real>(Real(1));
        const int axis = between(0, 2);
        switch (below(8)) {
            case 0:
                v = Vec3<Real>(Real(0)), v[axis] = Real(sign());
                return v;
            case 1:
                v[axis] = one_in(2) ? Real(-0.0) : Real(0);
                break;
            case 2:
                v[axis] = scaled<Real>(1 - Layout<Real>::bias, -20);
                break;
            case 3:
                v[axis] = v[(axis + 1) % 3];
                break;
            default:
                break;
        }
        const Real square = dot(v, v);
        if (square > Real(0x1p-20)) return v / square_root(square);
        v = Vec3<Real>(Real(0));
        v[axis] = Real(1);
        return v;
    }

  private:
    uint64_t state_;
};

}  // namespace cistula::verify
