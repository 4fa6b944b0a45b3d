// Elementary functions that are the same bits on every machine: libm differs between systems and from one glibc to the
// next. Double only, from + - * / fma floor and integers. trigonometry.h has the rest. Worst errors below are measured
// against __float128 and asserted by tests/numerics/elementary.cpp. Coefficients: Chebyshev fits made with 300-bit
// arithmetic.
#pragma once

#include "cistula/numerics/double_double.h"

namespace cistula::elementary {

/// Worst errors, in units in the last place of the exact result. Subnormal results are rounded twice: within 0.85.
inline constexpr double exp2_worst_ulp = 0.70;
inline constexpr double log2_worst_ulp = 0.51;
inline constexpr double pow_worst_ulp = 0.70;

inline constexpr double infinity = RealTraits<double>::infinity;
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class Double, int n>
CISTULA_INLINE Double polynomial(Double x, const double (&coefficients)[n]) {
    Double sum = coefficients[n - 1];
#if CISTULA_ON_DEVICE
#pragma unroll
#endif
    for (int i = n - 2; i >= 0; --i) sum = fused(sum, x, Double(coefficients[i]));
    return sum;
}

/// 2^k for k in [-1022, 1023].
CISTULA_INLINE double power_of_two(int k) {
    return bits_as<double>(static_cast<uint64_t>(k + 1023) << 52);
}

/// x * 2^k for k in [-2044, 2046], rounded once for |x| in [0.5, 2).
CISTULA_INLINE double scaled(double x, int k) {
    const int half = k / 2;
    return x * power_of_two(half) * power_of_two(k - half);
}

/// 2^(r + tail) for |r| <= 0.5 and a tail of at most about an ulp of 0.5; the result lies in [0.7, 1.42]. Exact at 0.
template <class Double>
CISTULA_HD inline Double exp2_reduced(Double r, std::type_identity_t<Double> tail) {
    const Double ln2_hi = 0x1.62e42fefa39efp-1;
    const Double ln2_lo = 0x1.abc9e3b39803fp-56;
    constexpr double quadratic[] = {0x1.ebfbdff82c58fp-3,  0x1.c6b08d704a0c2p-5,  0x1.3b2ab6fba4e78p-7,
                                    0x1.5d87fe78a5276p-10, 0x1.430912f86bf52p-13, 0x1.ffcbfc670dcd4p-17,
                                    0x1.62c022401b97dp-20, 0x1.b524fae627834p-24, 0x1.e4cf1cd08d4b8p-28,
                                    0x1.e9d3fe3952179p-32, 0x1.c48f769ad2c46p-36};
    const DoubleDoubleOf<Double> linear = two_product(r, ln2_hi);
    const DoubleDoubleOf<Double> sum = fast_two_sum(Double(1), linear.high);
    const Double small = fused(r, ln2_lo, linear.low) + ln2_hi * tail * sum.high;
    return sum.high + (sum.low + fused(r * r, polynomial(r, quadratic), small));
}

/// 2^x. Exact at integers, also where the result is subnormal. Overflow gives infinity, underflow 0, NaN gives NaN.
CISTULA_HD inline double exp2(double x) {
    if (!(x < 1024)) return x >= 1024 ? infinity : x;
    if (x <= -1075) return 0;
    const double k = floor_of(x + 0.5);
    return scaled(exp2_reduced(x - k, 0), static_cast<int>(k));
}

/// c + z p, to about 2^-104, for |z.high p.high| <= |c.high|.
CISTULA_INLINE DoubleDouble multiply_add(DoubleDouble c, DoubleDouble z, DoubleDouble p) {
    const DoubleDouble product = two_product(z.high, p.high);
    const DoubleDouble sum = fast_two_sum(c.high, product.high);
    return {sum.high, sum.low + ((product.low + fused(z.high, p.low, z.low * p.high)) + c.low)};
}

/// log2(x) to 2^-67 relative, for x finite and above 0 (subnormal too). Exact, with lo = 0, at powers of two.
CISTULA_HD inline DoubleDouble log2_pair(double x) {
    constexpr DoubleDouble c0 = {0x1.71547652b82fep+1, 0x1.777d0ffda0d24p-55};  // 2 / ln 2
    constexpr DoubleDouble c1 = {0x1.ec709dc3a03fdp-1, 0x1.d27f05548af0cp-55};  // 2 / (3 ln 2)
    constexpr DoubleDouble c2 = {0x1.2776c50ef9bfep-1, 0x1.e4b29ccc535d4p-55};  // 2 / (5 ln 2)
    constexpr double rest[] = {0x1.a61762a7aded9p-2, 0x1.484b13d7c0366p-2, 0x1.0c9a84991f4cbp-2, 0x1.c68f56d2c1d44p-3,
                               0x1.89f38d470bc21p-3, 0x1.5ba4f4f402905p-3, 0x1.356fb1477262cp-3, 0x1.39b2c60cccb37p-3};
    const bool subnormal = x < 0x1p-1022;
    const uint64_t bits = bits_as<uint64_t>(subnormal ? x * 0x1p54 : x);
    int exponent = static_cast<int>(bits >> 52) - (subnormal ? 1023 + 54 : 1023);
    double m = bits_as<double>((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
    if (m > 0x1.6a09e667f3bcdp+0) {
        m *= 0.5;
        ++exponent;
    }
    // log2(m) = s (c0 + c1 s^2 + c2 s^4 + ...), s = (m - 1) / (m + 1).
    const double f = m - 1;
    const DoubleDouble d = fast_two_sum(2, f);
    const double reciprocal = 1 / d.high;
    const double s = f * reciprocal;
    const double s_lo = (fused(-s, d.high, f) - s * d.low) * reciprocal;
    DoubleDouble square = two_product(s, s);
    square.low = fused(2 * s, s_lo, square.low);
    const DoubleDouble series = multiply_add(
        c0, square, multiply_add(c1, square, multiply_add(c2, square, {polynomial(square.high, rest), 0})));
    const DoubleDouble y = two_product(s, series.high);
    const DoubleDouble sum = fast_two_sum(exponent, y.high);
    return fast_two_sum(sum.high, sum.low + (y.low + fused(s, series.low, s_lo * series.high)));
}

/// log2(x). Exact at powers of two; +-0 gives -infinity, below 0 and NaN give NaN, infinity gives infinity.
CISTULA_HD inline double log2(double x) {
    if (!(x > 0 && x < infinity)) return x == 0 ? -infinity : (x > 0 ? x : not_a_number);
    return log2_pair(x).high;
}

/// x^y for x >= 0 (-0 counts as 0; below 0 gives NaN, for integers y too). pow(x, 0) = pow(1, y) = 1 even for NaN, as
/// in IEEE 754; otherwise NaN gives NaN. Results that doubles hold are found exactly, such as pow(x, 1).
CISTULA_HD inline double pow(double x, double y) {
    if (y == 0 || x == 1) return 1;
    if (!(x >= 0) || !(y == y)) return not_a_number;
    if (x == 0 || x == infinity) return (x == 0) == (y > 0) ? 0 : infinity;
    const DoubleDouble log = log2_pair(x);
    const double product = y * log.high;
    if (product >= 1025) return infinity;
    if (product <= -1080) return 0;
    const double k = floor_of(product + 0.5);
    const DoubleDouble r = fast_two_sum(product - k, fused(y, log.low, fused(y, log.high, -product)));
    return scaled(exp2_reduced(r.high, r.low), static_cast<int>(k));
}

/// x^n for n in [0, 1024] by repeated squaring from the lowest bit, so that host and device multiply in the same order.
/// x^0 = 1.
template <class Real>
CISTULA_INLINE Real power_by_squaring(Real x, int n) {
    Real result = 1;
    for (;;) {  // two bits a turn halve the number of branches
        const Real square = x * x;
        if (n & 1) result *= x;
        if (n & 2) result *= square;
        n >>= 2;
        if (n == 0) return result;
        x = square * square;
    }
}

/// The sRGB transfer function (IEC 61966-2-1) for coded values of any size; below 0 its linear part continues. NaN
/// gives NaN.
CISTULA_HD inline double srgb_to_linear(double coded) {
    return coded <= 0.04045 ? coded / 12.92 : pow((coded + 0.055) / 1.055, 2.4);
}
CISTULA_HD inline double linear_to_srgb(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace cistula::elementary
