// Double-double arithmetic, the precision above double: a number is the sum of two doubles, about 104 bits (Dekker
// 1971; Joldes, Muller, Popescu 2017, algorithms 4, 6 (accurate sum), 12 and 18).
#pragma once

#include "cistula/numerics/real.h"

namespace cistula {

struct DoubleDouble {
    double high = 0, low = 0;

    constexpr DoubleDouble() = default;
    CISTULA_INLINE constexpr explicit DoubleDouble(double a) : high(a) {}
    CISTULA_INLINE constexpr DoubleDouble(double a, double b) : high(a), low(b) {}
    CISTULA_INLINE explicit operator double() const { return high + low; }
};

/// a + b exactly, as a rounded sum and its error (Knuth).
CISTULA_INLINE DoubleDouble two_sum(double a, double b) {
    const double s = a + b, bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
}
/// a + b exactly, as a rounded sum and its error, where |a| >= |b| or a = 0 (Dekker).
CISTULA_INLINE DoubleDouble fast_two_sum(double a, double b) {
    const double s = a + b;
    return {s, b - (s - a)};
}
/// a * b exactly.
CISTULA_INLINE DoubleDouble two_product(double a, double b) {
    const double p = a * b;
    return {p, fused(a, b, -p)};
}

CISTULA_INLINE DoubleDouble operator-(const DoubleDouble& a) {
    return {-a.high, -a.low};
}
CISTULA_INLINE DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = two_sum(a.high, b.high), t = two_sum(a.low, b.low);
    const DoubleDouble v = fast_two_sum(s.high, s.low + t.high);
    return fast_two_sum(v.high, t.low + v.low);
}
CISTULA_INLINE DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
    return a + -b;
}
CISTULA_INLINE DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble p = two_product(a.high, b.high);
    return fast_two_sum(p.high, fused(a.high, b.low, fused(a.low, b.high, p.low + a.low * b.low)));
}
CISTULA_INLINE DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double q = a.high / b.high;
    const DoubleDouble r = a - b * DoubleDouble(q);
    const double q2 = r.high / b.high;
    const DoubleDouble r2 = r - b * DoubleDouble(q2);
    return fast_two_sum(q, q2) + DoubleDouble(r2.high / b.high);
}
CISTULA_INLINE bool operator>(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high > b.high || (a.high == b.high && a.low > b.low);
}

CISTULA_INLINE double up_sqrt(double a) {
    return square_root(a);
}
/// Square root of a, to about 2^-104 relative, for a > 0; 0 for any other a.
CISTULA_INLINE DoubleDouble up_sqrt(const DoubleDouble& a) {
    const double r = square_root(a.high);
    if (!(r > 0)) return DoubleDouble(0);
    const DoubleDouble rest = a - two_product(r, r);
    return fast_two_sum(r, rest.high / (2 * r));
}

}  // namespace cistula
