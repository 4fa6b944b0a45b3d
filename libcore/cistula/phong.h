// The local light at a point (Phong 1975), one light at a time, so that lights may come in any order.
#pragma once

#include "cistula/effects.h"
#include "cistula/elementary.h"
#include "cistula/scene_view.h"

namespace cistula {

CISTULA_SELDOM inline double fractional_power(double base, double exponent) {
    return elementary::pow(base, exponent);
}

/// max(0, cosine)^n.
template <class Real>
CISTULA_INLINE Real highlight(const Material<Real>& material, Real cosine) {
    if (!(cosine > Real(0))) return material.integer_exponent == 0 ? Real(1) : Real(0);
    const Real base = least(cosine, Real(1));
    if (material.integer_exponent >= 0) return elementary::power_by_squaring(base, material.integer_exponent);
    return Real(fractional_power(double(base), double(material.exponent)));
}

/// What a light of unit transmittance adds, before the local share: I a(r) (C kd N.L + ks S (R.V)^n). n_l = N.L > 0.
template <class Real, class E>
CISTULA_INLINE Vec3<Real> phong(const Material<Real>& material, const Vec3<Real>& color, const Light<Real>& light,
                                const Vec3<Real>& normal, const Vec3<Real>& to_light, const Vec3<Real>& to_viewer,
                                Real n_l, Real distance) {
    Vec3<Real> result(Real(0));
    if constexpr (E::has(effect_diffuse)) result += color * (material.diffuse * n_l);
    if constexpr (E::has(effect_specular)) {
        const Real r_v = Real(2) * n_l * dot(normal, to_viewer) - dot(to_light, to_viewer);
        result += material.specular * highlight(material, r_v);
    }
    result *= light.intensity;
    if constexpr (E::has(effect_light_falloff)) {
        if (light.clamp_distance > Real(0)) {
            const Real r = greatest(distance, light.clamp_distance);
            result *= Real(1) / (r * r);
        }
    }
    return result;
}

}  // namespace cistula
