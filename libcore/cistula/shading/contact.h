// Rays that start where bodies share a plane, or on balls: on which side of every plane near the start, and inside
// which solids (docs/rules.md, 11, lines 8 to 15; 14, lines 12 to 14). What the parent ray knows decides, not the
// rounded place of the start; of meshes, what lies ahead of it. And shadow rays of smooth meshes (17, line 8).
#pragma once

#include "cistula/geometry/disk.h"
#include "cistula/shading/surface_event.h"

namespace cistula {

/// Distances in units of a plane's slack: of a start from its plane, and within which another plane is near.
template <class Real>
inline constexpr Real start_lift = Real(8);
template <class Real>
inline constexpr Real near_start = Real(32);
template <class Real>
inline constexpr Real deep_inside = Real(16);

/// On which side of a shared plane a convex solid lies: 1 where the plane's normal points, -1 on the other side, 0 if
/// it has no face there.
template <class Real>
CISTULA_INLINE int inner_side(const SceneView<Real>& scene, uint32_t index, uint32_t plane) {
    const Solid& solid = scene.solids[index];
    if (solid.kind != SolidKind::convex) return 0;
    const uint32_t face = face_on(scene, solid, plane);
    if (face == no_face) return 0;
    const HalfSpace<Real> half = HalfSpace<Real>::of(scene.slabs[solid.first_slab + face / 2], face & 1u);
    return dot(half.normal, scene.shared_planes[plane].normal) > Real(0) ? -1 : 1;
}

/// The start of a ray from a surface event.
template <class Real, class Media>
class ContactStart {
  public:
    /// `beyond`: the ray goes through the face; else it stays on the viewer's side. `origin` and `media` are those of a
    /// start without contacts.
    CISTULA_INLINE ContactStart(const SceneView<Real>& scene, const Ray<Real, Media>& parent,
                                const SurfaceEvent<Real, Media>& event, const Vec3<Real>& normal, bool beyond,
                                Vec3<Real>& origin, Media& media)
        : scene_(scene),
          parent_(parent),
          event_(event),
          hit_(event.hit),
          solid_(scene.solids[key_solid(event.hit.key)]),
          inside_mesh_(solid_.kind == SolidKind::mesh && event.hit.enters == beyond),
          normal_(beyond ? -normal : normal),
          origin_(origin),
          media_(media) {}

    /// Whether meshes with faces near the start may be around it.
    CISTULA_INLINE bool find() {
        media_.drop_negative();
        const uint32_t own = plane_of_face(scene_, key_solid(hit_.key), key_face(hit_.key));
        const Vec3<Real> met = along(parent_.origin, hit_.t, parent_.direction);
        if (!scene_.disks.empty()) near_ = near_start<Real> * far_factor(scene_.extent, met);
        if (own != no_plane) {
            const SharedPlane<Real>& plane = scene_.shared_planes[own];
            look_for_meshes(plane);
            if (!inside_mesh_) origin_ = along(met, start_lift<Real> * plane.slack, normal_);
            drop_beyond(own, own_side(plane));
        }
        bool near = false;
        for (int round = 0; round < 2; ++round)  // a push off one plane may bring the start near another
            for (uint32_t i = 0; i < solid_.near_count; ++i) {
                const uint32_t plane = scene_.near_planes[solid_.first_near + i];
                if (plane != own) near |= leave_plane(plane, met);
            }
        if (own != no_plane && near) add_containing(own);
        return meshes_;
    }

  private:
    CISTULA_INLINE int own_side(const SharedPlane<Real>& plane) const {
        return dot(normal_, plane.normal) > Real(0) ? 1 : -1;
    }

    /// Moves the start off another plane if that is near, and removes the solids on its other side.
    CISTULA_INLINE bool leave_plane(uint32_t index, const Vec3<Real>& met) {
        const SharedPlane<Real>& plane = scene_.shared_planes[index];
        const Real near = near_ * plane.slack;
        const Real off = distance_from(plane, origin_);
        if (magnitude(off) > near && magnitude(distance_from(plane, met)) > near) return false;
        look_for_meshes(plane);
        const int side = side_of(index, plane);
        drop_beyond(index, side);
        if (off * Real(side) < near) origin_ = along(origin_, near * Real(side) - off, plane.normal);
        return true;
    }

    /// Notes whether a mesh with a face on a plane may be around the start.
    CISTULA_INLINE void look_for_meshes(const SharedPlane<Real>& plane) {
        for (uint32_t i = 0; i < plane.mesh_count && !meshes_; ++i) {
            const uint32_t mesh = scene_.plane_solids[plane.first_solid + plane.solid_count + i];
            const BoundingSphere<Real> sphere = BoundingSphere<Real>::of(scene_.solids[mesh]);
            const Vec3<Real> off = origin_ - sphere.center;
            meshes_ = !(dot(off, off) > sphere.padded_square);
        }
    }

    /// The side of a near plane on which the ray starts (line 11).
    CISTULA_INLINE int side_of(uint32_t index, const SharedPlane<Real>& plane) const {
        int side = 0;
        if (solid_.kind != SolidKind::convex && scene_.triangle_planes[key_face(hit_.key)] != index)
            side = side_of_triangle(plane);
        if (side == 0 && key_kind(hit_.key) != CrossingKind::sheet)
            side = inner_side(scene_, key_solid(hit_.key), index);
        for (int i = 0; i < event_.count && side == 0; ++i)
            if (key_kind(event_.taken[i].key) != CrossingKind::sheet)
                side = inner_side(scene_, key_solid(event_.taken[i].key), index);
        media_.for_each([&](uint32_t solid, int) {
            if (side == 0) side = inner_side(scene_, solid, index);
        });
        if (side != 0) return side;
        const Real slope = dot(plane.normal, parent_.direction);
        if (parent_.from_plane == index) return slope > Real(0) ? 1 : -1;
        if (magnitude(slope) < least_slope<Real>) return distance_from(plane, parent_.origin) > Real(0) ? 1 : -1;
        const Real time = plane_time(plane, parent_.origin, parent_.direction, Real(0));
        const bool ahead = time > hit_.t || (time == hit_.t && parent_.after.t < time);
        return ahead == (slope > Real(0)) ? -1 : 1;
    }

    /// The side on which all corners of the triangle that was hit lie, or all of the disk; if it lies in the plane
    /// itself, as a triangle beside one that shares the plane does, the ray's side of it; else 0.
    CISTULA_INLINE int side_of_triangle(const SharedPlane<Real>& plane) const {
        bool above = false;
        bool below = false;
        const auto look_at = [&](Real off) {
            above |= off > near_ * plane.slack;
            below |= off < -near_ * plane.slack;
        };
        if (is_disk(solid_)) {
            const Disk<Real>& disk = scene_.disks[solid_.first_slab];
            const Real slope = dot(scene_.shared_planes[disk.plane].normal, plane.normal);
            Real reach = square_root(disk.square * max_or_second(Real(1) - slope * slope, Real(0)));
            if (disk.is_endless()) {
                const Vec3<Real> line = cross(scene_.shared_planes[disk.plane].normal, plane.normal);
                reach = dot(line, line) > horizon<Real> * horizon<Real> ? RealTraits<Real>::infinity : Real(0);
            }
            const Real middle = distance_from(plane, disk.center);
            look_at(middle - reach), look_at(middle + reach);
        } else {
            Vec3<Real> corner[3];
            triangle_corners(scene_, hit_.slot, corner);
            for (int c = 0; c < 3; ++c) look_at(distance_from(plane, corner[c]));
        }
        if (above != below) return above ? 1 : -1;
        return !above && magnitude(dot(normal_, plane.normal)) > Real(0.5) ? own_side(plane) : 0;
    }

    /// Removes the solids that end at a plane, for a start on the other side of it (line 8).
    CISTULA_INLINE void drop_beyond(uint32_t plane, int side) {
        Media kept = media_;
        media_.for_each([&](uint32_t solid, int count) {
            if (inner_side(scene_, solid, plane) == -side) kept.add(solid, -count);
        });
        media_ = kept;
    }

    /// Adds the convex solids that begin at the start's plane and surely contain it (line 13).
    CISTULA_INLINE void add_containing(uint32_t own) {
        const SharedPlane<Real>& plane = scene_.shared_planes[own];
        for (uint32_t i = 0; i < plane.solid_count; ++i) {
            const uint32_t index = scene_.plane_solids[plane.first_solid + i];
            if (media_.contains(index) || inner_side(scene_, index, own) != own_side(plane)) continue;
            if (contains_start(scene_.solids[index], own, plane.slack)) media_.add(index, 1);
        }
    }

    CISTULA_INLINE bool contains_start(const Solid& solid, uint32_t own, Real slack) const {
        const uint32_t own_face = face_on(scene_, solid, own);
        for (uint32_t face = 0; face < 2 * solid.slab_count; ++face) {
            const Slab<Real>& slab = scene_.slabs[solid.first_slab + face / 2];
            if (face == own_face || (face % 2 == 0 && slab.low == -RealTraits<Real>::infinity)) continue;
            if (!(HalfSpace<Real>::of(slab, face & 1u).outside(origin_) < -deep_inside<Real> * slack)) return false;
        }
        return true;
    }

    const SceneView<Real>& scene_;
    const Ray<Real, Media>& parent_;
    const SurfaceEvent<Real, Media>& event_;
    const Hit<Real>& hit_;
    const Solid& solid_;
    const bool inside_mesh_;   // the ray starts inside the mesh that was hit: its start is the mesh's own
    const Vec3<Real> normal_;  // toward the ray's side
    Vec3<Real>& origin_;
    Media& media_;
    bool meshes_ = false;
    Real near_ = near_start<Real>;
};

/// Whether rays from a surface event may start near a shared plane.
template <class E, class Real, class Media, class Scene>
CISTULA_INLINE bool starts_at_contact(const Scene& scene, const SurfaceEvent<Real, Media>& event) {
    if constexpr (meets_contacts<E, Media>)
        return scene.solids[key_solid(event.hit.key)].near_count != 0;
    else
        return false;
}

/// Corrects the origin and the media of a ray from a surface event for which starts_at_contact() holds. True if the
/// meshes in them depend on the ray's direction (count_meshes).
template <class Real, class Media>
CISTULA_NOINLINE bool start_at_contact(const SceneView<Real>& scene, const Ray<Real, Media>& parent,
                                       const SurfaceEvent<Real, Media>& event, const Vec3<Real>& normal, bool beyond,
                                       Vec3<Real>& origin, Media& media) {
    return ContactStart<Real, Media>(scene, parent, event, normal, beyond, origin, media).find();
}
template <class Real, class Media>
CISTULA_INLINE bool start_at_contact(const ConstantScene<Real>&, const Ray<Real, Media>&,
                                     const SurfaceEvent<Real, Media>&, const Vec3<Real>&, bool, Vec3<Real>&, Media&) {
    return false;
}

/// Replaces the meshes in a ray's media by those that it leaves more often than it enters, ahead of its start
/// (docs/rules.md, 11, line 15); `all`: also by those that it enters more often, and the ray then takes their crossings
/// from either side. Not inlined: only rays near meshes at contacts and balls need it.
template <class Real, class Media, FindsHits<Real, Media> Intersector, class Scene>
CISTULA_NOINLINE void count_meshes(const Scene& scene, const Intersector& intersector, Ray<Real, Media>& ray,
                                   bool all = false) {
    Media ahead;
    Ray<Real, Media> probe = ray;
    probe.accept_both_sides();
    for (;;) {
        const Hit<Real> hit = unobserved(intersector).closest(probe);
        if (!hit.found()) break;
        const uint32_t solid = key_solid(hit.key);
        const int change = media_change(key_kind(hit.key));
        if (change != 0 && !probe.media.add(solid, change)) return;
        if (scene.solids[solid].kind == SolidKind::mesh && !ahead.add(solid, -change)) return;
        probe.after = {hit.t, hit.key};
    }
    Media counted = ray.media;
    ray.media.for_each([&](uint32_t solid, int count) {
        if (scene.solids[solid].kind == SolidKind::mesh) counted.add(solid, -count);
    });
    ahead.for_each([&](uint32_t solid, int count) {
        if (count > 0 || all) counted.add(solid, count);
    });
    ray.media = counted;
    if (all) ray.accept_both_sides();
}

/// What rays that start on a ball know beside the solids around them.
struct BallStart {
    BallSides sides;
    bool near_meshes = false;

    /// Sets up a ray that starts there, which must be complete otherwise.
    template <class Real, class Media, class Intersector, class Scene>
    CISTULA_INLINE void begin(const Scene& scene, const Intersector& intersector, Ray<Real, Media>& ray) const {
        if (sides.bits != 0) ray.from_face = sides.bits;
        if constexpr (Media::meshes)
            if (near_meshes) count_meshes(scene, intersector, ray, true);
    }
};

/// The side of a flat sheet's plane on which rays from a ball start, for a start within rounding of the plane: that of
/// the parent ray at the hit.
template <class Real, class Media, class Scene>
CISTULA_HD inline bool is_above(const Scene& scene, uint32_t number, Real off, const Ray<Real, Media>& parent, Real t) {
    const BallPlane<Real>& plane = scene.ball_planes[number];
    const Real slope = dot(plane.normal, parent.direction);
    if (magnitude(slope) < least_slope<Real>) return off > Real(0);
    const bool rises = slope > Real(0);
    const bool from_sheet = parent.from_solid != no_solid && is_sheet_near_ball(scene.solids[parent.from_solid]) &&
                            scene.solids[parent.from_solid].first_group == number + 1;
    if (from_sheet || (plane.shared != no_plane && parent.from_plane == plane.shared)) return rises;
    const Real at = plane_time(plane, parent.origin, parent.direction, Real(0));
    if (const int side = BallSides::at_start(scene, parent).of(number); side != 0)
        return (side > 0) != ((side > 0) != rises && max_or_second(at, parent.after.t) <= t);
    return (at <= t) == rises;
}

/// What rays from `start`, where a ray hits a ball, know beside the solids around them. A ball that only touches a
/// plane is on one side of it.
template <class Real, class Media, class Scene>
CISTULA_NOINLINE BallStart known_at_start(const Scene& scene, const Ball<Real>& ball, const Ray<Real, Media>& parent,
                                          Real t, Vec3<Real> start) {
    BallStart known{{}, ball.near_meshes != 0};
    for (uint32_t i = 0; i < ball.plane_count; ++i) {
        const uint32_t number = scene.near_planes[ball.first_plane + i];
        const BallPlane<Real>& plane = scene.ball_planes[number];
        const Real off = dot(plane.normal, start) - plane.offset;
        if (magnitude(off) > incidence<Real> * scene.extent) continue;
        known.sides.add(number, i < ball.touched_count ? dot(plane.normal, ball.center) > plane.offset
                                                       : is_above(scene, number, off, parent, t));
    }
    return known;
}
/// What rays from a hit know, if it is one on a ball.
template <class Real, class Media, class Scene>
CISTULA_INLINE BallStart ball_start(const Scene& scene, const Ray<Real, Media>& parent, const Hit<Real>& hit,
                                    const Vec3<Real>& start) {
    const Solid& solid = scene.solids[key_solid(hit.key)];
    if (!is_ball(solid)) return {};
    const Ball<Real>& ball = scene.balls[solid.first_slab];
    return ball.plane_count == 0 && ball.near_meshes == 0 ? BallStart()
                                                          : known_at_start(scene, ball, parent, hit.t, start);
}

/// Where shadow rays from a surface of a smooth mesh start: off the face by its bulge there, unless anything lies
/// between. (In lanes: lane_contact.h.)
template <class Real>
struct SmoothStart {
    Vec3<Real> place;
    MaskOf<Real> lifted = false;

    /// `from`: the start without the bulge; `around`: the solids there.
    template <class Intersector, class Media, class Scene>
    CISTULA_INLINE static SmoothStart of(const Scene& scene, const Intersector& intersector, const Hit<Real>& hit,
                                         const Surface<Real>& s, const Vec3<Real>& from, const Media& around, bool) {
        const Solid& solid = scene.solids[key_solid(hit.key)];
        Vec3<Real> corner[3];
        triangle_corners(scene, hit.slot, corner);
        const Vec3<Real> way = bulge(corner, corner_normals(scene, hit.slot), hit, s.point);
        const Real size = length(way);
        if (!(size > least_lift<Real> * scene.extent)) return {from};
        if (solid.slab_count != 0 && is_crossed(scene, intersector, hit.key, from, way, size, around)) return {from};
        return {from + way, true};
    }

    /// Whether anything lies on a way from the face of a hit, of whatever side.
    template <class Scene, class Intersector, class Media>
    CISTULA_NOINLINE static bool is_crossed(const Scene& scene, const Intersector& intersector, uint64_t key,
                                            Vec3<Real> from, Vec3<Real> way, Real size, Media around) {
        Ray<Real, Media> ray;
        ray.origin = from;
        ray.direction = way / size;
        ray.from_solid = key_solid(key);
        ray.from_face = key_face(key);
        ray.media = around;
        find_start_plane<Effects<all_effects>>(scene, ray);
        ray.accept_both_sides();
        return unobserved(intersector).closest(ray).t < size;
    }
};

}  // namespace cistula
