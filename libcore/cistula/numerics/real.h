// Traits of float and double, and operations whose library forms differ between the two.
#pragma once

#include "cistula/numerics/select.h"

namespace cistula {

template <class Double>
struct DoubleDoubleOf;

template <class Real>
struct RealTraits;

template <>
struct RealTraits<float> {
    using Up = double;                       // the next higher precision, for decisions such as total reflection
    static constexpr float unit = 0x1p-24f;  // unit roundoff u, half an ulp of 1
    static constexpr float least_normal = 0x1p-126f;
    static constexpr float largest = 0x1.fffffep127f;
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    static constexpr const char* name = "float";
};

template <>
struct RealTraits<double> {
    using Up = DoubleDoubleOf<double>;  // double_double.h
    static constexpr double unit = 0x1p-53;
    static constexpr double least_normal = 0x1p-1022;
    static constexpr double largest = 0x1.fffffffffffffp1023;
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr const char* name = "double";
};

/// Minimum, as a select: fmin and fmax treat NaN and signed zeros differently on different machines. If a is NaN the
/// result is b.
template <class T>
CISTULA_INLINE T min_or_second(T a, T b) {
    return a < b ? a : b;
}
template <class T>
CISTULA_INLINE T max_or_second(T a, T b) {
    return a > b ? a : b;
}
template <class T>
CISTULA_INLINE T clamped(T a, T low, T high) {
    return select(a > low, select(a < high, a, high), low);
}
template <class T>
CISTULA_INLINE T magnitude(T a) {
    return a < T(0) ? -a : a;
}
CISTULA_INLINE float magnitude(float a) {
    return fabsf(a);
}
CISTULA_INLINE double magnitude(double a) {
    return ::fabs(a);
}

/// False for NaN and both infinities.
template <class Real>
CISTULA_INLINE bool is_finite(Real a) {
    return magnitude(a) <= RealTraits<Real>::largest;
}

/// a * b - c * d to within 2 u relative (Kahan; Jeannerod, Louvet, Muller 2013): the sign is exact, and so is zero.
template <class Real>
CISTULA_INLINE Real difference_of_products(Real a, Real b, Real c, Real d) {
    const Real cd = c * d;
    const Real error = fused(-c, d, cd);
    return fused(a, b, -cd) + error;
}

}  // namespace cistula
