// Where a ray meets a face between two media: which shares go on, and which way.
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/model/effects.h"
#include "cistula/model/scene_view.h"
#include "cistula/shading/snell.h"

namespace cistula {

template <class Real, class Filter = Vec3<Real>>
struct Shares {
    Real reflection;  // of the mirrored ray
    Filter filter;    // of the ray that goes through
    bool bends;       // whether that one takes `through`; otherwise it goes straight on
    Vec3<Real> through;
};

/// Index of refraction of the medium around a point: that of the solid of highest priority, or 1.
template <class Scene, class Media>
CISTULA_INLINE double index_of(const Scene& scene, const Media& media) {
    const uint32_t solid = media.medium();
    return solid == no_solid ? 1.0 : scene.materials[scene.solids[solid].material].index;
}

/// Total internal reflection sends the transmitted share into the mirrored ray; `fresnel` splits kr + kt by the exact
/// dielectric terms, of which nothing is reflected between equal indices. A sheet has no other side to bend into: kr
/// and kt stand as they are.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE Shares<Real, Share<Real, E>> split_at(const Scene& scene, const Material<Real>& m,
                                                     const Vec3<Real>& direction, const Vec3<Real>& normal,
                                                     const Media& before, const Media& beyond, bool sheet) {
    using Filter = Share<Real, E>;
    Shares<Real, Filter> shares{m.reflection, share_as<Filter>(m.filter), false, direction};
    if constexpr (E::has(effect_refraction)) {
        const bool fresnel = E::has(effect_fresnel) && m.fresnel != 0 && !sheet;
        const Real both = m.reflection + m.transmission;
        const double from = index_of(scene, before), to = index_of(scene, beyond);
        if (from == to) {
            if (fresnel) shares.reflection = Real(0), shares.filter = share_as<Filter>(m.tint) * both;
        } else if (m.transmission > Real(0) || fresnel) {
            const Refraction<Real> refraction = refracted<Real>(direction, normal, from, to);
            shares.bends = true;
            shares.through = refraction.direction;
            if (refraction.total) {
                shares.reflection = both;
                shares.filter = Filter(Real(0));
            } else if (fresnel) {
                shares.reflection = both * refraction.reflectance;
                shares.filter = share_as<Filter>(m.tint) * (both * (Real(1) - refraction.reflectance));
            }
        }
    }
    return shares;
}

}  // namespace cistula
