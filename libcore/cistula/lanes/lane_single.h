// Branches that lanes cannot follow: those with a count of a mesh that is neither 0 nor 1, or from which new rays count
// the meshes around them at a contact. They are traced one after the other, with all that comes from them.
#pragma once

#include "cistula/lanes/lane_branch.h"
#include "cistula/lanes/lane_contact.h"
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

/// Traces a branch and all that comes from it, unless stopped, and adds to the sums and the counts. Compiled with all
/// effects only, once for a number type and for sums with and without layers: few branches need it.
template <class Real, class Sums, class First>
CISTULA_NOINLINE void trace_single(const LaneScene<ScalarOf<Real>>& scene, int depth, Branch<ScalarOf<Real>>& branch,
                                   Sums& sums, PixelRays& rays, const SingleFirstSeen<Real, First>& first,
                                   const StopQuestion& stopped) {
    using T = ScalarOf<Real>;
    using All = Effects<all_effects | (std::is_same_v<Sums, LayeredSums<T>> ? keeps_budget | fills_layers : 0)>;
    using Stack = StoppableStack<BranchStack<Branch<T>>, StopQuestion>;
    const SceneView<T>& view = scene;
    const SingleIntersector<T> intersector{view};
    typename Stack::Storage storage;
    Stack stack(storage, stopped);
    find_start_plane<All>(view, branch.ray);
    RayTree<T, All, SingleIntersector<T>, Stack>(view, intersector, depth, sums, rays, stack)
        .trace_branch(branch, first);
}

}  // namespace cistula
