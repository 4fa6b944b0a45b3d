// Transmittance toward a light as integer sums over the crossed faces, with the same result in any order
// (docs/rules.md, 5 and 6).
#pragma once

#include "cistula/geometry/convex.h"
#include "cistula/geometry/disk.h"
#include "cistula/numerics/transmittance.h"
#include "cistula/shading/interface.h"
#include "cistula/shading/surface_event.h"

namespace cistula {

/// A shadow ray, a straight segment to a light; refraction does not bend it. Of ray.after only disks know (start_near).
template <class Real, class Media = InteriorList>
struct ShadowRay {
    Ray<Real, Media> ray;
    Real distance;
    const Light<ScalarOf<Real>>* light;
};

/// The losses met so far on the way to a light, per channel or for all channels at once (Throughput). Lanes: the number
/// type of lanes, or any other.
template <class E = Effects<all_effects>, class Lanes = float>
struct ShadowSum {
    static constexpr int channels = std::is_same_v<Throughput<float, E>, float> ? 1 : 3;
    using Loss = LossOf<Lanes>;
    using Bits = IndexOf<Lanes>;
    Loss loss[channels] = {};
    PathSum path[channels * LaneTraits<Lanes>::lanes];  // absorption inside meshes, of each lane by itself
    Bits opaque = 0;                                    // bit c: channel c is blocked

    CISTULA_INLINE MaskOf<Lanes> is_blocked() const { return opaque == 7u; }

    /// Adds a face, where `active` holds.
    template <class Real>
    CISTULA_INLINE void cross(const Material<Real>& material, const MaskOf<Lanes>& active = true) {
        if constexpr (!E::has(effect_transparent_shadows)) {
            assign_where(active, opaque, Bits(7u));
        } else {
            assign_where(active, opaque, opaque | Bits(material.opaque));
            for (int c = 0; c < channels; ++c) add_loss(widened(active), material.filter_loss[c], loss[c]);
        }
    }

    /// Adds the absorption of a length >= 0 inside a convex solid.
    template <class Real>
    CISTULA_INLINE void absorb(const Material<ScalarOf<Real>>& material, Real length,
                               const MaskOf<Lanes>& active = true) {
        for (int c = 0; c < channels; ++c) {
            const double sigma = double(material.absorption[c]);
            if (!(sigma > 0)) continue;
            add_loss(widened(active), absorption_loss(WideOf<Lanes>(sigma) * WideOf<Lanes>(length)), loss[c]);
        }
    }

    /// Adds the absorption of a mesh entered (sign 1) or left (sign -1) at t on the way to a light at `distance`: the
    /// signed sum over all its crossings is the length inside. A light that is farther than the scene reaches, 4
    /// extents, is in no mesh, and lengths count up to there.
    template <class Real>
    CISTULA_INLINE void absorb_rest(const Material<Real>& material, Real distance, Real t, int sign, Real extent) {
        const Real farthest = 4 * extent;
        const Real remaining = min_or_second(distance, farthest) - t;
        for (int c = 0; c < channels; ++c)
            path[c].add(sign, double(material.absorption[c]), double(remaining), double(farthest));
    }

    template <class Real, class Scene>
    CISTULA_INLINE Throughput<Real, E> transmittance(const Scene& scene) const {
        Real arriving[channels];
        Loss known = 0;  // the last loss and its share: gray materials have the same one in all channels
        Real known_transmittance = 1;
        for (int c = 0; c < channels; ++c) {
            if constexpr (E::has(effect_transparent_shadows)) {
                Loss total = loss[c];
                if constexpr (E::has(effect_absorption) && in_lanes<Lanes>)
                    add_path_losses(scene, *this, c, total);
                else if constexpr (E::has(effect_absorption))
                    total = saturating_add(total, path[c].loss());
                if (any(total != known)) known = total, known_transmittance = transmittance_of(scene, total);
            }
            arriving[c] = select((opaque & (1u << c)) != 0u, Real(0), known_transmittance);
        }
        if constexpr (channels == 1)
            return arriving[0];
        else
            return {arriving[0], arriving[1], arriving[2]};
    }
};

/// The sum of rays of a number type.
template <class E, class Real>
using ShadowSumOf = std::conditional_t<in_lanes<Real>, ShadowSum<E, Real>, ShadowSum<E>>;

/// Where a shadow ray starts, if its light lies on faces of a solid.
enum class LightSide { none, inside, outside };  // on no face; inside all planes of such faces; outside one

/// Where a point lies relative to the faces of a convex solid that hold a light. `point` is by value: a reference would
/// force the ray into memory.
template <class Real, class Scene>
CISTULA_NOINLINE LightSide light_on_convex(const Scene& scene, const Light<Real>& light, uint32_t index,
                                           Vec3<Real> point) {
    LightSide side = LightSide::none;
    for (uint32_t i = 0; i < light.incident_count; ++i) {
        const Incident& face = scene.incidents[light.first_incident + i];
        if (face.solid != index) continue;
        const Slab<Real>& slab = scene.slabs[scene.solids[index].first_slab + face.face / 2];
        const Real n = dot(slab.normal, point);
        if (face.face & 1u ? n > slab.high : n < slab.low) return LightSide::outside;
        side = LightSide::inside;
    }
    return side;
}

template <class E, class Real, class Media, class Scene>
CISTULA_INLINE LightSide light_side(const Scene& scene, uint32_t index, const ShadowRay<Real, Media>& shadow) {
    if constexpr (E::has(effect_lights_on_faces))
        if (shadow.light->incident_count != 0) return light_on_convex(scene, *shadow.light, index, shadow.ray.origin);
    return LightSide::none;
}

/// Adds a convex solid that rays to a light at `distance` start inside and leave at `leave`, or not before the light.
template <class Real, class E>
CISTULA_INLINE void add_exit(const MaskOf<Real>& active, const Material<ScalarOf<Real>>& material, Real leave,
                             Real distance, ShadowSumOf<E, Real>& sum) {
    sum.cross(material, active & (leave < distance));
    if constexpr (E::has(effect_absorption))
        sum.absorb(material, max_or_second(min_or_second(leave, distance), Real(0)), active);
}
/// Adds a convex solid that rays to a light at `distance` enter before it.
template <class Real, class E>
CISTULA_INLINE void add_entry(const MaskOf<Real>& active, const Material<ScalarOf<Real>>& material, Real enter,
                              Real leave, Real distance, ShadowSumOf<E, Real>& sum) {
    sum.cross(material, active & (leave < distance));
    sum.cross(material, active);
    if constexpr (E::has(effect_absorption))
        sum.absorb(material, max_or_second(min_or_second(leave, distance) - enter, Real(0)), active);
}

/// Adds what a convex solid that contains the ray's origin takes from a light. A light on that solid's own face is
/// never outside it, whatever the rounding of two nearly equal distances says.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_exit(const Scene& scene, uint32_t index, const ShadowRay<Real, Media>& shadow,
                                ShadowSum<E>& sum) {
    const Ray<Real, Media>& ray = shadow.ray;
    const Solid& solid = scene.solids[index];
    Real leave = shadow.distance;
    if (light_side<E>(scene, index, shadow) == LightSide::none) {
        const uint32_t skipped = face_left(scene, index, ray);
        leave = max_or_second(convex_here::exit_of(scene, solid, ray.origin, ray.direction, skipped).t, Real(0));
    }
    add_exit<Real, E>(true, scene.materials[solid.material], leave, shadow.distance, sum);
}

/// Adds what a convex solid that the ray may enter takes from a light: one that it does not start in, has not left and
/// does not pass by. If the light lies on a face of the solid, half-spaces decide.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_entry(const Scene& scene, uint32_t index, const Solid& solid,
                                 const ShadowRay<Real, Media>& shadow, ShadowSum<E>& sum) {
    const Ray<Real, Media>& ray = shadow.ray;
    const LightSide side = light_side<E>(scene, index, shadow);
    if (side == LightSide::outside) return;
    const auto interval = convex_here::interval_of(scene, solid, ray.origin, ray.direction, side == LightSide::none);
    const Real enter = max_or_second(interval.enter, Real(0));
    Real leave = shadow.distance;
    if (side == LightSide::none) {
        if (!is_met(interval, scene.extent) || !(enter < shadow.distance)) return;
        leave = max_or_second(interval.leave, Real(0));
    }
    add_entry<Real, E>(true, scene.materials[solid.material], enter, leave, shadow.distance, sum);
}

/// Adds what a convex solid takes from a light that has a face on the shared plane on which the ray starts.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_entry_beside(const Scene& scene, uint32_t index, uint32_t own_face,
                                        const ShadowRay<Real, Media>& shadow, ShadowSum<E>& sum) {
    if constexpr (Media::contacts) {
        const LightSide side = light_side<E>(scene, index, shadow);
        if (side == LightSide::outside) return;
        const Ray<Real, Media>& ray = shadow.ray;
        const EntryBeside<Real> entry =
            entry_beside(scene, index, own_face, ray.origin, ray.direction, scene.shared_planes[ray.from_plane].slack);
        const Real enter = max_or_second(entry.enter, Real(0));
        if (entry.face == no_face || !(enter < shadow.distance)) return;
        const Material<Real>& material = scene.materials[scene.solids[index].material];
        const bool leaves = side == LightSide::none && entry.leave < shadow.distance;
        sum.cross(material);
        if (leaves) sum.cross(material);
        if constexpr (E::has(effect_absorption))
            sum.absorb(material, max_or_second((leaves ? entry.leave : shadow.distance) - enter, Real(0)));
    }
}

/// Adds what a ball takes from the light of rays that start inside it, and of others outside (docs/rules.md, 14, line
/// 10). No light lies on it, so that rounding does not decide whether one is inside.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE void shadow_ball(const Scene& scene, uint32_t index, const ShadowRay<Real, Media>& shadow,
                                const MaskOf<Real>& inside, const MaskOf<Real>& outside, ShadowSumOf<E, Real>& sum) {
    using T = ScalarOf<Real>;
    const Solid& solid = scene.solids[index];
    const Ball<T>& ball = scene.balls[solid.first_slab];
    const Ray<Real, Media>& ray = shadow.ray;
    const BallChord<Real> chord = BallChord<Real>::of(ball, ray.origin, ray.direction);
    const Real beyond = shadow.distance - chord.middle;
    const MaskOf<Real> lit_inside = beyond * beyond < chord.square;
    MaskOf<Real> enters = outside & (lit_inside | (chord.is_ahead & (beyond > Real(0))));
    if (!any(inside | enters)) return;
    const MaskOf<Real> on = starts_on_ball(scene, index, ball, ray);
    enters = enters & !on;
    const Real half = chord.half();
    const Real far = select(inside & on, Real(2) * chord.middle, chord.middle + half);
    const Real leave = select(lit_inside, shadow.distance, clamped(far, Real(0), shadow.distance));
    const Real enter = clamped(select(inside, Real(0), chord.middle - half), Real(0), shadow.distance);
    const Material<T>& material = scene.materials[solid.material];
    sum.cross(material, enters);
    sum.cross(material, (inside | enters) & !lit_inside);
    if constexpr (E::has(effect_absorption))
        sum.absorb(material, max_or_second(leave - enter, Real(0)), inside | enters);
}

template <class Real, class E, class Media, class Scene>
CISTULA_HOST_NOINLINE void shadow_convex(const Scene& scene, uint32_t index, const ShadowRay<Real, Media>& shadow,
                                         ShadowSum<E>& sum) {
    if constexpr (meets_balls<E, Scene>)
        if (is_ball(scene.solids[index])) {
            const bool inside = shadow.ray.media.contains(index);
            return shadow_ball<E>(scene, index, shadow, inside, !inside, sum);
        }
    if (shadow.ray.media.contains(index))
        shadow_exit<Real, E>(scene, index, shadow, sum);
    else if (const uint32_t own_face = face_at_start(scene, index, shadow.ray); own_face != no_face)
        shadow_entry_beside<Real, E>(scene, index, own_face, shadow, sum);
    else if (shadow.ray.from_solid != index && !misses_bounds(BoundingSphere<Real>::of(scene.solids[index]),
                                                              shadow.ray.origin, shadow.ray.direction, shadow.distance))
        shadow_entry<Real, E>(scene, index, scene.solids[index], shadow, sum);
}

/// Whether a light lies on a face of a solid.
template <class Real, class Scene>
CISTULA_INLINE bool lies_on(const Scene& scene, const Light<Real>& light, uint32_t solid, uint32_t face) {
    bool lies = false;
    for (uint32_t i = 0; i < light.incident_count; ++i) {
        const Incident& incident = scene.incidents[light.first_incident + i];
        lies |= incident.solid == solid && incident.face == face;
    }
    return lies;
}

/// Adds accepted crossings of a triangle, where `active` holds, if they lie before the light.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_crossing(const Scene& scene, const MaskOf<Real>& active, uint32_t index, uint32_t triangle,
                                    const TriangleCrossing<Real>& c, const ShadowRay<Real, Media>& shadow,
                                    ShadowSumOf<E, Real>& sum) {
    const Real t = crossing_time(scene, index, triangle, c.t, shadow.ray);
    const MaskOf<Real> own = (shadow.ray.from_solid == index) & (shadow.ray.from_face == triangle);
    const MaskOf<Real> before = active & (t >= Real(0)) & (t < shadow.distance) & !own;
    if (!any(before)) return;
    if constexpr (E::has(effect_lights_on_faces))
        if (lies_on(scene, *shadow.light, index, triangle)) return;
    const Solid& solid = scene.solids[index];
    const auto& material = scene.materials[solid.material];
    sum.cross(material, before);
    if constexpr (E::has(effect_absorption) && in_lanes<Real>)
        absorb_crossings(scene, solid, shadow, t, c.enters(), before, sum);
    else if constexpr (E::has(effect_absorption))
        if (solid.kind == SolidKind::mesh)
            sum.absorb_rest(material, shadow.distance, t, c.enters() ? 1 : -1, scene.extent);
}

/// Adds what a cluster's triangles take from a light, for a ray that does not start on the cluster's flat sheet.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_triangles(const Scene& scene, uint32_t index, const ShadowRay<Real, Media>& shadow,
                                     const TriangleRay<Real>& triangle_ray, ShadowSum<E>& sum) {
    const Cluster<Real>& cluster = scene.clusters[index];
    for_each_crossing(cluster, triangle_ray, [&](uint32_t lane, const TriangleCrossing<Real>& c) {
        shadow_crossing<Real, E>(scene, true, cluster.solid, cluster.triangle[lane], c, shadow, sum);
    });
}

template <class Real, class E, class Media, class Scene>
CISTULA_HOST_NOINLINE void shadow_cluster(const Scene& scene, uint32_t index, const ShadowRay<Real, Media>& shadow,
                                          const TriangleRay<Real>& triangle_ray, ShadowSum<E>& sum) {
    if (!starts_on_flat_sheet(scene, index, shadow.ray))
        shadow_triangles<Real, E>(scene, index, shadow, triangle_ray, sum);
}

/// Adds the crossing of one facet; `left` is the flat sheet on which the ray starts, or no_solid.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_facet(const Scene& scene, uint32_t index, const ShadowRay<Real, Media>& shadow,
                                 const TriangleRay<Real>& triangle_ray, uint32_t left, ShadowSum<E>& sum) {
    const Facet<Real>& facet = scene.facets[index];
    TriangleCrossing<Real> c;
    if (facet.solid != left && cross_triangle(ShearedTriangle<Real>::of(facet, triangle_ray), triangle_ray, c))
        shadow_crossing<Real, E>(scene, true, facet.solid, facet.triangle, c, shadow, sum);
}

/// Adds the disks before a light, where `active` holds.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE void shadow_disks(const Scene& scene, const ShadowRay<Real, Media>& shadow, const MaskOf<Real>& active,
                                 ShadowSumOf<E, Real>& sum) {
    if constexpr (meets_disks<E, Media>)
        for (uint32_t i = 0; i < scene.disks.size; ++i) {
            const Disk<ScalarOf<Real>>& disk = scene.disks[i];
            Real t;
            Vec3<Real> at;
            const MaskOf<Real> meets = active & cross_disk(scene, disk, shadow.ray, t, at);
            const MaskOf<Real> before = meets & (t < shadow.distance);
            if (!any(before)) continue;
            if constexpr (E::has(effect_lights_on_faces))
                if (lies_on(scene, *shadow.light, disk.solid, disk.face)) continue;
            sum.cross(scene.materials[scene.solids[disk.solid].material], before);
        }
}

/// Adds the absorption of meshes that contain the ray's origin, and the disks before the light.
template <class Real, class E, class Media, class Scene>
CISTULA_INLINE void shadow_start(const Scene& scene, const ShadowRay<Real, Media>& shadow, ShadowSum<E>& sum) {
    shadow_disks<E>(scene, shadow, true, sum);
    if constexpr (E::has(effect_absorption)) {
        shadow.ray.media.for_each([&](uint32_t index, int count) {
            const Solid& solid = scene.solids[index];
            for (int n = 0; solid.kind == SolidKind::mesh && n != count; n += count > 0 ? 1 : -1)
                sum.absorb_rest(scene.materials[solid.material], shadow.distance, Real(0), count > 0 ? 1 : -1,
                                scene.extent);
        });
    }
}

/// Whether shadow rays of a kernel may cross faces that rays pass unseen.
template <class E, class Media>
inline constexpr bool meets_unseen_faces =
    E::has(effect_transparent_shadows) && E::has(effect_fresnel) && Media::contacts;

/// 1 / kt of each face before the light that rays pass unseen between equal indices (Transparency::whole), all
/// multiplied. A line is followed until it is in more solids than it can list, or meets a mesh from the wrong side. (In
/// lanes: lane_shadow.h.)
template <class E, class Real, class Media, class Intersector, class Scene>
CISTULA_NOINLINE Real gain_of_unseen_faces(const Scene& scene, const Intersector& intersector,
                                           ShadowRay<Real, Media> shadow, bool) {
    Real gain = 1;
    Ray<Real, Media>& ray = shadow.ray;
    SurfaceEvent<Real, Media> event;
    for (;;) {
        const Hit<Real> hit = unobserved(intersector).closest(ray);
        if (!(hit.t < shadow.distance)) return gain;
        resolve_event<E>(scene, intersector, ray, hit, event);
        if (!event.fits || event.wrong_side) return gain;
        const bool equal = index_of(scene, ray.media) == index_of(scene, event.beyond);
        const uint32_t shaded = key_solid(event.hit.key);
        for (int i = 0; i < event.count; ++i) {
            const uint32_t solid = key_solid(event.taken[i].key);
            const Material<Real>& m = scene.materials[scene.solids[solid].material];
            if (m.transparency != Transparency::whole || !(m.transmission > Real(0)) ||
                scene.solids[solid].kind == SolidKind::sheet)
                continue;
            const bool beside = solid != shaded && m.index == scene.materials[scene.solids[shaded].material].index;
            if ((equal || beside) && !lies_on(scene, *shadow.light, solid, key_face(event.taken[i].key)))
                gain = gain / m.transmission;
        }
        ray.media = event.beyond;
        ray.after = event.last();
    }
}

/// Takes the faces that rays pass unseen out of a transmittance, whose sum has no order and cannot tell them.
template <class E, class Real, class Media, class Intersector, class Scene>
CISTULA_INLINE void gain_unseen_faces(const Scene& scene, const Intersector& intersector,
                                      const ShadowRay<Real, Media>& shadow, const MaskOf<Real>& active,
                                      Throughput<Real, E>& arrives) {
    const Real gain = gain_of_unseen_faces<E>(scene, intersector, shadow, active);
    const auto gained = [&](const Real& share) { return min_or_second(share * gain, Real(1)); };
    if constexpr (std::is_same_v<Throughput<Real, E>, Real>)
        arrives = gained(arrives);
    else
        arrives = {gained(arrives.x), gained(arrives.y), gained(arrives.z)};
}

}  // namespace cistula
