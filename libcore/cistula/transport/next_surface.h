// The search along a branch's line for the next face that is shaded or bends the ray.
#pragma once

#include "cistula/lights/visible_light.h"
#include "cistula/model/layers.h"
#include "cistula/model/pixel_record.h"
#include "cistula/model/sky.h"
#include "cistula/shading/absorption.h"
#include "cistula/shading/interface.h"
#include "cistula/shading/surface_event.h"
#include "cistula/transport/branch.h"

namespace cistula {

/// The maximum number of faces that a ray may pass without shading or bending; more fail the render
/// (flag_too_many_crossings).
inline constexpr int largest_crossings = 1 << 20;

/// Whether all rays that pass a face go straight on.
template <class E>
inline constexpr bool lines_go_on = E::has(effect_transmission) && !E::has(effect_refraction);

/// Finds the surfaces that the branches of a tree meet. Sums: where the light of what they pass and end at is added.
template <class Real, class E, class Intersector, class Sums>
class NextSurface {
  public:
    using Media = typename Intersector::Media;
    using Scene = typename Intersector::Scene;
    using Entry = BranchOf<Real, E, Media>;

    /// `depth`: maximum number of surfaces on a path.
    CISTULA_INLINE NextSurface(const Scene& scene, const Intersector& intersector, int depth, Sums& sums)
        : scene_(scene), intersector_(intersector), depth_(depth), sums_(sums) {}

    /// Finds the branch's next surface. False if there is none: the visible light or background at the end of the ray
    /// is then added, and `visible` is the light, if it was one. A ray that is inside more solids than it can list ends
    /// with its flag, and so does one that passes too many faces.
    CISTULA_INLINE bool find(Entry& branch, SurfaceEvent<Real, Media>& event, VisibleLightHit<Real>& visible) {
        Absorption<E::has(effect_absorption), Real> absorption;
        absorption.begin(scene_, branch.ray.media, branch.ray.after.t);
        for (int crossings = 0;; ++crossings) {
            const Hit<Real> hit = intersector_.template closest<E>(branch.ray);
            if constexpr (E::has(effect_visible_lights)) visible = light_before(hit, branch);
            const bool light = visible.found();
            if (light || !hit.found()) {
                absorption.dim(scene_, branch.ray.media, light ? visible.t : hit.t, branch.weight);
                sums_.add(branch.weight * light_or_background(visible, branch.ray.direction),
                          light ? LightSource::visible_light : LightSource::background);
                return false;
            }
            resolve_event<E>(scene_, intersector_, branch.ray, hit, event);
            if (!event.fits) {
                sums_.flag(flag_media_overflow);
                return false;
            }
            if (!invisible(branch.ray, event)) {
                absorption.dim(scene_, branch.ray.media, event.hit.t, branch.weight);
                return true;
            }
            for (int i = 0; i < event.count; ++i) absorption.cross(scene_, event.taken[i].key, event.taken[i].t);
            if (!pass(branch.ray, event, absorption)) {
                sums_.flag(flag_media_overflow);
                return false;
            }
            if (crossings == largest_crossings) {
                sums_.flag(flag_too_many_crossings);
                return false;
            }
        }
    }

    /// Moves a ray straight on through a face; false if its media had no room.
    template <class Absorbed>
    CISTULA_INLINE bool pass(Ray<Real, Media>& ray, const SurfaceEvent<Real, Media>& event, Absorbed& absorption) {
        Media media = event.beyond;
        if constexpr (Media::meshes)
            if (event.wrong_side && !count_wrong_side(ray, event.taken[0], media, absorption)) return false;
        ray.media = media;
        ray.after = event.last();
        return true;
    }

    /// The branches in lanes that meet a surface. `single`: those whose media lanes cannot hold; nothing was added for
    /// them.
    CISTULA_INLINE MaskOf<Real> find(Entry& branch, const MaskOf<Real>& active, SurfaceEvent<Real, Media>& event,
                                     VisibleLightHit<Real>& visible, MaskOf<Real>& single) {
        Absorption<E::has(effect_absorption), Real> absorption;
        absorption.begin(scene_, branch.ray.media, branch.ray.after.t, active);
        MaskOf<Real> met = false;
        MaskOf<Real> left = active;
        SurfaceEvent<Real, Media> later;
        for (int crossings = 0;; ++crossings) {
            const Hit<Real> hit = intersector_.template closest<E>(branch.ray, left);
            VisibleLightHit<Real> light;
            if constexpr (E::has(effect_visible_lights)) light = light_before(hit, branch, left);
            const MaskOf<Real> ends = left & (light.found() | !hit.found());
            if (any(ends)) {
                absorption.dim(scene_, branch.ray.media, select(light.found(), light.t, hit.t), branch.weight, ends);
                sums_.add_end(branch.weight * light_or_background(light, branch.ray.direction, ends), light.found(),
                              ends);
                assign_where(ends, visible.t, light.t);
                assign_where(ends, visible.light, light.light);
            }
            SurfaceEvent<Real, Media>& next = crossings == 0 ? event : later;
            left = left & !ends;
            const MaskOf<Real> strays = resolve_event<E>(scene_, branch.ray, hit, left, next);
            single |= strays;
            left = left & !strays;
            if (any(left & !next.fits)) {
                sums_.flag(flag_media_overflow);
                left = left & next.fits;
            }
            const MaskOf<Real> passes = left & invisible(branch.ray, next);
            const MaskOf<Real> stops = left & !passes;
            absorption.dim(scene_, branch.ray.media, next.hit.t, branch.weight, stops);
            if (crossings > 0) event.take_where(stops, next);
            met |= stops;
            if (!any(passes)) return met;
            absorption.change(scene_, branch.ray.media, next.beyond, next.taken[0].t, passes);
            pass(branch.ray, next, passes);
            left = passes;
            if (crossings == largest_crossings) {
                sums_.flag(flag_too_many_crossings);
                return met;
            }
        }
    }

    /// Moves rays straight on through a face, where `active` holds.
    CISTULA_INLINE void pass(Ray<Real, Media>& ray, const SurfaceEvent<Real, Media>& event,
                             const MaskOf<Real>& active) {
        ray.media.take_where(active, event.beyond);
        assign_where(active, ray.after.t, event.taken[0].t);
        assign_where(active, ray.after.key, event.taken[0].key);
    }

  private:
    /// Adds refused crossings to the media; false if these had no room. A ray's first crossing of a mesh is from the
    /// right side; others of the same mesh that rounding puts before it, at a grazed edge, count as well once the ray
    /// goes straight on.
    template <class Absorbed>
    CISTULA_INLINE bool count_wrong_side(const Ray<Real, Media>& ray, const Crossing<Real>& crossing, Media& media,
                                         Absorbed& absorption) {
        Ray<Real, Media> probe = ray;
        probe.accept_both_sides();
        for (;;) {
            const Hit<Real> next = unobserved(intersector_).closest(probe);
            if (!Crossing<Real>{next.t, next.key}.before(crossing.t, crossing.key)) return true;
            if (!media.add(key_solid(next.key), media_change(key_kind(next.key)))) return false;
            absorption.cross(scene_, next.key, next.t);
            probe.after = {next.t, next.key};
        }
    }

    /// Whether a crossing has nothing to shade: it is one of a transparent solid inside a medium of higher priority, or
    /// belongs to a face that changes nothing between equal indices.
    CISTULA_INLINE MaskOf<Real> invisible(const Ray<Real, Media>& ray, const SurfaceEvent<Real, Media>& event) const {
        if constexpr (!E::has(effect_transmission | effect_insides)) {
            return false;
        } else {
            MaskOf<Real> unchanged = false;
            if constexpr (meets_contacts<E, Media>) {
                unchanged = !event.changes;
                if (all(unchanged)) return unchanged;
            }
            const IndexOf<Real> solid = key_solid(event.hit.key);
            MaskOf<Real> within_higher = unchanged;
            if constexpr (Media::contacts) {
                const IndexOf<Real> medium = ray.media.medium(scene_);
                MaskOf<Real> inside =
                    (!is_kind(event.hit.key, CrossingKind::sheet)) & (medium != no_solid) & (medium > solid);
                if constexpr (meets_contacts<E, Media>) inside = inside & event.beyond.contains(medium);
                if (any(inside)) within_higher = within_higher | (inside & !is_opaque(scene_, solid));
                if (all(within_higher)) return within_higher;
            }
            MaskOf<Real> clear = is_clear(scene_, solid);
            if constexpr (E::has(effect_refraction))
                if (any(clear))
                    clear = clear & narrowed<Real>(index_of(scene_, ray.media) == index_of(scene_, event.beyond));
            return within_higher | clear;
        }
    }

    /// The radiances of visible lights, or the background where there is none.
    CISTULA_INLINE Vec3<Real> light_or_background([[maybe_unused]] const VisibleLightHit<Real>& visible,
                                                  [[maybe_unused]] const Vec3<Real>& direction,
                                                  [[maybe_unused]] const MaskOf<Real>& active) const {
        Vec3<Real> radiance = spread<Real>(scene_.background);
        if constexpr (E::has(effect_sky))
            if (scene_.sky.kind != SkyKind::none) radiance = sky_radiance(scene_, direction, active & !visible.found());
        if constexpr (E::has(effect_visible_lights))
            for_each_value(active & visible.found(), visible.light, [&](uint32_t light, const MaskOf<Real>& same) {
                assign_where(same, radiance, spread<Real>(scene_.visible_lights[light].radiance));
            });
        return radiance;
    }

    /// The visible lights that rays in lanes meet before `hit`.
    CISTULA_INLINE VisibleLightHit<Real> light_before(const Hit<Real>& hit, Entry& branch,
                                                      const MaskOf<Real>& active) const {
        MaskOf<Real> asked = active;
        MaskOf<Real> goes_on = false;
        if constexpr (lines_go_on<E>) {
            asked = active & !branch.no_light_ahead;
            if (int(branch.depth) + 1 < depth_) goes_on = hit.found() & transmits(scene_, key_solid(hit.key));
        }
        const VisibleLightHit<Real> visible =
            closest_visible_light(scene_, branch.ray, select(goes_on, Real(RealTraits<Real>::infinity), hit.t), asked);
        if constexpr (lines_go_on<E>) assign_where(asked & !visible.found(), branch.no_light_ahead, goes_on);
        VisibleLightHit<Real> before;
        const MaskOf<Real> is_before = visible.found() & (visible.t <= hit.t);
        assign_where(is_before, before.t, visible.t);
        assign_where(is_before, before.light, visible.light);
        return before;
    }

    /// The radiance of the visible light `visible`, or the background if there is none.
    CISTULA_INLINE Vec3<Real> light_or_background([[maybe_unused]] const VisibleLightHit<Real>& visible,
                                                  const Vec3<Real>& direction) const {
        if constexpr (E::has(effect_visible_lights))
            if (visible.light != no_light) return scene_.visible_lights[visible.light].radiance;
        return background_radiance<E>(scene_, direction);
    }

    /// The visible light that the ray meets before `hit`. If the ray may go straight on from there, its whole line is
    /// searched, and `no_light_ahead` keeps a negative result.
    CISTULA_INLINE VisibleLightHit<Real> light_before(const Hit<Real>& hit, Entry& branch) const {
        if constexpr (lines_go_on<E>)
            if (branch.no_light_ahead) return VisibleLightHit<Real>();
        const bool goes_on =
            lines_go_on<E> && hit.found() && int(branch.depth) + 1 < depth_ && transmits(scene_, key_solid(hit.key));
        const VisibleLightHit<Real> visible =
            closest_visible_light(scene_, branch.ray, goes_on ? RealTraits<Real>::infinity : hit.t);
        if (visible.light == no_light) branch.no_light_ahead = goes_on;
        return visible.t <= hit.t ? visible : VisibleLightHit<Real>();
    }

    const Scene& scene_;
    const Intersector& intersector_;
    const int depth_;
    Sums& sums_;
};

}  // namespace cistula
