// The search along a branch's line for the next face that is shaded or bends the ray.
#pragma once

#include "cistula/lights/visible_light.h"
#include "cistula/shading/absorption.h"
#include "cistula/shading/interface.h"
#include "cistula/shading/surface_event.h"
#include "cistula/transport/branch.h"
#include "cistula/transport/layered_sums.h"

namespace cistula {

/// The maximum number of faces that a ray may pass without shading or bending; more fail the render
/// (flag_too_many_crossings).
inline constexpr int largest_crossings = 1 << 20;

/// Whether all rays that pass a face go straight on.
template <class E>
inline constexpr bool lines_go_on = E::has(effect_transmission) && !E::has(effect_refraction);

/// Finds the surfaces that the branches of a tree meet.
template <class Real, class E, class Intersector>
class NextSurface {
  public:
    using Media = typename Intersector::Media;
    using Scene = typename Intersector::Scene;
    using Entry = BranchOf<Real, E, Media>;
    using Sums = SumsOf<Real, E>;

    /// `depth`: maximum number of surfaces on a path.
    CISTULA_INLINE NextSurface(const Scene& scene, const Intersector& intersector, int depth, Sums& sums)
        : scene_(scene), intersector_(intersector), depth_(depth), sums_(sums) {}

    /// Finds the branch's next surface. False if there is none: the visible light or background at the end of the ray
    /// is then added, and `visible` is the light, if it was one.
    CISTULA_INLINE bool find(Entry& branch, SurfaceEvent<Real, Media>& event, VisibleLightHit<Real>& visible) {
        Absorption<E::has(effect_absorption)> absorption;
        absorption.begin(scene_, branch.ray.media, branch.ray.after.t);
        for (int crossings = 0;; ++crossings) {
            const Hit<Real> hit = intersector_.template closest<E>(branch.ray);
            if constexpr (E::has(effect_visible_lights)) visible = light_before(hit, branch);
            const bool light = visible.light != no_light;
            if (light || !hit.found()) {
                absorption.dim(scene_, branch.ray.media, light ? visible.t : hit.t, branch.weight);
                sums_.add(branch.weight * light_or_background(visible),
                          light ? LightSource::visible_light : LightSource::background);
                return false;
            }
            resolve_event<E>(scene_, intersector_, branch.ray, hit, event);
            if (!event.fits) sums_.flag(flag_media_overflow);
            if (!invisible(branch.ray, event)) {
                absorption.dim(scene_, branch.ray.media, event.hit.t, branch.weight);
                return true;
            }
            for (int i = 0; i < event.count; ++i) absorption.cross(scene_, event.taken[i].key, event.taken[i].t);
            pass(branch.ray, event, absorption);
            if (crossings == largest_crossings) {
                sums_.flag(flag_too_many_crossings);
                return false;
            }
        }
    }

    /// Moves a ray straight on through a face.
    template <class Absorbed>
    CISTULA_INLINE void pass(Ray<Real, Media>& ray, const SurfaceEvent<Real, Media>& event, Absorbed& absorption) {
        Media media = event.beyond;
        if constexpr (Media::meshes)
            if (event.wrong_side) count_wrong_side(ray, event.taken[0], media, absorption);
        ray.media = media;
        ray.after = event.last();
    }

  private:
    /// Adds refused crossings to the media. A ray's first crossing of a mesh is from the right side; others of the same
    /// mesh that rounding puts before it, at a grazed edge, count as well once the ray goes straight on.
    template <class Absorbed>
    CISTULA_INLINE void count_wrong_side(const Ray<Real, Media>& ray, const Crossing<Real>& crossing, Media& media,
                                         Absorbed& absorption) {
        Ray<Real, Media> probe = ray;
        probe.accept_both_sides();
        for (;;) {
            const Hit<Real> next = intersector_.closest(probe);
            if (!Crossing<Real>{next.t, next.key}.before(crossing.t, crossing.key)) return;
            if (!media.add(key_solid(next.key), media_change(key_kind(next.key)))) sums_.flag(flag_media_overflow);
            absorption.cross(scene_, next.key, next.t);
            probe.after = {next.t, next.key};
        }
    }

    /// Whether a crossing has nothing to shade: it lies inside a medium of higher priority, or belongs to a clear face
    /// between equal media.
    CISTULA_INLINE bool invisible(const Ray<Real, Media>& ray, const SurfaceEvent<Real, Media>& event) const {
        if constexpr (!E::has(effect_transmission | effect_insides)) {
            return false;
        } else {
            if constexpr (meets_contacts<E, Media>)
                if (!event.changes) return true;
            const uint32_t solid = key_solid(event.hit.key), medium = ray.media.medium();
            bool within_higher = key_kind(event.hit.key) != CrossingKind::sheet && medium != no_solid && medium > solid;
            if constexpr (meets_contacts<E, Media>) within_higher = within_higher && event.beyond.contains(medium);
            if (within_higher) return true;
            if (!is_clear(scene_, solid)) return false;
            if constexpr (E::has(effect_refraction))
                return index_of(scene_, ray.media) == index_of(scene_, event.beyond);
            return true;
        }
    }

    /// The radiance of the visible light `visible`, or the background if there is none.
    CISTULA_INLINE Vec3<Real> light_or_background([[maybe_unused]] const VisibleLightHit<Real>& visible) const {
        if constexpr (E::has(effect_visible_lights))
            if (visible.light != no_light) return scene_.visible_lights[visible.light].radiance;
        return scene_.background;
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
