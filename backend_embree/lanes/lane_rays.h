// Hits of rays in lanes, and the light that reaches them, one query after the other: what tiles do, for those who check
// it. Numbers of solids are those of the LaneScene; interior lists hold each solid once.
#pragma once

#include "cistula/lanes/lane_intersector.h"

namespace cistula {

template <class Real>
struct LaneRayQueries {
    using T = ScalarOf<Real>;
    using E = Effects<effect_masks[limited_mask]>;  // compiled for tiles, too
    static constexpr int lanes = LaneTraits<Real>::lanes;

    /// Finds the closest hits of at most `lanes` rays.
    static void closest(const LaneScene<T>& scene, const Ray<T>* rays, int count, Hit<T>* hits) {
        const Hit<Real> found = LaneIntersector<Real>{scene}.template closest<E>(
            rays_of(scene, count, [&](int lane) -> const Ray<T>& { return rays[lane]; }), MaskOf<Real>::first(count));
        for (int lane = 0; lane < count; ++lane) {
            Hit<T>& hit = hits[lane];
            hit.t = found.t[lane];
            const bool any = (found.found().bits() >> lane & 1u) != 0;
            hit.key = any ? KeyFormat<Real>::of_lane(found.key, lane) : no_key;
            hit.u = found.u[lane];
            hit.v = found.v[lane];
            hit.slot = uint32_t(found.slot[lane]);
            hit.enters = (found.enters.bits() >> lane & 1u) != 0;
            hit.wrong_side_t = found.wrong_side_t[lane];
        }
    }

    /// Finds the shares of light that reach at most `lanes` rays, all toward one light.
    static void transmittance(const LaneScene<T>& scene, const ShadowRay<T>* shadows, int count, Vec3<T>* shares) {
        LaneArray<Real> distances(Real(T(0)));
        for (int lane = 0; lane < count; ++lane) distances.of[lane] = shadows[lane].distance;
        const ShadowRay<Real, LaneMedia<Real>> all{
            rays_of(scene, count, [&](int lane) -> const Ray<T>& { return shadows[lane].ray; }), distances.all(),
            shadows[0].light};
        const auto arrives = LaneIntersector<Real>{scene}.template transmittance<E>(all, MaskOf<Real>::first(count));
        for (int lane = 0; lane < count; ++lane)
            for (int c = 0; c < 3; ++c) shares[lane][c] = channel(arrives, c)[lane];
    }

  private:
    using Media = LaneMedia<Real>;
    using Index = IndexOf<Real>;
    using Integer = ScalarOf<Index>;
    using Indices = LaneArray<Index>;

    template <class Get>
    static Ray<Real, Media> rays_of(const LaneScene<T>& scene, int count, const Get& get) {
        LaneVectors<Real> origins(Vec3<Real>(Real(T(0)))), directions(Vec3<Real>(Real(T(0))));
        LaneArray<Real> after(Real(T(-1)));
        Indices keys{Index(0)}, solids{Index(Integer(no_solid))}, faces{Index(0)}, planes{Index(Integer(no_plane))},
            media{Index(0)};
        for (int lane = 0; lane < count; ++lane) {
            const Ray<T>& ray = get(lane);
            origins.set(lane, ray.origin);
            directions.set(lane, ray.direction);
            after.of[lane] = ray.after.t;
            keys.of[lane] = KeyFormat<Real>::of_single(ray.after.key);
            solids.of[lane] = Integer(ray.from_solid);
            faces.of[lane] = Integer(ray.from_face);
            planes.of[lane] = Integer(ray.from_plane);
            media.of[lane] = int32_t(InteriorSet::of(ray.media, scene.named).bits);
        }
        Ray<Real, Media> rays;
        rays.origin = origins.all();
        rays.direction = directions.all();
        rays.after = {after.all(), keys.all()};
        rays.from_solid = solids.all();
        rays.from_face = faces.all();
        rays.from_plane = planes.all();
        rays.media = {media.all(), scene.named};
        return rays;
    }
};

}  // namespace cistula
