// Transmittance in lanes: losses are integers of 64 bits, two registers where numbers are float.
#pragma once

#include "cistula/lanes/convex_lanes.h"
#include "cistula/lanes/lane_contact.h"
#include "cistula/lanes/lane_transmittance.h"
#include "cistula/shading/shadow.h"

namespace cistula {

/// 2^-loss: from the scene's table where it has all of them.
template <class Real, int n>
CISTULA_INLINE Lanes<Real, n> transmittance_of(const LaneScene<Real>& scene, const Lanes<int64_t, n>& loss) {
    using Result = Lanes<Real, n>;
    MaskOf<Result> known = narrowed<Result>(loss == Lanes<int64_t, n>(int64_t(0)));
    Result share(Real(1));
    if (all(known)) return share;
    for (const CachedTransmittance<Real>& entry : scene.cached_transmittances) {
        const MaskOf<Result> is = narrowed<Result>(loss == Lanes<int64_t, n>(int64_t(entry.loss)));
        assign_where(is, share, Result(entry.transmittance));
        known |= is;
        if (all(known)) return share;
    }
    return uncached_transmittance<Real>(loss);
}

/// Adds the absorption of a mesh that a lane enters (sign 1) or leaves (sign -1) at t (ShadowSum::absorb_rest).
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE void absorb_in_lane(const Scene& scene, const Solid& solid, const ShadowRay<Real, Media>& shadow,
                                   int lane, ScalarOf<Real> t, int sign, ShadowSum<E, Real>& sum) {
    ShadowSum<E> one;
    one.absorb_rest(scene.materials[solid.material], shadow.distance[lane], t, sign, scene.extent);
    for (int c = 0; c < one.channels; ++c) sum.path[c * LaneTraits<Real>::lanes + lane].sum += one.path[c].sum;
}

/// Adds the absorption of the crossings of a triangle at t, where `active` holds, if it belongs to a mesh.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE void absorb_crossings(const Scene& scene, const Solid& solid, const ShadowRay<Real, Media>& shadow,
                                     const Real& t, const MaskOf<Real>& enters, const MaskOf<Real>& active,
                                     ShadowSum<E, Real>& sum) {
    if (solid.kind != SolidKind::mesh) return;
    const uint32_t entering = enters.bits();
    for_each_lane(active, [&](int lane) {
        absorb_in_lane(scene, solid, shadow, lane, t[lane], (entering >> lane & 1u) != 0 ? 1 : -1, sum);
    });
}

/// Adds the absorption of the meshes that contain the rays' origins.
template <class E, class Real, class Media, class Scene>
CISTULA_NOINLINE void shadow_start(const Scene& scene, const ShadowRay<Real, Media>& shadow, const MaskOf<Real>& active,
                                   ShadowSum<E, Real>& sum) {
    for_each_lane(active, [&](int lane) {
        shadow.ray.media.of(lane).for_each([&](uint32_t solid, int) {
            if (!scene.meshes.has(solid)) return;
            absorb_in_lane(scene, scene.solids[solid], shadow, lane, ScalarOf<Real>(0), 1, sum);
        });
    });
}

/// Adds the absorption inside meshes to the losses of a channel.
template <class E, class Real, class Scene>
CISTULA_INLINE void add_path_losses(const Scene& scene, const ShadowSum<E, Real>& sum, int channel,
                                    LossOf<Real>& loss) {
    if (!scene.meshes.any) return;
    constexpr int lanes = LaneTraits<Real>::lanes;
    for (int lane = 0; lane < lanes; ++lane)
        if (const PathSum& path = sum.path[channel * lanes + lane]; path.sum != 0)
            loss.set(lane, int64_t(min_or_second(saturating_add(uint64_t(loss[lane]), path.loss()), loss_of_all)));
}

/// Where rays start whose light lies on faces of a convex solid: inside all of them, or outside one.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE void light_sides(const Scene& scene, uint32_t index, const ShadowRay<Real, Media>& shadow,
                                const MaskOf<Real>& active, MaskOf<Real>& inside, MaskOf<Real>& outside) {
    inside = outside = false;
    if constexpr (E::has(effect_lights_on_faces)) {
        if (shadow.light->incident_count == 0) return;
        uint32_t in = 0;
        uint32_t out = 0;
        for_each_lane(active, [&](int lane) {
            const LightSide side = light_on_convex(scene, *shadow.light, index, lane_of(shadow.ray.origin, lane));
            in |= uint32_t(side == LightSide::inside) << lane;
            out |= uint32_t(side == LightSide::outside) << lane;
        });
        inside = MaskOf<Real>::of_bits(in);
        outside = MaskOf<Real>::of_bits(out);
    }
}

/// Adds what a convex solid takes from the light of rays that start inside it, and of others that may enter it. `left`:
/// faces by which rays do not leave it.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE void shadow_solid(const Scene& scene, uint32_t index, const Solid& solid,
                                 const ShadowRay<Real, Media>& shadow, const IndexOf<Real>& left,
                                 const MaskOf<Real>& inside, const MaskOf<Real>& others, ShadowSum<E, Real>& sum) {
    const Ray<Real, Media>& ray = shadow.ray;
    MaskOf<Real> lit_inside, lit_outside;
    light_sides<E>(scene, index, shadow, inside | others, lit_inside, lit_outside);
    const MaskOf<Real> on_face = lit_inside | lit_outside;
    const Material<ScalarOf<Real>>& material = scene.materials[solid.material];
    const auto crossing =
        any(inside) ? convex_lanes::cross<Real, convex_lanes::inside>(scene, solid, ray.origin, ray.direction, left)
                    : convex_lanes::cross<Real, 0>(scene, solid, ray.origin, ray.direction, left);
    const Real leave = select(on_face, shadow.distance, max_or_second(crossing.leave, Real(0)));
    if (any(inside)) add_exit<Real, E>(inside, material, leave, shadow.distance, sum);
    const Real enter = max_or_second(crossing.enter, Real(0));
    const MaskOf<Real> meets = is_met(crossing, scene.extent) & (enter < shadow.distance);
    const MaskOf<Real> enters = others & !lit_outside & (lit_inside | meets);
    if (any(enters)) add_entry<Real, E>(enters, material, enter, leave, shadow.distance, sum);
}

/// Adds what a convex solid takes from the light of rays that start on a shared plane where it has a face.
template <class E, class Real, class Media, class Scene>
CISTULA_NOINLINE void shadow_beside(const Scene& scene, uint32_t index, const Solid& solid,
                                    const ShadowRay<Real, Media>& shadow, const MaskOf<Real>& active,
                                    ShadowSum<E, Real>& sum) {
    MaskOf<Real> lit_inside, lit_outside;
    light_sides<E>(scene, index, shadow, active, lit_inside, lit_outside);
    const LaneEntries<Real> entries = entries_beside(scene, index, shadow.ray, active & !lit_outside);
    const Real enter = max_or_second(entries.enter, Real(0));
    const MaskOf<Real> enters = entries.found & (enter < shadow.distance);
    const Real leave = select(lit_inside, shadow.distance, min_or_second(entries.leave, shadow.distance));
    if (any(enters)) add_entry<Real, E>(enters, scene.materials[solid.material], enter, leave, shadow.distance, sum);
}

/// Lines that may cross faces that rays pass unseen are followed one by one.
template <class E, class T, int n, class Intersector>
CISTULA_NOINLINE Lanes<T, n> gain_of_unseen_faces(const LaneScene<T>& scene, const Intersector&,
                                                  const ShadowRay<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& shadow,
                                                  const MaskOf<Lanes<T, n>>& active) {
    Lanes<T, n> gain(T(1));
    for_each_lane(active, [&](int lane) {
        const ShadowRay<T> one{lane_of<InteriorList>(shadow.ray, lane), shadow.distance[lane], shadow.light};
        gain.set(lane, gain_of_unseen_faces<E>(static_cast<const SceneView<T>&>(scene), SingleIntersector<T>{scene},
                                               one, true));
    });
    return gain;
}

}  // namespace cistula
