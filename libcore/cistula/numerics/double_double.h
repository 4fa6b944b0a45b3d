// Double-double arithmetic, the precision above double: a number is the sum of two doubles, about 104 bits (Dekker
// 1971; Joldes, Muller, Popescu 2017, algorithms 4, 6 (accurate sum), 12 and 18).
#pragma once

#include "cistula/numerics/real.h"

namespace cistula {

/// Double: double, or lanes of it.
template <class Double>
struct DoubleDoubleOf {
    Double high = 0.0;
    Double low = 0.0;

    constexpr DoubleDoubleOf() = default;
    CISTULA_INLINE constexpr explicit DoubleDoubleOf(Double a) : high(a) {}
    CISTULA_INLINE constexpr DoubleDoubleOf(Double a, Double b) : high(a), low(b) {}
    CISTULA_INLINE explicit operator Double() const { return high + low; }
};
using DoubleDouble = DoubleDoubleOf<double>;

/// a + b exactly, as a rounded sum and its error (Knuth).
template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> two_sum(Double a, Double b) {
    const Double s = a + b;
    const Double bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
}
/// a + b exactly, as a rounded sum and its error, where |a| >= |b| or a = 0 (Dekker).
template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> fast_two_sum(Double a, Double b) {
    const Double s = a + b;
    return {s, b - (s - a)};
}
CISTULA_INLINE DoubleDouble fast_two_sum(int a, double b) {
    return fast_two_sum(double(a), b);
}
/// a * b exactly.
template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> two_product(Double a, Double b) {
    const Double p = a * b;
    return {p, fused(a, b, -p)};
}

template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> operator-(const DoubleDoubleOf<Double>& a) {
    return {-a.high, -a.low};
}
template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> operator+(const DoubleDoubleOf<Double>& a, const DoubleDoubleOf<Double>& b) {
    const DoubleDoubleOf<Double> s = two_sum(a.high, b.high);
    const DoubleDoubleOf<Double> t = two_sum(a.low, b.low);
    const DoubleDoubleOf<Double> v = fast_two_sum(s.high, s.low + t.high);
    return fast_two_sum(v.high, t.low + v.low);
}
template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> operator-(const DoubleDoubleOf<Double>& a, const DoubleDoubleOf<Double>& b) {
    return a + -b;
}
template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> operator*(const DoubleDoubleOf<Double>& a, const DoubleDoubleOf<Double>& b) {
    const DoubleDoubleOf<Double> p = two_product(a.high, b.high);
    return fast_two_sum(p.high, fused(a.high, b.low, fused(a.low, b.high, p.low + a.low * b.low)));
}
template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> operator/(const DoubleDoubleOf<Double>& a, const DoubleDoubleOf<Double>& b) {
    const Double q = a.high / b.high;
    const DoubleDoubleOf<Double> r = a - b * DoubleDoubleOf<Double>(q);
    const Double q2 = r.high / b.high;
    const DoubleDoubleOf<Double> r2 = r - b * DoubleDoubleOf<Double>(q2);
    return fast_two_sum(q, q2) + DoubleDoubleOf<Double>(r2.high / b.high);
}
template <class Double>
CISTULA_INLINE MaskOf<Double> operator>(const DoubleDoubleOf<Double>& a, const DoubleDoubleOf<Double>& b) {
    return (a.high > b.high) | ((a.high == b.high) & (a.low > b.low));
}

template <class Double>
CISTULA_INLINE Double up_sqrt(const Double& a) {
    return square_root(a);
}
/// Square root of a, to about 2^-104 relative, for a > 0; 0 for any other a.
template <class Double>
CISTULA_INLINE DoubleDoubleOf<Double> up_sqrt(const DoubleDoubleOf<Double>& a) {
    const Double r = square_root(a.high);
    const MaskOf<Double> positive = r > Double(0.0);
    if (!any(positive)) return DoubleDoubleOf<Double>(Double(0.0));
    const DoubleDoubleOf<Double> rest = a - two_product(r, r);
    return select(positive, fast_two_sum(r, rest.high / (Double(2.0) * r)), DoubleDoubleOf<Double>(Double(0.0)));
}

}  // namespace cistula
