// Phong's local light at a point (1975), one light at a time, so that lights may come in any order.
#pragma once

#include "cistula/model/effects.h"
#include "cistula/model/scene_view.h"
#include "cistula/numerics/elementary.h"

namespace cistula {

CISTULA_NOINLINE inline double fractional_power(double base, double exponent) {
    return elementary::pow(base, exponent);
}

/// The highlight max(0, cosine)^n.
template <class Real>
CISTULA_INLINE Real highlight(const Material<Real>& material, Real cosine) {
    if (!(cosine > Real(0))) return material.integer_exponent == 0 ? Real(1) : Real(0);
    const Real base = min_or_second(cosine, Real(1));
    if (material.integer_exponent >= 0) return elementary::power_by_squaring(base, material.integer_exponent);
    return Real(fractional_power(double(base), double(material.exponent)));
}

/// R.V: the cosine between the mirrored light direction and the direction to the viewer.
template <class Real>
CISTULA_INLINE Real mirror_cosine(const Vec3<Real>& normal, const Vec3<Real>& to_light, const Vec3<Real>& to_viewer,
                                  Real n_l) {
    return Real(2) * n_l * dot(normal, to_viewer) - dot(to_light, to_viewer);
}

/// What a light adds at unit transmittance, without the local share: I a(r) (C kd N.L + ks S (R.V)^n). n_l = N.L > 0;
/// `shine` = (R.V)^n.
template <class Real, class E, class Surfacing>
CISTULA_INLINE Vec3<Real> phong(const Surfacing& material, const Vec3<Real>& color, const Light<ScalarOf<Real>>& light,
                                Real n_l, Real shine, Real distance) {
    Vec3<Real> result(Real(0));
    if constexpr (E::has(effect_diffuse)) result += color * (material.diffuse * n_l);
    if constexpr (E::has(effect_specular)) result += material.specular * shine;
    result *= spread<Real>(light.intensity);
    if constexpr (E::has(effect_light_falloff)) {
        if (light.clamp_distance > 0) {
            const Real r = max_or_second(distance, Real(light.clamp_distance));
            result *= Real(1) / (r * r);
        }
    }
    return result;
}

template <class Real, class E, class Surfacing>
CISTULA_INLINE Vec3<Real> phong(const Surfacing& material, const Vec3<Real>& color, const Light<ScalarOf<Real>>& light,
                                const Vec3<Real>& normal, const Vec3<Real>& to_light, const Vec3<Real>& to_viewer,
                                Real n_l, Real distance) {
    Real shine = Real(0);
    if constexpr (E::has(effect_specular)) shine = highlight(material, mirror_cosine(normal, to_light, to_viewer, n_l));
    return phong<Real, E>(material, color, light, n_l, shine, distance);
}

}  // namespace cistula
