// The interface between two media: the shares of the reflected and the transmitted ray, and the latter's direction.
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/model/effects.h"
#include "cistula/model/scene_view.h"
#include "cistula/shading/smooth.h"

namespace cistula {

template <class Real, class Filter = Vec3<Real>>
struct InterfaceSplit {
    Real reflection;     // share of the reflected ray
    Filter filter;       // share of the transmitted ray
    MaskOf<Real> bends;  // whether the transmitted ray takes the direction `through`; else it goes straight on
    Vec3<Real> through;
    MaskOf<Real> total = false;  // whether all that would bend is reflected
};

/// Index of refraction at a point: that of the transparent solid of highest priority that contains it, or 1. (In lanes:
/// lane_surface.h.)
template <class Scene, class Media>
CISTULA_INLINE double index_of(const Scene& scene, const Media& media) {
    const uint32_t solid = media.medium(scene);
    return solid == no_solid ? 1.0 : scene.materials[scene.solids[solid].material].index;
}

/// Sets the index beyond the face of an opaque body to that of its own material, where `active` holds: no ray goes on
/// there, but the exact terms say how much is mirrored. (In lanes: lane_surface.h.)
template <class Scene, class Real>
CISTULA_INLINE void take_opaque_index(const Scene&, const Material<Real>& m, bool active, double& beyond) {
    if (active && m.transparency == Transparency::opaque) beyond = m.index;
}

/// Splits light at an interface. Total internal reflection moves the transmitted share to the reflected ray. With
/// `fresnel`, kr + kt is split by the exact dielectric terms; nothing is reflected between equal indices. A sheet has
/// no medium behind it, so it does not bend rays and uses kr and kt unchanged. `face`: the geometric normal, where
/// `normal` is that of a smooth mesh: what would stay on the viewer's side of the face is reflected, too.
template <class Real, class E, class Surfacing, class Media, class Scene>
CISTULA_INLINE InterfaceSplit<Real, Throughput<Real, E>> split_at(const Scene& scene, const Surfacing& m,
                                                                  const Vec3<Real>& direction, const Vec3<Real>& normal,
                                                                  const Media& before, const Media& beyond,
                                                                  const MaskOf<Real>& sheet, const Vec3<Real>& face,
                                                                  [[maybe_unused]] const MaskOf<Real>& smooth) {
    using Filter = Throughput<Real, E>;
    InterfaceSplit<Real, Filter> split{m.reflection, throughput_as<Filter>(m.filter), false, direction};
    if constexpr (E::has(effect_refraction)) {
        MaskOf<Real> fresnel = false;
        const WideOf<Real> from = index_of(scene, before);
        WideOf<Real> to = index_of(scene, beyond);
        if constexpr (E::has(effect_fresnel)) {
            fresnel = (m.fresnel != 0) & !sheet;
            take_opaque_index(scene, m, fresnel, to);
        }
        const Real both = m.reflection + m.transmission;
        const MaskOf<Real> equal = narrowed<Real>(from == to);
        assign_where(fresnel & equal, split.reflection, Real(0));
        assign_where(fresnel & equal, split.filter, throughput_as<Filter>(m.tint) * both);
        split.bends = (!equal) & ((m.transmission > Real(0)) | fresnel);
        if (any(split.bends)) {
            const Refraction<Real> refraction = refracted<Real>(direction, normal, from, to);
            assign_where(split.bends, split.through, refraction.direction);
            MaskOf<Real> stays = refraction.total;
            if constexpr (meets_smooth<E, Media>)
                if (any(smooth & !stays))
                    stays = stays | (smooth & !(dot(refraction.direction, face) <= Real(-least_lift<ScalarOf<Real>>)));
            split.total = split.bends & stays;
            const MaskOf<Real> part = split.bends & (!stays) & fresnel;
            assign_where(split.total, split.reflection, both);
            assign_where(split.total, split.filter, Filter(Real(0)));
            assign_where(part, split.reflection, both * refraction.reflectance);
            assign_where(part, split.filter,
                         throughput_as<Filter>(m.tint) * (both * (Real(1) - refraction.reflectance)));
        }
    }
    return split;
}

}  // namespace cistula
