// A surface event: a ray meets one or several faces that rounding cannot tell apart: which of their crossings is
// shaded, and the media beyond them all. Light then passes from one touching body to the other without a gap between
// them (docs/rules.md, 4), and rays that stay on the viewer's side are in the viewer's medium.
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/shading/surface.h"

namespace cistula {

template <class Real, class Media = InteriorList>
struct SurfaceEvent {
    static constexpr int capacity = Media::contacts ? 8 : 1;

    Hit<Real> hit;                   // the crossing to shade: that of the solid of highest priority
    Crossing<Real> taken[capacity];  // all crossings, in order
    int count;
    Media beyond;     // media behind all of them
    bool fits;        // whether `beyond` had room
    bool wrong_side;  // whether refused mesh crossings come before the first (Hit::wrong_side_t)

    CISTULA_INLINE void begin(const Ray<Real, Media>& ray, const Hit<Real>& first) {
        hit = first;
        count = 0;
        beyond = ray.media;
        fits = true;
        wrong_side = first.wrong_side_t <= first.t;
        take(first);
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
        const int change = media_change(key_kind(crossing.key));
        if (change != 0) fits &= beyond.add(key_solid(crossing.key), change);
    }
};

/// Collects crossings of other solids that belong to the same event: those within 16 u M of the face. (A new ray
/// starts up to 8 u M beyond a mesh, and the rounding of t is as large.)
template <class Real, class Intersector, class Media, class Scene>
CISTULA_INLINE void gather_touching(const Scene& scene, const Intersector& intersector, const Ray<Real, Media>& ray,
                                    const Hit<Real>& hit, SurfaceEvent<Real, Media>& event) {
    const Real cosine = magnitude(dot(normal_at(scene, hit), ray.direction));
    const Real reach = hit.t + incidence<Real> * scene.extent / max_or_second(cosine, Real(0x1p-10));
    // A mesh's two crossings at an edge may come in the wrong order: then both are taken.
    const bool turned = hit.enters == ray.media.contains(key_solid(hit.key));
    Ray<Real, Media> probe = ray;
    while (event.count < SurfaceEvent<Real, Media>::capacity) {
        probe.media = event.beyond;
        probe.after = event.last();
        const Hit<Real> next = intersector.closest(probe);
        const uint32_t solid = key_solid(next.key);
        if (!(next.t <= reach) || key_kind(next.key) == CrossingKind::sheet || (solid == key_solid(hit.key) && !turned))
            break;
        const bool higher = solid > key_solid(event.hit.key);
        event.take(next);
        if (higher) event.hit = next;
    }
}

/// Finds the surface event at `hit`, the ray's next crossing.
template <class Real, class Intersector, class Media, class Scene>
CISTULA_INLINE void resolve_event(const Scene& scene, const Intersector& intersector, const Ray<Real, Media>& ray,
                                  const Hit<Real>& hit, SurfaceEvent<Real, Media>& event) {
    event.begin(ray, hit);
    if constexpr (Media::contacts)
        if (scene.solids[key_solid(hit.key)].may_touch) gather_touching(scene, intersector, ray, hit, event);
}

}  // namespace cistula
