// Faces of several solids in one plane, in lanes: what is common is done for all lanes at once, the rest lane by lane
// (docs/rules.md, 11).
#pragma once

#include "cistula/lanes/lane_hit.h"
#include "cistula/shading/contact.h"
#include "cistula/traversal/bvh.h"

namespace cistula {

/// The intersector of single rays over a LaneScene.
template <class Real>
struct SingleIntersector {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const LaneScene<Real>& scene;

    template <class E = Effects<all_effects>>
    CISTULA_NOINLINE Hit<Real> closest(const Ray<Real>& ray) const {
        if (scene.tree.empty()) return BruteIntersector<Real>{scene}.template closest<E>(ray);
        return BvhIntersector<Real>{scene}.template closest<E>(ray);
    }
    template <class E>
    CISTULA_NOINLINE Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        if (scene.tree.empty()) return BruteIntersector<Real>{scene}.template transmittance<E>(shadow);
        return BvhIntersector<Real>{scene}.template transmittance<E>(shadow);
    }
};

/// The shared planes of faces; no_plane where there is none, or no such solid.
template <class Real>
CISTULA_INLINE IndexOf<Real> planes_of(const LaneScene<ScalarOf<Real>>& scene, const IndexOf<Real>& solid,
                                       const IndexOf<Real>& face) {
    using Index = IndexOf<Real>;
    LaneArray<Index> solids(solid), faces(face), planes;
    for (int lane = 0; lane < LaneTraits<Real>::lanes; ++lane) {
        const auto own = uint32_t(solids.of[lane]);
        planes.of[lane] =
            own < scene.solids.size ? plane_of_face(scene, own, uint32_t(faces.of[lane])) : ScalarOf<Index>(no_plane);
    }
    return planes.all();
}

template <class E, class T, int n>
CISTULA_INLINE void find_start_plane(const LaneScene<T>& scene, Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray) {
    if constexpr (E::has(effect_contacts))
        if (!scene.shared_planes.empty()) ray.from_plane = planes_of<Lanes<T, n>>(scene, ray.from_solid, ray.from_face);
}

/// The convex solids with a face on the shared planes on which rays start.
template <class T, int n>
CISTULA_INLINE auto bodies_at_start(const LaneScene<T>& scene, const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray) {
    using Index = IndexOf<Lanes<T, n>>;
    Index bodies = 0;
    for_each_value(ray.from_plane != Index(ScalarOf<Index>(no_plane)), ray.from_plane,
                   [&](uint32_t plane, const auto& same) {
                       assign_where(same, bodies, Index(int(scene.plane_bodies[plane].all())));
                   });
    return bodies;
}

/// EntryBeside in lanes, of rays that enter.
template <class Real>
struct LaneEntries {
    Real enter = 0;
    Real leave = 0;
    IndexOf<Real> face = 0;
    MaskOf<Real> found = false;
};

/// Where rays that start on a shared plane enter a convex solid that has a face there.
template <class T, int n>
CISTULA_NOINLINE LaneEntries<Lanes<T, n>> entries_beside(const LaneScene<T>& scene, uint32_t index,
                                                         const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray,
                                                         const MaskOf<Lanes<T, n>>& active) {
    LaneEntries<Lanes<T, n>> entries;
    for_each_lane(active, [&](int lane) {
        const auto plane = uint32_t(ray.from_plane[lane]);
        const EntryBeside<T> one =
            entry_beside(static_cast<const SceneView<T>&>(scene), index, face_on(scene, scene.solids[index], plane),
                         lane_of(ray.origin, lane), lane_of(ray.direction, lane), scene.shared_planes[plane].slack);
        if (one.face == no_face) return;
        entries.enter.set(lane, one.enter);
        entries.leave.set(lane, one.leave);
        entries.face.set(lane, int32_t(one.face));
        entries.found |= MaskOf<Lanes<T, n>>::of_bits(1u << lane);
    });
    return entries;
}

/// The faces by which rays inside a convex solid do not leave: those on which they start.
template <class E, class T, int n>
CISTULA_INLINE IndexOf<Lanes<T, n>> faces_left(const LaneScene<T>& scene, uint32_t index,
                                               const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray,
                                               const MaskOf<Lanes<T, n>>& beside) {
    using Index = IndexOf<Lanes<T, n>>;
    const auto own = ray.from_solid == int(index);
    Index left = select(own, ray.from_face, Index(-1));
    if constexpr (E::has(effect_contacts))
        for_each_value(beside & !own, ray.from_plane, [&](uint32_t plane, const auto& same) {
            assign_where(same, left, Index(int(face_on(scene, scene.solids[index], plane))));
        });
    return left;
}

/// The rays that cross a mesh from the wrong side, or have passed such crossings: their counts are neither 0 nor 1.
template <class Real, class Media>
CISTULA_INLINE MaskOf<Real> is_miscounted(const Ray<Real, Media>& ray, const Hit<Real>& hit) {
    const MaskOf<Real> is_inside = ray.media.contains(key_solid(hit.key));
    return (hit.wrong_side_t <= hit.t) | (is_kind(hit.key, CrossingKind::enter) & is_inside) |
           (is_kind(hit.key, CrossingKind::leave) & !is_inside);
}

/// Finds the events of hits where `active` holds (surface_event.h), and returns the rays whose media lanes cannot hold.
/// Crossings that share a plane are gathered lane by lane.
template <class E, class T, int n>
CISTULA_INLINE MaskOf<Lanes<T, n>> resolve_event(const LaneScene<T>& scene,
                                                 const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray,
                                                 const Hit<Lanes<T, n>>& hit, const MaskOf<Lanes<T, n>>& active,
                                                 SurfaceEvent<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& event) {
    MaskOf<Lanes<T, n>> strays = false;
    event.begin(ray, hit);
    if constexpr (E::has(effect_transmission | effect_insides))  // else no ray goes on behind a crossing
    {
        if (scene.meshes.any) strays = active & is_miscounted(ray, hit);
        if (scene.named) strays |= active & !event.fits;
    }
    const auto gather = [&](const MaskOf<Lanes<T, n>>& several) {
        for_each_lane(several, [&](int lane) {
            if (!gather_in_lane(scene, ray, hit, lane, event)) strays |= MaskOf<Lanes<T, n>>::of_bits(1u << lane);
        });
    };
    if constexpr (E::has(effect_spheres))
        if (scene.kin.any)
            gather(active & !strays & !is_kind(hit.key, CrossingKind::sheet) & among(scene.kin, key_solid(hit.key)));
    if constexpr (E::has(effect_contacts)) {
        using Index = IndexOf<Lanes<T, n>>;
        if (scene.shared_planes.empty()) return strays;
        const auto bodies = active & !strays & !is_kind(hit.key, CrossingKind::sheet);
        if (!any(bodies)) return strays;
        const Index planes = planes_of<Lanes<T, n>>(scene, key_solid(hit.key), key_face(hit.key));
        gather(bodies & (planes != Index(ScalarOf<Index>(no_plane))));
    }
    return strays;
}

/// A lane of a hit as that of a single ray.
template <class T, int n>
CISTULA_INLINE Hit<T> lane_of(const Hit<Lanes<T, n>>& hit, int lane) {
    Hit<T> one;
    one.t = hit.t[lane];
    one.key = KeyFormat<Lanes<T, n>>::of_lane(hit.key, lane);
    one.u = hit.u[lane];
    one.v = hit.v[lane];
    one.slot = uint32_t(hit.slot[lane]);
    one.enters = (hit.enters.bits() >> lane & 1u) != 0;
    return one;
}

/// Collects the crossings at a lane's hit (gather_shared). False if the media beyond do not fit a lane.
template <class T, int n>
CISTULA_NOINLINE bool gather_in_lane(const LaneScene<T>& scene, const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray,
                                     const Hit<Lanes<T, n>>& hit, int lane,
                                     SurfaceEvent<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& event) {
    using Keys = KeyFormat<Lanes<T, n>>;
    const SceneView<T>& view = scene;
    const Ray<T> one = lane_of<InteriorList>(ray, lane);
    SurfaceEvent<T> gathered;
    gathered.begin(one, lane_of(hit, lane));
    gather_shared(view, SingleIntersector<T>{scene}, one, gathered);
    if (!InteriorSet::holds(gathered.beyond, scene.named)) return false;
    const auto only = MaskOf<Lanes<T, n>>::of_bits(1u << lane);
    const Hit<T>& shaded = gathered.hit;
    event.hit.take(only, shaded.t, Keys::of_single(shaded.key), shaded.u, shaded.v, int32_t(shaded.slot),
                   shaded.enters);
    event.taken[0].t.set(lane, gathered.last().t);
    event.taken[0].key.set(lane, Keys::of_single(gathered.last().key));
    event.beyond.bits.set(lane, int32_t(InteriorSet::of(gathered.beyond, scene.named).bits));
    assign_where(only, event.fits, MaskOf<Lanes<T, n>>(gathered.fits));
    assign_where(only, event.changes, MaskOf<Lanes<T, n>>(gathered.changes));
    return true;
}

/// The farthest that a start may be from the hit, in units of a plane's slack: beyond all pushes off near planes.
template <class T>
inline constexpr T farthest_start = T(64) * near_start<T>;

/// Hits of `active` near shared planes where a mesh with a face there may be around new rays (ContactStart).
template <class T, int n>
CISTULA_NOINLINE MaskOf<Lanes<T, n>> find_meshes_at_starts(const LaneScene<T>& scene, const Vec3<Lanes<T, n>>& met,
                                                           const IndexOf<Lanes<T, n>>& solids,
                                                           const MaskOf<Lanes<T, n>>& active) {
    using Real = Lanes<T, n>;
    constexpr T start_reach = T(0x1p-8);  // of squares of distances, for starts that near the hits
    MaskOf<Real> found = false;
    for_each_value(active, solids, [&](uint32_t index, const MaskOf<Real>& same) {
        const Solid& solid = scene.solids[index];
        for (uint32_t i = 0; i < solid.near_count; ++i) {
            const SharedPlane<T>& plane = scene.shared_planes[scene.near_planes[solid.first_near + i]];
            if (plane.mesh_count == 0) continue;
            const MaskOf<Real> near =
                same & !(magnitude(distance_from(plane, met)) > Real(farthest_start<T> * plane.slack));
            for (uint32_t m = 0; m < plane.mesh_count && any(near); ++m) {
                const uint32_t mesh = scene.plane_solids[plane.first_solid + plane.solid_count + m];
                const BoundingSphere<T> sphere = BoundingSphere<T>::of(scene.solids[mesh]);
                const Vec3<Real> off = met - spread<Real>(sphere.center);
                found |= near & !(dot(off, off) > Real(sphere.padded_square + start_reach));
            }
        }
    });
    return found;
}

/// Hits of `active` on balls from which new rays know more than lanes hold (BallStart).
template <class T, int n>
CISTULA_NOINLINE MaskOf<Lanes<T, n>> find_ball_starts(const LaneScene<T>& scene, const Vec3<Lanes<T, n>>& origin,
                                                      const Vec3<Lanes<T, n>>& direction, const Hit<Lanes<T, n>>& hit,
                                                      const MaskOf<Lanes<T, n>>& active) {
    using Real = Lanes<T, n>;
    MaskOf<Real> found = false;
    const Vec3<Real> met = along(origin, hit.t, direction);
    for_each_value(active, key_solid(hit.key), [&](uint32_t index, const MaskOf<Real>& same) {
        const Ball<T>& ball = scene.balls[scene.solids[index].first_slab];
        if (ball.near_meshes != 0) found |= same;
        for (uint32_t i = 0; i < ball.plane_count; ++i) {
            const BallPlane<T>& plane = scene.ball_planes[scene.near_planes[ball.first_plane + i]];
            const Real off = dot(spread<Real>(plane.normal), met) - Real(plane.offset);
            found |= same & !(magnitude(off) > Real(2 * incidence<T> * scene.extent));  // the start is a little off
        }
    });
    return found;
}

/// Hits of `active` from which new rays may have to count the meshes around them (count_meshes), know their sides of
/// sheets at balls, or may be inside more solids than lanes can name, and perhaps others.
template <class E, class T, int n>
CISTULA_INLINE MaskOf<Lanes<T, n>> meshes_at_starts(const LaneScene<T>& scene,
                                                    const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray,
                                                    const Hit<Lanes<T, n>>& hit, const MaskOf<Lanes<T, n>>& active) {
    MaskOf<Lanes<T, n>> found = false;
    if constexpr (E::has(effect_spheres))
        if (scene.from_balls.any) {
            const auto at_balls =
                active & !is_kind(hit.key, CrossingKind::sheet) & among(scene.from_balls, key_solid(hit.key));
            if (any(at_balls)) found = find_ball_starts(scene, ray.origin, ray.direction, hit, at_balls);
        }
    if constexpr (E::has(effect_contacts))
        if (!scene.shared_planes.empty()) {
            if (scene.meshes.any)
                found |=
                    find_meshes_at_starts(scene, along(ray.origin, hit.t, ray.direction), key_solid(hit.key), active);
            if (scene.named)  // of a ray inside several solids, starts may be inside too many
                for_each_lane(active & !found & !ray.media.empty(), [&](int lane) {
                    if (ray.media.of(lane).count() > 1) found |= MaskOf<Lanes<T, n>>::of_bits(1u << lane);
                });
        }
    return found;
}

/// Corrects the start of a lane's ray (start_at_contact).
template <class T, int n>
CISTULA_NOINLINE void correct_lane(const LaneScene<T>& scene, const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& parent,
                                   const Vec3<Lanes<T, n>>& normal, bool beyond, int lane, Vec3<Lanes<T, n>>& origin,
                                   LaneMedia<Lanes<T, n>>& media) {
    const SceneView<T>& view = scene;
    const SingleIntersector<T> intersector{scene};
    const Ray<T> one = lane_of<InteriorList>(parent, lane);
    SurfaceEvent<T> event;  // with all crossings, of which lanes keep the last
    resolve_event<Effects<all_effects>>(view, intersector, one, intersector.closest(one), event);
    Vec3<T> start = lane_of(origin, lane);
    InteriorList around = media.of(lane).list();
    start_at_contact(view, one, event, lane_of(normal, lane), beyond, start, around);
    for (int axis = 0; axis < 3; ++axis) origin[axis].set(lane, start[axis]);
    media.bits.set(lane, int32_t(InteriorSet::of(around, scene.named).bits));
}

/// Takes out of media the convex solids with a face on a shared plane that lie on its other side than rays that start
/// there, above it where `up` holds.
template <class T, int n>
CISTULA_INLINE void leave_bodies(const LaneScene<T>& scene, uint32_t plane, const MaskOf<Lanes<T, n>>& up,
                                 const MaskOf<Lanes<T, n>>& active, LaneMedia<Lanes<T, n>>& media) {
    using Index = IndexOf<Lanes<T, n>>;
    if (!scene.named) {
        const PlaneBodies& bodies = scene.plane_bodies[plane];
        const Index beside = select(up, Index(int(bodies.below)), Index(int(bodies.above)));
        return assign_where(active, media.bits, media.bits & (beside ^ Index(-1)));
    }
    for_each_lane(active & !media.empty(), [&](int lane) {
        const int other_side = (up.bits() >> lane & 1u) != 0 ? -1 : 1;
        const InteriorSet left =
            media.of(lane).among([&](uint32_t i) { return inner_side(scene, i, plane) != other_side; });
        media.bits.set(lane, int32_t(left.bits));
    });
}

/// Corrects the origins and the media of rays that start at hits where `active` holds (start_at_contact). Starts near
/// one plane alone are lifted off it at once, others lane by lane.
template <class E, class T, int n>
CISTULA_INLINE void correct_starts(const LaneScene<T>& scene, const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& parent,
                                   const SurfaceEvent<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& event,
                                   const Vec3<Lanes<T, n>>& normal, bool beyond, const MaskOf<Lanes<T, n>>& active,
                                   Vec3<Lanes<T, n>>& origin, LaneMedia<Lanes<T, n>>& media) {
    if constexpr (E::has(effect_contacts)) {
        using Real = Lanes<T, n>;
        using Index = IndexOf<Real>;
        if (scene.shared_planes.empty()) return;
        const Index solids = key_solid(event.hit.key);
        const Index own = planes_of<Real>(scene, solids, key_face(event.hit.key));
        const Vec3<Real> toward = beyond ? -normal : normal;
        const Vec3<Real> met = along(parent.origin, event.hit.t, parent.direction);
        Vec3<Real> start = origin;
        LaneMedia<Real> around = media;
        for_each_value(active & (own != Index(ScalarOf<Index>(no_plane))), own, [&](uint32_t number, const auto& same) {
            const SharedPlane<T>& plane = scene.shared_planes[number];
            assign_where(same, start, along(met, Real(start_lift<T> * plane.slack), toward));
            const auto up = dot(toward, spread<Real>(plane.normal)) > Real(0);
            leave_bodies(scene, number, up, same, around);
        });
        MaskOf<Real> single = false;  // lanes that are done by themselves
        const Real factor = scene.disks.empty() ? Real(1) : far_factor(scene.extent, met);
        for_each_value(active, solids, [&](uint32_t index, const auto& same) {
            const Solid& solid = scene.solids[index];
            for (uint32_t i = 0; i < solid.near_count; ++i) {
                const uint32_t number = scene.near_planes[solid.first_near + i];
                const SharedPlane<T>& plane = scene.shared_planes[number];
                const Real near = Real(near_start<T>) * factor * Real(plane.slack);
                const auto far =
                    (magnitude(distance_from(plane, start)) > near) & (magnitude(distance_from(plane, met)) > near);
                single |= same & (own != Index(ScalarOf<Index>(number))) & !far;
            }
        });
        for_each_lane(single, [&](int lane) {
            Vec3<Real> corrected = origin;
            LaneMedia<Real> corrected_media = media;
            correct_lane(scene, parent, normal, beyond, lane, corrected, corrected_media);
            const auto only = MaskOf<Real>::of_bits(1u << lane);
            assign_where(only, start, corrected);
            around.take_where(only, corrected_media);
        });
        assign_where(active, origin, start);
        media.take_where(active, around);
    }
}

/// What lies between is asked lane by lane.
template <class T, int n>
struct SmoothStart<Lanes<T, n>> {
    using Real = Lanes<T, n>;
    Vec3<Real> place;
    MaskOf<Real> lifted = false;

    template <class Intersector>
    CISTULA_NOINLINE static SmoothStart of(const LaneScene<T>& scene, const Intersector&, const Hit<Real>& hit,
                                           const Surface<Real>& s, const Vec3<Real>& from,
                                           const LaneMedia<Real>& around, const MaskOf<Real>& active) {
        Vec3<Real> way(Real(0));
        MaskOf<Real> asked = false;
        for_each_value(active & s.smooth, hit.slot, [&](uint32_t slot, const MaskOf<Real>& same) {
            Vec3<T> corner[3];
            triangle_corners(scene, slot, corner);
            assign_where(same, way, bulge(corner, corner_normals(scene, slot), hit, s.point));
            if (scene.solids[scene.clusters[slot / cluster_lanes].solid].slab_count != 0) asked |= same;
        });
        const Real size = length(way);
        SmoothStart start{from, size > Real(least_lift<T> * scene.extent)};
        for_each_lane(start.lifted & asked, [&](int lane) {
            const uint64_t key = KeyFormat<Real>::of_lane(hit.key, lane);
            if (SmoothStart<T>::is_crossed(static_cast<const SceneView<T>&>(scene), SingleIntersector<T>{scene}, key,
                                           lane_of(from, lane), lane_of(way, lane), size[lane], around.of(lane).list()))
                start.lifted = start.lifted & !MaskOf<Real>::of_bits(1u << lane);
        });
        assign_where(start.lifted, start.place, from + way);
        return start;
    }
};

}  // namespace cistula
