// Vectors: GLM's types and its exact componentwise operations. Products, which round, are defined here.
#pragma once

#ifndef GLM_FORCE_PURE
#define GLM_FORCE_PURE
#endif
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <type_traits>

#include "cistula/numerics/real.h"

namespace cistula {

template <class Real>
using Vec2 = glm::vec<2, Real, glm::defaultp>;
template <class Real>
using Vec3 = glm::vec<3, Real, glm::defaultp>;

/// Dot product, symmetric in x and y: mirroring a scene or swapping its x and y axes changes no bit.
template <class Real>
CISTULA_INLINE Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
    return fused(a.z, b.z, a.x * b.x + a.y * b.y);
}

template <class Real>
CISTULA_INLINE Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

/// origin + t direction, each component rounded once.
template <class Real>
CISTULA_INLINE Vec3<Real> along(const Vec3<Real>& origin, Real t, const Vec3<Real>& direction) {
    return {fused(t, direction.x, origin.x), fused(t, direction.y, origin.y), fused(t, direction.z, origin.z)};
}

template <class Real>
CISTULA_INLINE Real length(const Vec3<Real>& a) {
    return square_root(dot(a, a));
}

/// a / |a|; the zero vector gives NaN.
template <class Real>
CISTULA_INLINE Vec3<Real> normalized(const Vec3<Real>& a) {
    return a / length(a);
}

/// 0 if all components are finite, else NaN: 0 times infinity or NaN is NaN, which the sum keeps.
template <class Real>
CISTULA_INLINE Real nothing_of(const Vec3<Real>& a) {
    return fused(a.x, Real(0), fused(a.y, Real(0), a.z * Real(0)));
}
template <class Real>
CISTULA_INLINE MaskOf<Real> is_finite(const Vec3<Real>& a) {
    return nothing_of(a) == Real(0);
}

/// A vector of a scene in the number type that traces it.
template <class Real>
CISTULA_INLINE Vec3<Real> spread(const Vec3<ScalarOf<Real>>& a) {
    return Vec3<Real>(a.x, a.y, a.z);
}

template <class Real>
CISTULA_INLINE Real channel(const Vec3<Real>& a, int c) {
    return a[c];
}
/// Component of a scalar that stands for three equal channels.
CISTULA_INLINE float channel(float a, int) {
    return a;
}
CISTULA_INLINE double channel(double a, int) {
    return a;
}
template <class To, class Real>
CISTULA_INLINE To throughput_as(const Vec3<Real>& a) {
    if constexpr (std::is_same_v<To, Real>)
        return a.x;
    else
        return a;
}
template <class Throughput>
CISTULA_INLINE auto total(const Throughput& a) {
    return channel(a, 0) + channel(a, 1) + channel(a, 2);
}

CISTULA_INLINE float largest_component(float a) {
    return a;
}
CISTULA_INLINE double largest_component(double a) {
    return a;
}
template <class Real>
CISTULA_INLINE Real largest_component(const Vec3<Real>& a) {
    return max_or_second(a.x, max_or_second(a.y, a.z));
}

}  // namespace cistula
