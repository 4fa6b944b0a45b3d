// One ray's tree (Whitted 1980), without recursion: the lighter child is followed and the heavier one waits, so that a
// few entries hold any tree. Whatever is not followed goes into the ledger.
#pragma once

#include "cistula/absorption.h"
#include "cistula/interface.h"
#include "cistula/lighting.h"
#include "cistula/meeting.h"
#include "cistula/seen_light.h"

namespace cistula {

inline constexpr int largest_depth = 1024;
/// Faces that one ray may pass without shading or bending; more fail the render (flag_too_many_crossings).
inline constexpr int largest_crossings = 1 << 20;
/// The branch that is followed after the k-th push weighs at most 2^-k, and one under 2^-62 is dropped.
inline constexpr int branch_stack = 66;

/// Part of a tree that is still to be followed: `weight` times what `ray` sees.
template <class Real, class Media = MediaList>
struct Branch {
    Ray<Real, Media> ray;
    Vec3<Real> weight;
    int depth = 0;  // surfaces above it
    bool mirrored = false;
};

/// What the primary ray met first.
template <class Real>
struct FirstHit {
    bool anything = false;  // a surface or a seen light
    Hit<Real> hit;          // the surface, if it was one
    Vec3<Real> normal{Real(0)};
};

/// What a RayTree asks about branches that wait: whether somebody else takes them. Here nobody does.
struct KeepBranches {
    CISTULA_INLINE void shaded() {}
    template <class Branch>
    CISTULA_INLINE bool take(const Branch&) {
        return false;
    }
};

template <class Real, class E, class Intersector, class Taker = KeepBranches>
class RayTree {
  public:
    using Media = typename Intersector::Media;

    CISTULA_INLINE RayTree(const SceneView<Real>& scene, const Intersector& intersector, int depth,
                           PixelSums<Real>& sums, TreeRays& rays, Taker taker = {})
        : scene_(scene), intersector_(intersector), depth_(depth), sums_(sums), rays_(rays), taker_(taker) {}

    /// Adds all that the primary ray sees to the sums.
    CISTULA_INLINE FirstHit<Real> trace(const Ray<Real, Media>& primary) {
        Branch<Real, Media> branch{primary, Vec3<Real>(Real(1))};
        return walk(branch);
    }

    /// Goes on with a branch that another tree's taker took. What is taken depends on no order only where the budget of
    /// truncation is 0.
    CISTULA_INLINE void resume(Branch<Real, Media>& branch) {
        if (follow(branch)) walk(branch);
    }

  private:
    CISTULA_INLINE FirstHit<Real> walk(Branch<Real, Media>& branch) {
        FirstHit<Real> first;
        Meeting<Real, Media> meeting;
        Branch<Real, Media> pending[branch_stack];
        int count = 0;
        for (bool at_first = true;; at_first = false) {
            bool light = false;
            const bool surface = next_surface(branch, meeting, light);
            if (at_first) {
                first.anything = surface || light;
                if (surface) first.hit = meeting.hit, first.normal = normal_at(scene_, meeting.hit);
            }
            if (surface) {
                taker_.shaded();
                if (shade(branch, meeting, pending, count)) continue;
            }
            if (!pop(branch, pending, count)) return first;
        }
    }

    CISTULA_INLINE bool pop(Branch<Real, Media>& branch, const Branch<Real, Media>* pending, int& count) {
        while (count > 0) {
            --count;
            if (taker_.take(pending[count]) || !follow(pending[count])) continue;
            branch = pending[count];
            return true;
        }
        return false;
    }

    CISTULA_INLINE bool follow(const Branch<Real, Media>& branch) {
        if (!sums_.afford(branch.weight)) return false;
        ++(branch.mirrored ? rays_.reflected : rays_.transmitted);
        return true;
    }

    /// Straight on through a face.
    CISTULA_INLINE void pass(Ray<Real, Media>& ray, const Meeting<Real, Media>& meeting) {
        const Crossing<Real>& crossing = meeting.taken[0];
        const uint32_t solid = key_solid(crossing.key);
        Media media = meeting.beyond;
        if (Media::meshes && ray.fresh() && solid == ray.from_solid && scene_.solids[solid].kind == SolidKind::mesh)
            count_passed_over(ray, crossing, media);
        ray.media = media;
        ray.after = meeting.taken[meeting.count - 1];
    }

    /// A line that starts on a mesh takes its first crossing from the right side. Others of that mesh that rounding puts
    /// before it, at an edge that the line grazes, count all the same once it goes on straight.
    CISTULA_INLINE void count_passed_over(const Ray<Real, Media>& ray, const Crossing<Real>& crossing, Media& media) {
        Ray<Real, Media> probe = ray;
        probe.from_solid = no_solid;
        for (;;) {
            const Hit<Real> next = intersector_.closest(probe);
            if (!Crossing<Real>{next.t, next.key}.before(crossing.t, crossing.key)) return;
            const int change = media_change(key_kind(next.key));
            bool fits = true;
            if (key_solid(next.key) == ray.from_solid) fits = media.add(ray.from_solid, change);
            if (change != 0) fits &= probe.media.add(key_solid(next.key), change);
            if (!fits) sums_.flag(flag_media_overflow);
            probe.after = {next.t, next.key};
        }
    }

    /// A crossing with nothing to shade: inside a medium of higher priority, or of a clear face between equal media.
    CISTULA_INLINE bool invisible(const Ray<Real, Media>& ray, const Meeting<Real, Media>& meeting) {
        const uint32_t solid = key_solid(meeting.hit.key), medium = ray.media.medium();
        if (key_kind(meeting.hit.key) != CrossingKind::sheet && medium != no_solid && medium > solid) return true;
        if (!scene_.materials[scene_.solids[solid].material].clear) return false;
        if constexpr (E::has(effect_refraction)) return index_of(scene_, ray.media) == index_of(scene_, meeting.beyond);
        return true;
    }

    /// Goes on to the next face that has anything to shade. Otherwise adds the light or background that the ray ends on.
    CISTULA_INLINE bool next_surface(Branch<Real, Media>& branch, Meeting<Real, Media>& meeting, bool& light) {
        Absorption<E::has(effect_absorption)> absorption;
        absorption.begin(scene_, branch.ray.media, branch.ray.after.t);
        for (int crossings = 0;; ++crossings) {
            const Hit<Real> hit = intersector_.closest(branch.ray);
            if constexpr (E::has(effect_visible_lights)) {
                const SeenHit<Real> seen = closest_seen_light(scene_, branch.ray, hit.t);
                if (seen.light != no_light) {
                    light = true;
                    absorption.dim(scene_, branch.ray.media, seen.t, branch.weight);
                    sums_.add(branch.weight * scene_.seen_lights[seen.light].radiance);
                    return false;
                }
            }
            if (!hit.found()) {
                sums_.add(branch.weight * scene_.background);
                return false;
            }
            meet(scene_, intersector_, branch.ray, hit, meeting);
            if (!meeting.fits) sums_.flag(flag_media_overflow);
            if (!invisible(branch.ray, meeting)) {
                absorption.dim(scene_, branch.ray.media, meeting.hit.t, branch.weight);
                return true;
            }
            for (int i = 0; i < meeting.count; ++i) absorption.cross(scene_, meeting.taken[i].key, meeting.taken[i].t);
            pass(branch.ray, meeting);
            if (crossings == largest_crossings) {
                sums_.flag(flag_too_many_crossings);
                return false;
            }
        }
    }

    /// Adds a face's local light and replaces the branch by the lighter of its children; the heavier one is pushed. False
    /// if there is none to go on with.
    CISTULA_INLINE bool shade(Branch<Real, Media>& branch, const Meeting<Real, Media>& meeting, Branch<Real, Media>* pending, int& count) {
        const Hit<Real>& hit = meeting.hit;
        const Surface<Real> s = surface_at<Real, E>(scene_, branch.ray, hit);
        if (!is_finite(s.normal)) sums_.flag(flag_not_finite);
        const Material<Real>& m = *s.material;
        if (m.local > Real(0))
            add_local_light<Real, E>(scene_, intersector_, branch.ray, hit, s, branch.weight * m.local, sums_, rays_);
        if constexpr (!E::has(effect_reflection | effect_transmission)) return false;

        const Shares<Real> shares = split_at<Real, E>(scene_, m, branch.ray.direction, s.normal, branch.ray.media,
                                                      meeting.beyond, key_kind(hit.key) == CrossingKind::sheet);
        const Vec3<Real> mirrored = branch.weight * shares.reflection, through = branch.weight * shares.filter;
        // Sums over channels, so that a child that is not the heavier is at most half its parent.
        const Real mirrored_size = mirrored.x + mirrored.y + mirrored.z, through_size = through.x + through.y + through.z;
        const int depth = branch.depth + 1;
        if (depth >= depth_) {
            if (mirrored_size > Real(0)) sums_.cut(mirrored);
            if (through_size > Real(0)) sums_.cut(through);
            return false;
        }
        const bool both = mirrored_size > Real(0) && through_size > Real(0);
        const bool through_first = !(mirrored_size > Real(0)) || (both && through_size < mirrored_size);
        if (both) {
            if (count == branch_stack)
                sums_.flag(flag_stack_overflow);
            else
                become(pending[count++], branch, meeting, s, shares, !through_first, through_first ? mirrored : through);
        } else if (!(mirrored_size > Real(0)) && !(through_size > Real(0))) {
            return false;
        }
        become(branch, branch, meeting, s, shares, through_first, through_first ? through : mirrored);
        return follow(branch);
    }

    /// Makes `child` (which may be `parent` itself) the ray that goes through, or the mirrored one.
    CISTULA_INLINE void become(Branch<Real, Media>& child, const Branch<Real, Media>& parent, const Meeting<Real, Media>& meeting,
                               const Surface<Real>& s, const Shares<Real>& shares, bool goes_through,
                               const Vec3<Real>& weight) {
        child.depth = parent.depth + 1;
        child.weight = weight;
        child.mirrored = !goes_through;
        if (!goes_through) {
            child.ray =
                spawned(s.viewer_side, reflected(parent.ray.direction, s.normal), meeting.hit, parent.ray.media);
        } else if (shares.bends) {
            child.ray = spawned(s.far_side, shares.through, meeting.hit, meeting.beyond);
        } else {
            child.ray = parent.ray;
            pass(child.ray, meeting);
        }
    }

    const SceneView<Real>& scene_;
    const Intersector& intersector_;
    const int depth_;
    PixelSums<Real>& sums_;
    TreeRays& rays_;
    Taker taker_;
};

}  // namespace cistula
