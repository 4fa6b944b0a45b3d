// Branches that lanes cannot follow: those with a count of a mesh that is neither 0 nor 1, or from which new rays count
// the meshes around them at a contact. They are traced one after the other, with all that comes from them.
#pragma once

#include "cistula/adaptive/path_hash.h"
#include "cistula/lanes/lane_branch.h"
#include "cistula/lanes/lane_contact.h"
#include "cistula/lanes/lane_pixel.h"
#include "cistula/lights/visible_light.h"
#include "cistula/transport/ray_tree.h"

namespace cistula {

/// Whether the render was stopped, asked of a callable of any type.
struct StopQuestion {
    const void* of;
    bool (*ask)(const void*);

    template <class Stopped>
    static StopQuestion by(const Stopped& stopped) {
        return {&stopped, [](const void* of) { return (*static_cast<const Stopped*>(of))(); }};
    }
    bool operator()() const { return ask(of); }
};

/// A lane of a branch as that of a single ray.
template <class T, int n, class Weight>
Branch<T> single_branch(const LaneBranch<Lanes<T, n>, LaneMedia<Lanes<T, n>>, Weight>& branch, int lane) {
    Branch<T> one;
    one.ray = lane_of<InteriorList>(branch.ray, lane);
    for (int c = 0; c < 3; ++c) one.weight[c] = channel(branch.weight, c)[lane];
    one.depth = branch.depth;
    one.mirrored = branch.mirrored;
    return one;
}

/// What a single ray meets first, reported to a LaneFirstSeen as a lane of its register.
template <class Real, class First>
struct SingleFirstSeen {
    using T = ScalarOf<Real>;
    const LaneScene<T>& scene;
    const First& first;
    const int lane;

    CISTULA_INLINE void surface(const Hit<T>& hit, const Surface<T>& s) const {
        Hit<Real> hits;
        hits.t = hit.t;
        hits.key = KeyOf<Real>(KeyFormat<Real>::of_single(hit.key));
        hits.u = hit.u;
        hits.v = hit.v;
        hits.slot = int32_t(hit.slot);
        hits.enters = hit.enters;
        Surface<Real> surfaces;
        surfaces.point = spread<Real>(s.point);
        surfaces.normal = spread<Real>(s.normal);
        surfaces.shading = spread<Real>(s.shading);
        surfaces.viewer_side = spread<Real>(s.viewer_side);
        surfaces.color = spread<Real>(s.color);
        surfaces.material.all = scene.materials.data;
        surfaces.material.number = int32_t(s.material);
        first.surface(hits, surfaces, only());
    }
    template <class Scene>
    CISTULA_INLINE void light(const Scene&, const VisibleLightHit<T>& hit, const Ray<T>& ray) const {
        VisibleLightHit<Real> hits;
        hits.t = hit.t;
        hits.light = int32_t(hit.light);
        Ray<Real, LaneMedia<Real>> rays;
        rays.origin = spread<Real>(ray.origin);
        rays.direction = spread<Real>(ray.direction);
        first.light(scene, hits, rays, only());
    }

  private:
    CISTULA_INLINE MaskOf<Real> only() const { return MaskOf<Real>::of_bits(1u << lane); }
};

template <class Real>
CISTULA_INLINE uint32_t compiled_number(const SingleIntersector<Real>& intersector, uint32_t solid) {
    return solid == no_solid ? no_solid : intersector.scene.numbers[solid];
}
template <class Real>
CISTULA_INLINE uint64_t compiled_key(const SingleIntersector<Real>& intersector, uint64_t key) {
    return key == no_key ? no_key : renumbered(key, intersector.scene.numbers.data);
}

/// A stack of branches of a sample that is rendered by itself: counts them, and ends a tree that is too large.
template <class Inner, class Real>
class SampleStack {
  public:
    /// `significant`: the least throughput of branches that count in the hash; `adaptive`: the frame has a target.
    SampleStack(Inner& inner, LanePixel& pixel, PathHash& hash, Real significant, bool adaptive)
        : inner_(inner), pixel_(pixel), hash_(hash), significant_(significant), adaptive_(adaptive) {}

    template <class Entry>
    CISTULA_INLINE bool push(const Entry& branch) {
        return inner_.push(branch);
    }
    template <class Entry>
    CISTULA_INLINE bool pop(Entry& branch) {
        if (!inner_.pop(branch)) return false;
        ++pixel_.branches;
        begin(branch);
        if (!pixel_.is_too_large(adaptive_)) return true;
        clear();
        return false;
    }
    /// Begins with a branch.
    template <class Entry>
    CISTULA_INLINE void begin(const Entry& branch) {
        hash_.counts = adaptive_ && largest_component(branch.weight) >= significant_;
    }
    CISTULA_INLINE void clear() { inner_.clear(); }
    CISTULA_INLINE bool stopped() const { return inner_.stopped(); }

  private:
    Inner& inner_;
    LanePixel& pixel_;
    PathHash& hash_;
    const Real significant_;
    const bool adaptive_;
};

/// Traces a branch and all that comes from it, unless stopped, and adds to the sums and the counts. E: all effects, of
/// frames with or without layers or a budget; few branches need it.
template <class E, class Real, class Intersector, class Stack, class First>
CISTULA_NOINLINE void trace_single(const LaneScene<Real>& scene, const Intersector& intersector, int depth,
                                   Branch<Real>& branch, SumsOf<Real, E>& sums, PixelRays& rays, Stack& stack,
                                   const First& first) {
    const SceneView<Real>& view = scene;
    find_start_plane<OnlyEffects<E>>(view, branch.ray);
    RayTree<Real, E, Intersector, Stack>(view, intersector, depth, sums, rays, stack).trace_branch(branch, first);
}

}  // namespace cistula
