// Sine, cosine, tangent and atan2 in double with the same bits on every machine, for every finite argument (see
// elementary.h).
#pragma once

#include "cistula/numerics/elementary.h"

namespace cistula::elementary {

inline constexpr double sin_worst_ulp = 0.75;
inline constexpr double cos_worst_ulp = 0.75;
inline constexpr double tan_worst_ulp = 0.90;
inline constexpr double atan2_worst_ulp = 0.51;

/// An angle in radians minus `quadrant` quarter turns: high + low in [-pi / 4, pi / 4], to within a few ulps. quadrant
/// is 0 to 3.
struct ReducedAngle {
    double high, low;
    int quadrant;
};

/// Payne and Hanek's argument reduction, for x in [2^30, infinity): multiplies x by the 192 bits of 2 / pi that matter
/// modulo 4.
CISTULA_HD inline ReducedAngle reduce_large_angle(double x) {
    constexpr uint32_t two_over_pi[] = {
        0,          0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab,
        0xdebbc561, 0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5,
        0x2ebb4484, 0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff,
        0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d, 0x7527bac7,
        0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab};
    constexpr double pi_half_hi = 0x1.921fb54442d18p+0;
    constexpr double pi_half_lo = 0x1.1a62633145c07p-54;
    const uint64_t bits = bits_as<uint64_t>(x);
    const uint64_t mantissa = (bits & 0xfffffffffffffu) | 0x10000000000000u;
    const int exponent = static_cast<int>(bits >> 52) - 1075;  // x = mantissa * 2^exponent
    const int first = exponent - 2 + 32;                       // the table starts with 32 zeros
    const uint64_t factor[2] = {mantissa & 0xffffffffu, mantissa >> 32};
    // product = x / (2 pi) modulo 1, most significant word first.
    uint32_t product[6] = {};
    for (int f = 0; f < 2; ++f) {
        uint64_t carry = 0;
        for (int i = 5; i - f >= 0; --i) {
            const int word = first / 32 + i;
            const int shift = first % 32;
            const uint64_t pair = static_cast<uint64_t>(two_over_pi[word]) << 32 | two_over_pi[word + 1];
            carry += factor[f] * (pair << shift >> 32) + product[i - f];
            product[i - f] = static_cast<uint32_t>(carry);
            carry >>= 32;
        }
    }
    const int quadrant = static_cast<int>((product[0] >> 29) + 1) >> 1;
    // The rest, in quarter turns, is the two's complement fraction left of the top two bits.
    double sum = 0;
    double tail = 0;
    double weight = 0x1p-32;
    for (int i = 0; i < 6; ++i, weight *= 0x1p-32) {
        const uint32_t word = product[i] << 2 | (i < 5 ? product[i + 1] >> 30 : 0);
        const double value = (i == 0 ? static_cast<double>(static_cast<int32_t>(word)) : word) * weight;
        const double total = sum + value;
        const double part = total - sum;
        tail += (sum - (total - part)) + (value - part);
        sum = total;
    }
    const DoubleDouble turns = fast_two_sum(sum, tail);
    const DoubleDouble angle = two_product(turns.high, pi_half_hi);
    const DoubleDouble r = fast_two_sum(angle.high, angle.low + fused(turns.high, pi_half_lo, turns.low * pi_half_hi));
    return {r.high, r.low, quadrant & 3};
}

/// Cody and Waite's reduction with pi / 2 in three doubles, the first step of which is exact. For x in [0, 2^30).
CISTULA_HD inline ReducedAngle reduce_small_angle(double x) {
    constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
    constexpr double part0 = 0x1.921fb54442d18p+0;
    constexpr double part1 = 0x1.1a62633145c07p-54;
    constexpr double part2 = -0x1.f1976b7ed8fbcp-110;
    const double n = floor_of(fused(x, two_over_pi, 0.5));
    const double first = fused(-n, part0, x);
    const DoubleDouble second = two_product(n, part1);
    const double hi = first - second.high;
    const double back = hi - first;
    const double error = (first - (hi - back)) - (second.high + back);
    const DoubleDouble r = fast_two_sum(hi, error - fused(n, part2, second.low));
    return {r.high, r.low, static_cast<int>(n) & 3};
}

/// Argument reduction for finite x. The result for -x is exactly the negated result for x, so sin and tan are exactly
/// odd and cos is exactly even.
CISTULA_HD inline ReducedAngle reduced_angle(double x) {
    const double size = magnitude(x);
    const ReducedAngle r = size < 0x1p30 ? reduce_small_angle(size) : reduce_large_angle(size);
    return x < 0 ? ReducedAngle{-r.high, -r.low, -r.quadrant & 3} : r;
}

/// sin(hi + lo) for a reduced angle, in double-double.
CISTULA_HD inline DoubleDouble sin_reduced(double hi, double lo) {
    constexpr double series[] = {-0x1.5555555555555p-3, 0x1.1111111111110p-7,   -0x1.a01a01a019937p-13,
                                 0x1.71de3a54607a5p-19, -0x1.ae64541295cdfp-26, 0x1.61217ee5cca1bp-33,
                                 -0x1.ab17bdcbd3414p-41};
    const double square = hi * hi;
    return fast_two_sum(hi, fused(square * hi, polynomial(square, series), fused(-0.5 * square, lo, lo)));
}

/// cos(hi + lo) for a reduced angle, in double-double.
CISTULA_HD inline DoubleDouble cos_reduced(double hi, double lo) {
    constexpr double series[] = {0x1.5555555555555p-5,   -0x1.6c16c16c16c16p-10, 0x1.a01a01a019d0ap-16,
                                 -0x1.27e4fb7712ca2p-22, 0x1.1eed8deb82809p-29,  -0x1.9394b9eb4d56dp-37,
                                 0x1.ab78473be59d7p-45};
    const DoubleDouble square = two_product(hi, hi);
    const DoubleDouble start = fast_two_sum(1, -0.5 * square.high);
    const double small = fused(-hi, lo, -0.5 * square.low);
    return fast_two_sum(start.high,
                        start.low + fused(square.high * square.high, polynomial(square.high, series), small));
}

/// Sine of an angle in radians. Infinite and NaN arguments give NaN; sin(-0) = -0.
CISTULA_HD inline double sin(double x) {
    if (!is_finite(x)) return not_a_number;
    if (magnitude(x) < 0x1p-27) return x;
    const ReducedAngle r = reduced_angle(x);
    const DoubleDouble value = r.quadrant & 1 ? cos_reduced(r.high, r.low) : sin_reduced(r.high, r.low);
    return r.quadrant & 2 ? -value.high : value.high;
}
CISTULA_HD inline double cos(double x) {
    if (!is_finite(x)) return not_a_number;
    const ReducedAngle r = reduced_angle(x);
    const DoubleDouble value = r.quadrant & 1 ? sin_reduced(r.high, r.low) : cos_reduced(r.high, r.low);
    return (r.quadrant + 1) & 2 ? -value.high : value.high;
}
CISTULA_HD inline double tan(double x) {
    if (!is_finite(x)) return not_a_number;
    if (magnitude(x) < 0x1p-27) return x;
    const ReducedAngle r = reduced_angle(x);
    const DoubleDouble s = sin_reduced(r.high, r.low);
    const DoubleDouble c = cos_reduced(r.high, r.low);
    const DoubleDouble above = r.quadrant & 1 ? c : s;
    const DoubleDouble below = r.quadrant & 1 ? DoubleDouble{-s.high, -s.low} : c;
    const double quotient = above.high / below.high;
    return quotient + (fused(-quotient, below.high, above.high) + (above.low - quotient * below.low)) / below.high;
}

/// atan(y / x) for 0 <= y <= x, x > 0. With y / x = k / 16 + r it is atan(k / 16) + atan(z), z = (y - x k / 16) / (x +
/// y k / 16), of which Taylor's series to z^11 is exact to 2^-62: |z| <= 1 / 32.
CISTULA_HD inline DoubleDouble atan_of_quotient(double y, double x) {
    constexpr DoubleDouble of_sixteenths[] = {{0, 0},
                                              {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
                                              {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                              {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
                                              {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                              {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
                                              {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                              {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
                                              {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                              {0x1.0657e94db30dp-1, -0x1.d5b495f6349e6p-56},
                                              {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                              {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
                                              {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                              {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
                                              {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                              {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
                                              {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
    constexpr double series[] = {-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11};
    const double k = floor_of(fused(y / x, 16, 0.5));
    const double c = k * 0x1p-4;
    const DoubleDouble product = two_product(c, x);  // exact: c has five bits
    const double over = y - product.high;
    const double below = fused(c, y, x);
    const double lost = fused(c, y, x - below);
    const double above = over - product.low;
    const double z = above / below;
    const double rest = (fused(-z, below, above) + ((over - above) - product.low) - z * lost) / below;
    const double square = z * z;
    const double tail = fused(z * square, polynomial(square, series), rest);
    const DoubleDouble start = of_sixteenths[static_cast<int>(k)];
    const double sum = start.high + z;
    const double back = sum - start.high;
    return {sum, (start.high - (sum - back)) + (z - back) + (start.low + tail)};
}

/// The angle of (x, y) from the x axis in [-pi, pi], for finite numbers; 0 at the origin. Exactly odd in y; zeros have
/// no sign.
CISTULA_HD inline double atan2(double y, double x) {
    constexpr double pi_half_hi = 0x1.921fb54442d18p+0;
    constexpr double pi_half_lo = 0x1.1a62633145c07p-54;
    const double ax = magnitude(x);
    const double ay = magnitude(y);
    if (ax == 0 && ay == 0) return 0;
    const bool steep = ay > ax;
    DoubleDouble angle = atan_of_quotient(steep ? ax : ay, steep ? ay : ax);
    for (int turns = 1; turns <= 2; ++turns) {  // the angle from the y axis, then from the negative x axis
        if (!(turns == 1 ? steep : x < 0)) continue;
        const double whole = turns * pi_half_hi;
        const double sum = whole - angle.high;
        const double back = whole - sum;
        angle = {sum, (whole - (sum + back)) + (back - angle.high) + (turns * pi_half_lo - angle.low)};
    }
    const double value = angle.high + angle.low;
    return y < 0 ? -value : value;
}

}  // namespace cistula::elementary
