// A surface event: a ray meets one face or several in one plane: which of their crossings is shaded, and the media
// beyond them all. Light then passes from one touching body to the other without a gap between them (docs/rules.md, 4
// and 11), and rays that stay on the viewer's side are in the viewer's medium.
#pragma once

#include <concepts>

#include "cistula/geometry/shared_plane.h"
#include "cistula/shading/surface.h"

namespace cistula {

template <class Real, class Media = InteriorList>
struct SurfaceEvent {
    static constexpr int capacity = Media::contacts && !in_lanes<Real> ? 8 : 1;  // lanes keep the last one

    Hit<Real> hit;                   // the crossing to shade
    Crossing<Real> taken[capacity];  // all crossings, in order
    int count;
    Media beyond;          // media behind all of them
    MaskOf<Real> fits;     // whether `beyond` had room
    bool wrong_side;       // whether refused mesh crossings come before the first (Hit::wrong_side_t)
    MaskOf<Real> changes;  // whether a solid begins or ends here; else the ray goes straight on

    CISTULA_INLINE void begin(const Ray<Real, Media>& ray, const Hit<Real>& first) {
        hit = first;
        count = 0;
        beyond = ray.media;
        fits = true;
        changes = true;
        if constexpr (Media::meshes) wrong_side = first.wrong_side_t <= first.t;
        take(first);
    }

    /// Takes another event where `active` holds; in lanes.
    CISTULA_INLINE void take_where(const MaskOf<Real>& active, const SurfaceEvent& other) {
        hit.take(active, other.hit.t, other.hit.key, other.hit.u, other.hit.v, other.hit.slot, other.hit.enters);
        assign_where(active, taken[0].t, other.taken[0].t);
        assign_where(active, taken[0].key, other.taken[0].key);
        beyond.take_where(active, other.beyond);
    }

    CISTULA_INLINE const Crossing<Real>& last() const {
        if constexpr (capacity == 1)
            return taken[0];  // no index: it would force the struct into memory
        else
            return taken[count - 1];
    }

    CISTULA_INLINE void take(const Hit<Real>& crossing) {
        taken[capacity == 1 ? 0 : count] = {crossing.t, crossing.key};
        ++count;
        fits &= beyond.cross(is_kind(crossing.key, CrossingKind::enter), is_kind(crossing.key, CrossingKind::leave),
                             key_solid(crossing.key));
    }
};

/// An intersector as far as it finds a ray's next crossing after ray.after.
template <class I, class Real, class Media>
concept FindsHits = requires(const I& intersector, const Ray<Real, Media>& ray) {
    { intersector.closest(ray) } -> std::same_as<Hit<Real>>;
};

/// The intersector for crossings that are looked for beside those that a ray meets: one that observes rays is not to
/// notice.
template <class Intersector>
CISTULA_INLINE const Intersector& unobserved(const Intersector& intersector) {
    return intersector;
}

/// Collects the crossings at exactly the same t, up to a sheet, and chooses what is shaded: of the solids that begin or
/// end there the last in the file, of opaque ones that end if there are any, else of opaque ones that begin
/// (docs/rules.md, 11, line 6). Not inlined: few events have more than one crossing.
template <class Real, class Media, FindsHits<Real, Media> Intersector>
CISTULA_NOINLINE void gather_shared(const SceneView<Real>& scene, const Intersector& intersector,
                                    const Ray<Real, Media>& ray, SurfaceEvent<Real, Media>& event) {
    Hit<Real> hits[SurfaceEvent<Real, Media>::capacity];
    hits[0] = event.hit;
    Ray<Real, Media> probe = ray;
    while (event.count < SurfaceEvent<Real, Media>::capacity) {
        probe.media = event.beyond;
        probe.after = event.last();
        const Hit<Real> next = unobserved(intersector).closest(probe);
        if (!(next.t == event.taken[0].t) || key_kind(next.key) == CrossingKind::sheet) break;
        hits[event.count] = next;
        event.take(next);
    }
    event.changes = false;
    uint32_t shaded = 0;  // its place among those that may be: opaque ones that end, that begin, others; then by number
    for (int i = 0; i < event.count; ++i) {
        const uint32_t solid = key_solid(hits[i].key);
        const bool ends = ray.media.contains(solid);
        if (ends == event.beyond.contains(solid)) continue;
        const uint32_t place = (is_opaque(scene, solid) ? (ends ? 2u : 1u) : 0u) << 24 | solid;
        if (event.changes && place < shaded) continue;
        shaded = place;
        event.hit = hits[i];
        event.changes = true;
    }
}

/// Finds the surface event at `hit`, the ray's next crossing.
template <class E, class Real, class Media, FindsHits<Real, Media> Intersector, class Scene>
CISTULA_INLINE void resolve_event(const Scene& scene, const Intersector& intersector, const Ray<Real, Media>& ray,
                                  const Hit<Real>& hit, SurfaceEvent<Real, Media>& event) {
    event.begin(ray, hit);
    if constexpr (meets_contacts<E, Media>) {
        if (key_kind(hit.key) == CrossingKind::sheet) return;
        const uint32_t solid = key_solid(hit.key);
        if constexpr (meets_balls<E, Scene>)
            if (is_ball(scene.solids[solid])) {
                if (scene.balls[scene.solids[solid].first_slab].has_kin != 0)
                    gather_shared(scene, intersector, ray, event);
                return;
            }
        if (scene.shared_planes.empty()) return;
        if (plane_of_face(scene, solid, key_face(hit.key)) != no_plane)
            gather_shared(scene, intersector, ray, event);
        else  // neither: one of the two crossings of a grazed edge, in the wrong order
            event.changes = ray.media.contains(solid) || event.beyond.contains(solid);
    }
}

}  // namespace cistula
