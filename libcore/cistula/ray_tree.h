// One ray's tree (Whitted 1980), without recursion: the lighter child is followed and the heavier one waits, so that a
// few entries hold any tree. Whatever is not followed goes into the ledger.
#pragma once

#include "cistula/absorption.h"
#include "cistula/interface.h"
#include "cistula/lighting.h"
#include "cistula/seen_light.h"

namespace cistula {

inline constexpr int largest_depth = 1024;
/// Faces that one ray may pass without shading or bending; more fail the render (flag_too_many_crossings).
inline constexpr int largest_crossings = 1 << 20;
/// Every pending branch weighs at most half of the one pushed before it, and one under 2^-62 is dropped.
inline constexpr int branch_stack = 66;

/// Part of a tree that is still to be followed: `weight` times what `ray` sees.
template <class Real>
struct Branch {
    Ray<Real> ray;
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

template <class Real, class E, class Intersector>
class RayTree {
  public:
    CISTULA_INLINE RayTree(const SceneView<Real>& scene, const Intersector& intersector, int depth,
                           PixelSums<Real>& sums, RayCounts& rays)
        : scene_(scene), intersector_(intersector), depth_(depth), sums_(sums), rays_(rays) {}

    /// Adds all that the primary ray sees to the sums.
    CISTULA_HD FirstHit<Real> trace(const Ray<Real>& primary) {
        FirstHit<Real> first;
        Branch<Real> branch{primary, Vec3<Real>(Real(1))};
        Hit<Real> hit;
        const bool surface = next_surface(branch, hit, first.anything);
        if (!surface) return first;
        first.anything = true;
        first.hit = hit;
        first.normal = surface_at<Real, Effects<0>>(scene_, branch.ray, hit).normal;
        Branch<Real> pending[branch_stack];
        int count = 0;
        while (shade(branch, hit, pending, count) || pop(branch, pending, count)) {
            bool light = false;
            while (!next_surface(branch, hit, light))
                if (!pop(branch, pending, count)) return first;
        }
        return first;
    }

  private:
    CISTULA_INLINE bool pop(Branch<Real>& branch, const Branch<Real>* pending, int& count) {
        while (count > 0) {
            --count;
            if (!follow(pending[count])) continue;
            branch = pending[count];
            return true;
        }
        return false;
    }

    CISTULA_INLINE bool follow(const Branch<Real>& branch) {
        if (!sums_.afford(branch.weight)) return false;
        ++(branch.mirrored ? rays_.reflected : rays_.transmitted);
        return true;
    }

    CISTULA_INLINE void change_media(MediaList& media, uint64_t key) {
        const CrossingKind kind = key_kind(key);
        if (kind != CrossingKind::sheet && !media.add(key_solid(key), kind == CrossingKind::enter ? 1 : -1))
            sums_.flag(flag_media_overflow);
    }

    /// Straight on through a face.
    CISTULA_INLINE void pass(Ray<Real>& ray, const Hit<Real>& hit) {
        const uint32_t solid = key_solid(hit.key);
        if (ray.fresh() && solid == ray.from_solid && scene_.solids[solid].kind == SolidKind::mesh)
            count_passed_over(ray, hit);
        change_media(ray.media, hit.key);
        ray.after = {hit.t, hit.key};
    }

    /// A line that starts on a mesh takes its first crossing from the right side. Others of that mesh that rounding puts
    /// before it, at an edge that the line grazes, count all the same once it goes on straight.
    CISTULA_INLINE void count_passed_over(Ray<Real>& ray, const Hit<Real>& hit) {
        Ray<Real> probe = ray;
        probe.from_solid = no_solid;
        for (;;) {
            const Hit<Real> next = intersector_.closest(probe);
            if (!Crossing<Real>{next.t, next.key}.before(hit.t, hit.key)) return;
            if (key_solid(next.key) == ray.from_solid) change_media(ray.media, next.key);
            change_media(probe.media, next.key);
            probe.after = {next.t, next.key};
        }
    }

    /// A crossing with nothing to shade: inside a medium of higher priority, or of a clear face between equal media.
    CISTULA_INLINE bool invisible(const Ray<Real>& ray, const Hit<Real>& hit) {
        const uint32_t solid = key_solid(hit.key), medium = ray.media.medium();
        if (key_kind(hit.key) != CrossingKind::sheet && medium != no_solid && medium > solid) return true;
        if (!scene_.materials[scene_.solids[solid].material].clear) return false;
        if constexpr (E::has(effect_refraction)) {
            MediaList beyond = ray.media;
            change_media(beyond, hit.key);
            return index_of(scene_, ray.media) == index_of(scene_, beyond);
        }
        return true;
    }

    /// Goes on to the next face that has anything to shade. Otherwise adds the light or background that the ray ends on.
    CISTULA_INLINE bool next_surface(Branch<Real>& branch, Hit<Real>& hit, bool& light) {
        Absorption<E::has(effect_absorption)> absorption;
        absorption.begin(scene_, branch.ray.media, branch.ray.after.t);
        for (int crossings = 0;; ++crossings) {
            hit = intersector_.closest(branch.ray);
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
            if (!invisible(branch.ray, hit)) {
                absorption.dim(scene_, branch.ray.media, hit.t, branch.weight);
                return true;
            }
            absorption.cross(scene_, hit.key, hit.t);
            pass(branch.ray, hit);
            if (crossings == largest_crossings) {
                sums_.flag(flag_too_many_crossings);
                return false;
            }
        }
    }

    /// Adds a face's local light and replaces the branch by the lighter of its children; the heavier one is pushed. False
    /// if there is none to go on with.
    CISTULA_INLINE bool shade(Branch<Real>& branch, const Hit<Real>& hit, Branch<Real>* pending, int& count) {
        const Surface<Real> s = surface_at<Real, E>(scene_, branch.ray, hit);
        const Material<Real>& m = *s.material;
        if (m.local > Real(0))
            add_local_light<Real, E>(scene_, intersector_, branch.ray, hit, s, branch.weight * m.local, sums_, rays_);
        if constexpr (!E::has(effect_reflection | effect_transmission)) return false;

        MediaList beyond = branch.ray.media;
        if constexpr (E::has(effect_transmission)) change_media(beyond, hit.key);
        const Shares<Real> shares =
            split_at<Real, E>(scene_, m, branch.ray.direction, s.normal, branch.ray.media, beyond);
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
                become(pending[count++], branch, hit, s, shares, beyond, !through_first, through_first ? mirrored : through);
        } else if (!(mirrored_size > Real(0)) && !(through_size > Real(0))) {
            return false;
        }
        become(branch, branch, hit, s, shares, beyond, through_first, through_first ? through : mirrored);
        return follow(branch);
    }

    /// Makes `child` (which may be `parent` itself) the ray that goes through, or the mirrored one.
    CISTULA_INLINE void become(Branch<Real>& child, const Branch<Real>& parent, const Hit<Real>& hit,
                               const Surface<Real>& s, const Shares<Real>& shares, const MediaList& beyond,
                               bool goes_through, const Vec3<Real>& weight) {
        child.depth = parent.depth + 1;
        child.weight = weight;
        child.mirrored = !goes_through;
        if (!goes_through) {
            child.ray = spawned(s.viewer_side, reflected(parent.ray.direction, s.normal), hit, parent.ray.media);
            return;
        }
        if (!shares.bends) {
            child.ray = parent.ray;
            pass(child.ray, hit);
            return;
        }
        Ray<Real> bent = spawned(s.far_side, shares.through, hit, beyond);
        skip_coincident(parent.ray, hit, bent);
        child.ray = bent;
    }

    /// A bent ray starts a little beyond the face, perhaps beyond faces of other meshes that touch it there: those count
    /// as crossed. (Convex solids need no such care; their state decides.)
    CISTULA_INLINE void skip_coincident(const Ray<Real>& straight, const Hit<Real>& hit, Ray<Real>& bent) {
        bool other_mesh = false;
        for (uint32_t i = 0; i < bent.media.size; ++i) {
            const uint32_t solid = MediaList::solid_of(bent.media.entries[i]);
            other_mesh |= solid != key_solid(hit.key) && scene_.solids[solid].kind == SolidKind::mesh;
        }
        if (!other_mesh) return;
        const Real reach = hit.t + Real(16) * RealTraits<Real>::unit * scene_.extent;
        Ray<Real> ahead = straight;
        pass(ahead, hit);
        for (int i = 0; i < MediaList::capacity; ++i) {
            const Hit<Real> next = intersector_.closest(ahead);
            if (!(next.t <= reach)) return;
            const uint32_t solid = key_solid(next.key);
            if (solid != key_solid(hit.key) && scene_.solids[solid].kind == SolidKind::mesh)
                change_media(bent.media, next.key);
            pass(ahead, next);
        }
    }

    const SceneView<Real>& scene_;
    const Intersector& intersector_;
    const int depth_;
    PixelSums<Real>& sums_;
    RayCounts& rays_;
};

}  // namespace cistula
