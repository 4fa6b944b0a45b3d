// Snell's law and the dielectric Fresnel terms, computed in the next higher precision: float in double, double in
// double-double. At equal indices the direction is returned unchanged and the reflectance is exactly 0.
#pragma once

#include "cistula/numerics/double_double.h"
#include "cistula/numerics/vec.h"

namespace cistula {

template <class Real>
struct Refraction {
    MaskOf<Real> total;    // total internal reflection: direction is not set
    Vec3<Real> direction;  // unit to within a few u
    Real reflectance;      // Fresnel's, unpolarized, in [0, 1]; 1 if total
};

/// A vector after one Newton step toward unit length, which suffices for an error of a few u.
template <class Real>
CISTULA_INLINE Vec3<Real> renormalized(const Vec3<Real>& a) {
    return a * fused(Real(-0.5), dot(a, a), Real(1.5));
}

/// The mirrored direction d - 2 (d.N) N.
template <class Real>
CISTULA_INLINE Vec3<Real> reflected(const Vec3<Real>& direction, const Vec3<Real>& normal) {
    return renormalized(along(direction, Real(-2) * dot(direction, normal), normal));
}

/// Refraction at an interface. The normal is on the incoming side; the indices are at least the smallest one allowed in
/// a scene. With n = index_to / index_from, c = -d.N, D = (n - 1)(n + 1): g^2 = D + c^2, T = (d - (D / (g + c)) N) / n,
/// and Fresnel's (a^2 / 2)(1 + b^2) with a = (g - c) / (g + c), b = (c (g + c) - 1) / (c (g - c) + 1) (Cook and
/// Torrance 1982).
template <class Real>
CISTULA_HD inline Refraction<Real> refracted(const Vec3<Real>& direction, const Vec3<Real>& normal,
                                             WideOf<Real> index_from, WideOf<Real> index_to) {
    using Up = typename RealTraits<Real>::Up;
    const Up dx(direction.x), dy(direction.y), dz(direction.z), nx(normal.x), ny(normal.y), nz(normal.z);
    const Up n = Up(index_to) / Up(index_from);
    Up c = -(dx * nx + dy * ny + dz * nz);
    c = select(c > Up(0.0), c, Up(0.0));
    const Up excess = (n - Up(1.0)) * (n + Up(1.0));
    const Up g2 = excess + c * c;
    Refraction<Real> result;
    result.total = !narrowed<Real>(g2 > Up(0.0));
    result.reflectance = Real(1);
    if (all(result.total)) return result;
    const Up g = up_sqrt(g2);
    const Up h = g + c;
    const Up bend = excess / h;
    result.direction =
        renormalized(Vec3<Real>(Real((dx - bend * nx) / n), Real((dy - bend * ny) / n), Real((dz - bend * nz) / n)));
    const Up a = bend / h;
    const Up b = (c * h - Up(1.0)) / (c * bend + Up(1.0));
    assign_where(!result.total, result.reflectance,
                 clamped(Real(a * a * (Up(1.0) + b * b) * Up(0.5)), Real(0), Real(1)));
    return result;
}

}  // namespace cistula
