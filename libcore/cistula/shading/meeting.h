// A ray meets a face: which of the crossings that rounding cannot tell apart is shaded, and what is beyond them all.
// Touching bodies then pass light from one index straight to the other (docs/rules.md, 4), and what stays on the
// viewer's side is in the viewer's medium.
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/shading/surface.h"

namespace cistula {

template <class Real, class Media = MediaList>
struct Meeting {
    static constexpr int capacity = Media::contacts ? 8 : 1;

    Hit<Real> hit;                   // the crossing to shade: of the solid with the highest priority
    Crossing<Real> taken[capacity];  // crossings that change the media, in their order; sheets change none
    int count;
    Media beyond;      // after all of them
    bool fits;         // whether the lists had room
    bool passed_over;  // whether crossings from the wrong side come before the first

    CISTULA_INLINE void begin(const Ray<Real, Media>& ray, const Hit<Real>& first) {
        hit = first;
        count = 0;
        beyond = ray.media;
        fits = true;
        passed_over = first.passed_over <= first.t;
        take(first);
    }

    CISTULA_INLINE const Crossing<Real>& last() const {
        if constexpr (capacity == 1)
            return taken[0];  // no index: that would put all of it into memory
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

/// A new line starts up to 8 u M beyond a mesh, and t is rounded by as much again, so crossings of other solids within
/// twice that of the face belong to the same meeting.
template <class Real, class Intersector, class Media, class Scene>
CISTULA_INLINE void meet_touching(const Scene& scene, const Intersector& intersector, const Ray<Real, Media>& ray,
                                  const Hit<Real>& hit, Meeting<Real, Media>& meeting) {
    const Real cosine = magnitude(dot(normal_at(scene, hit), ray.direction));
    const Real reach = hit.t + incidence<Real> * scene.extent / greatest(cosine, Real(0x1p-10));
    // A mesh's two crossings at an edge may come in the wrong order: then both are taken.
    const bool turned = hit.enters == ray.media.contains(key_solid(hit.key));
    Ray<Real, Media> probe = ray;
    while (meeting.count < Meeting<Real, Media>::capacity) {
        probe.media = meeting.beyond;
        probe.after = meeting.last();
        const Hit<Real> next = intersector.closest(probe);
        const uint32_t solid = key_solid(next.key);
        if (!(next.t <= reach) || key_kind(next.key) == CrossingKind::sheet || (solid == key_solid(hit.key) && !turned))
            break;
        const bool higher = solid > key_solid(meeting.hit.key);
        meeting.take(next);
        if (higher) meeting.hit = next;
    }
}

/// `hit` is the ray's next crossing.
template <class Real, class Intersector, class Media, class Scene>
CISTULA_INLINE void meet(const Scene& scene, const Intersector& intersector, const Ray<Real, Media>& ray,
                         const Hit<Real>& hit, Meeting<Real, Media>& meeting) {
    meeting.begin(ray, hit);
    if constexpr (Media::contacts)
        if (scene.solids[key_solid(hit.key)].touched) meet_touching(scene, intersector, ray, hit, meeting);
}

}  // namespace cistula
