// Whitted's ray tree (1980) without recursion: the lighter child is followed and the heavier one waits on a stack. What
// is not followed is added to the ledger.
#pragma once

#include <concepts>

#include "cistula/shading/lighting.h"
#include "cistula/transport/branch_stack.h"
#include "cistula/transport/layered_sums.h"
#include "cistula/transport/next_surface.h"

namespace cistula {

inline constexpr int largest_depth = 1024;
/// The number of branches between two checks whether the render was stopped.
inline constexpr uint32_t turns_between_stops = 64;

/// What finds a ray's next crossing after ray.after, and the share of light that reaches a shadow ray's origin; of rays
/// in lanes, where a mask holds.
template <class I, class Real, class E>
concept Intersects = requires(const I& intersector, const Ray<Real, typename I::Media>& ray,
                              const ShadowRay<Real, typename I::Media>& shadow) {
    typename I::Scene;
    { intersector.template closest<E>(ray) } -> std::same_as<Hit<Real>>;
    { intersector.template transmittance<E>(shadow) } -> std::same_as<Throughput<Real, E>>;
}
|| (in_lanes<Real> && requires(const I& intersector, const Ray<Real, typename I::Media>& ray,
                               const ShadowRay<Real, typename I::Media>& shadow, const MaskOf<Real>& active) {
    typename I::Scene;
    { intersector.template closest<E>(ray, active) } -> std::same_as<Hit<Real>>;
    { intersector.template transmittance<E>(shadow, active) } -> std::same_as<Throughput<Real, E>>;
});

/// What holds a tree's branches that are still to be followed, the latest first; of branches in lanes, in any order. A
/// push that has no room and a pop that has no branch return false.
template <class S, class Real, class Entry>
concept StacksBranches = requires(S& stack, const Entry& pushed, Entry& popped) {
    { stack.push(pushed) } -> std::same_as<bool>;
    { stack.pop(popped) } -> std::same_as<bool>;
    { stack.stopped() } -> std::same_as<bool>;  // whether the tree is to end early
    stack.clear();
}
|| (in_lanes<Real> &&
    requires(S & stack, const Entry& pushed, const MaskOf<Real>& active) { stack.push(pushed, active); });

/// What is told of the first hit of a sample: a surface, or a visible light; in lanes of many, where a mask holds.
template <class F, class Real, class E, class Scene, class Media, class... Mask>
concept SeesFirst = requires(const F& first, const Hit<Real>& hit, const Surface<Real>& surface,
                             const Mask&... active) {
    first.surface(hit, surface, active...);
}
&&(!E::has(effect_visible_lights) ||
   requires(const F& first, const Scene& scene, const VisibleLightHit<Real>& light, const Ray<Real, Media>& ray,
            const Mask&... active) { first.light(scene, light, ray, active...); });

template <class Real, class E, Intersects<Real, E> Intersector,
          StacksBranches<Real, BranchOf<Real, E, typename Intersector::Media>> Stack, class Rays = PixelRays>
class RayTree {
  public:
    using Sums = SumsOf<Real, E>;
    using Media = typename Intersector::Media;
    using Scene = typename Intersector::Scene;
    using Weight = Throughput<Real, E>;
    using Entry = BranchOf<Real, E, Media>;
    using Only = OnlyEffects<E>;

    /// `depth`: maximum number of surfaces on a path.
    CISTULA_INLINE RayTree(const Scene& scene, const Intersector& intersector, int depth, Sums& sums, Rays& rays,
                           Stack& stack)
        : scene_(scene),
          intersector_(intersector),
          line_(scene, intersector, depth, sums),
          depth_(depth),
          sums_(sums),
          rays_(rays),
          stack_(stack) {}

    /// Traces the tree of a primary ray and adds what it sees to the sums.
    template <SeesFirst<Real, E, Scene, Media> First>
    CISTULA_INLINE void trace(const Ray<Real, Media>& primary, const First& first) {
        Entry branch;
        branch.ray = primary;
        bool at_first = true;
        uint32_t turns = 0;
        do {
            // All lanes of a warp check in the same turn: checks at different times would make the warp diverge.
            if (++turns % turns_between_stops == 0 && stack_.stopped()) return stack_.clear();
            if constexpr (!E::has(effect_insides)) branch.ray.media = Media();
            // Declared inside the loop, like everything that only some rays need, so that it holds no registers
            // elsewhere.
            SurfaceEvent<Real, Media> event;
            VisibleLightHit<Real> light;
            if (line_.find(branch, event, light)) {
                const Surface<Real> s = surface_at<Real, Only>(scene_, branch.ray, event.hit);
                if (at_first) first.surface(event.hit, s);
                shade(branch, true, event, s);
            } else if constexpr (E::has(effect_visible_lights)) {
                if (at_first && light.found()) first.light(scene_, light, branch.ray);
            }
            at_first = false;
        } while (next(branch));
    }

    /// Traces a tree as trace() does, for threads that start together: those that meet a lit surface wait for its light
    /// until no fewer wait than search. For trees in which few surfaces are lit.
    template <SeesFirst<Real, E, Scene, Media> First>
    CISTULA_INLINE void trace_together(const Ray<Real, Media>& primary, const First& first) {
        static_assert(!E::has(keeps_budget | fills_layers), "the light of a branch is added after others are followed");
        const TogetherThreads all;
        Entry branch, lit;
        branch.ray = primary;
        SurfaceEvent<Real, Media> lit_event;
        Surface<Real> lit_surface;
        bool follows = true, waits = false, at_first = true;
        for (uint32_t turns = 1;; ++turns) {
            if (follows && !waits) {
                SurfaceEvent<Real, Media> event;
                VisibleLightHit<Real> light;
                if (line_.find(branch, event, light)) {
                    const Surface<Real> s = surface_at<Real, Only>(scene_, branch.ray, event.hit);
                    if (at_first) first.surface(event.hit, s);
                    leave(branch, true, event, s);
                    waits = material_of(scene_, s).local > Real(0);
                    if (waits) lit = branch, lit_event = event, lit_surface = s;
                } else if constexpr (E::has(effect_visible_lights)) {
                    if (at_first && light.found()) first.light(scene_, light, branch.ray);
                }
                at_first = false;
                follows = next(branch);
            }
            if (turns % turns_between_stops == 0 && stack_.stopped()) stack_.clear(), follows = waits = false;
            const int waiting = all.count(waits);
            const int searching = all.count(follows && !waits);
            if (waiting + searching == 0) return;
            if (waiting < searching) continue;
            if (waits) add_light(lit, true, lit_event, lit_surface);
            waits = false;
        }
    }

    /// Traces a branch of a tree and all that comes from it, as trace() does.
    template <SeesFirst<Real, E, Scene, Media> First>
    CISTULA_INLINE void trace_branch(Entry& branch, const First& first) {
        const uint32_t depth = branch.depth;
        uint32_t turns = 0;
        do {
            if (++turns % turns_between_stops == 0 && stack_.stopped()) return stack_.clear();
            const bool at_first = depth == 0 && turns == 1;
            SurfaceEvent<Real, Media> event;
            VisibleLightHit<Real> light;
            if (line_.find(branch, event, light)) {
                const Surface<Real> s = surface_at<Real, Only>(scene_, branch.ray, event.hit);
                if (at_first) first.surface(event.hit, s);
                shade(branch, true, event, s);
            } else if (at_first && light.found()) {
                first.light(scene_, light, branch.ray);
            }
        } while (next(branch));
    }

    /// Follows branches in lanes to their surfaces, where `active` holds, and pushes their children. Branches of depth
    /// 0 report what they hit. Returns those of which nothing was done, since they must be traced by themselves
    /// (lane_single.h).
    template <SeesFirst<Real, E, Scene, Media, MaskOf<Real>> First>
    CISTULA_INLINE MaskOf<Real> follow(Entry& branch, const MaskOf<Real>& active, const First& first) {
        SurfaceEvent<Real, Media> event;
        VisibleLightHit<Real> light;
        MaskOf<Real> single = false;
        MaskOf<Real> met = line_.find(branch, active, event, light, single);
        const MaskOf<Real> among_meshes = meshes_at_starts<Only>(scene_, branch.ray, event.hit, met);
        single |= among_meshes;
        met = met & !among_meshes;
        if constexpr (E::has(effect_visible_lights))
            if (branch.depth == 0) first.light(scene_, light, branch.ray, active & light.found());
        if (!any(met)) return single;
        Surface<Real> s;
        surfaces_at<Only>(scene_, branch.ray, event.hit, met, s);
        if (branch.depth == 0) first.surface(event.hit, s, met);
        correct_starts<Only>(scene_, branch.ray, event, s.normal, false, met, s.viewer_side, s.viewer_media);
        shade(branch, met, event, s);
        return single;
    }

  private:
    /// Pops branches until one is worth tracing; false if there is none, or if the tree has lost too much.
    CISTULA_INLINE bool next(Entry& branch) {
        if constexpr (E::has(effect_reflection | effect_transmission)) {
            for (;;) {
                if (!stack_.pop(branch)) return false;
                if (sums_.afford(branch.weight)) break;
                if constexpr (E::has(keeps_budget))
                    if (sums_.left() < 0) {
                        stack_.clear();
                        return false;
                    }
            }
            find_start_plane<Only>(scene_, branch.ray);
            start_near<Only>(scene_, branch.ray);
            // All that comes from one of the first surface's children is followed before the other.
            if constexpr (E::has(fills_layers))
                if (branch.depth == 1) sums_.enter(branch.mirrored);
            rays_.reflected += branch.mirrored;
            rays_.transmitted += 1 - branch.mirrored;
            return true;
        } else {
            return false;
        }
    }

    /// Pushes a face's children and adds its local light. The children are pushed before the lights are evaluated, so
    /// that nothing of the branch has to be kept.
    CISTULA_INLINE void shade(const Entry& branch, const MaskOf<Real>& active, const SurfaceEvent<Real, Media>& event,
                              const Surface<Real>& s) {
        leave(branch, active, event, s);
        add_light(branch, active, event, s);
    }
    CISTULA_INLINE void leave(const Entry& branch, const MaskOf<Real>& active, const SurfaceEvent<Real, Media>& event,
                              const Surface<Real>& s) {
        if (any(active & !is_finite(s.normal))) sums_.flag(flag_not_finite);
        if constexpr (E::has(effect_reflection | effect_transmission)) send_on(branch, active, event, s);
    }
    CISTULA_INLINE void add_light(const Entry& branch, const MaskOf<Real>& active,
                                  const SurfaceEvent<Real, Media>& event, const Surface<Real>& s) {
        const Real local = material_of(scene_, s).local;
        const MaskOf<Real> lit = active & (local > Real(0));
        if (any(lit))
            add_local_light<Real, Only>(scene_, intersector_, branch.ray, event, s, branch.weight * local, sums_, rays_,
                                        LightObserver(), lit);
    }

    /// Pushes the heavier of the branch's children and then the lighter, which is followed next.
    CISTULA_INLINE void send_on(const Entry& branch, const MaskOf<Real>& active, const SurfaceEvent<Real, Media>& event,
                                const Surface<Real>& s) {
        const MaskOf<Real> sheet = is_kind(event.hit.key, CrossingKind::sheet);
        const InterfaceSplit<Real, Weight> split =
            split_at<Real, Only>(scene_, material_of(scene_, s), branch.ray.direction, s.shading, branch.ray.media,
                                 event.beyond, sheet, s.normal, s.smooth);
        const Weight mirrored = branch.weight * split.reflection;
        const Weight through = branch.weight * split.filter;
        // Sums over channels, so that the lighter child has at most half the weight of its parent.
        const Real mirrored_size = total(mirrored);
        const Real through_size = E::has(effect_transmission) ? total(through) : Real(0);
        if constexpr (in_lanes<Real>) {
            const MaskOf<Real> reflects = active & (mirrored_size > Real(0));
            const MaskOf<Real> passes = active & (through_size > Real(0));
            if (int(branch.depth) + 1 >= depth_) {
                sums_.cut(mirrored, reflects);
                if constexpr (E::has(effect_transmission)) sums_.cut(through, passes);
                return;
            }
            if (any(reflects)) stack_.push(mirrored_child(branch, event, s, mirrored), reflects);
            if constexpr (E::has(effect_transmission))
                if (any(passes)) stack_.push(transmitted_child(branch, event, s, split, through, passes), passes);
            return;
        } else {
            if (int(branch.depth) + 1 >= depth_) {
                CISTULA_NOT_UNROLLED
                for (int i = 0; i < (E::has(effect_transmission) ? 2 : 1); ++i)
                    if ((i == 0 ? mirrored_size : through_size) > Real(0)) sums_.cut(i == 0 ? mirrored : through);
                return;
            }
            if constexpr (!E::has(effect_transmission)) {
                // The only child takes the place of its parent, so there is room.
                if (mirrored_size > Real(0)) stack_.push(child_of(branch, event, s, split, false, mirrored));
            } else {
                bool goes_through = through_size >= mirrored_size;
                CISTULA_NOT_UNROLLED
                for (int i = 0; i < 2; ++i, goes_through = !goes_through) {
                    if (!((goes_through ? through_size : mirrored_size) > Real(0))) continue;
                    if (!stack_.push(
                            child_of(branch, event, s, split, goes_through, goes_through ? through : mirrored)))
                        sums_.flag(flag_stack_overflow);
                }
            }
        }
    }

    /// The children of branches in lanes.
    CISTULA_INLINE Entry mirrored_child(const Entry& parent, const SurfaceEvent<Real, Media>& event,
                                        const Surface<Real>& s, const Weight& weight) {
        Entry child = parent.child(weight, true);
        child.ray =
            spawned(s.viewer_side, mirrored_way<Only, Media>(s, parent.ray.direction), event.hit, s.viewer_media);
        return child;
    }
    CISTULA_INLINE Entry transmitted_child(const Entry& parent, const SurfaceEvent<Real, Media>& event,
                                           const Surface<Real>& s, const InterfaceSplit<Real, Weight>& split,
                                           const Weight& weight, const MaskOf<Real>& active) {
        Entry child = parent.child(weight, false);
        child.ray = parent.ray;
        if constexpr (lines_go_on<Only>) child.no_light_ahead = parent.no_light_ahead;
        line_.pass(child.ray, event, true);
        if constexpr (E::has(effect_refraction)) {
            const MaskOf<Real> bends = active & split.bends;
            if (any(bends)) {
                Vec3<Real> start = far_side<Only>(scene_, event.hit, bends, s.point);
                Media media = event.beyond;
                correct_starts<Only>(scene_, parent.ray, event, s.normal, true, bends, start, media);
                child.ray.take_where(bends, spawned(start, split.through, event.hit, media));
            }
        }
        return child;
    }

    /// The transmitted or the reflected child of a branch.
    CISTULA_INLINE Entry child_of(const Entry& parent, const SurfaceEvent<Real, Media>& event, const Surface<Real>& s,
                                  const InterfaceSplit<Real, Weight>& split, bool goes_through, const Weight& weight) {
        Entry child;
        child.depth = parent.depth + 1;
        child.weight = weight;
        child.mirrored = !goes_through;
        if (!goes_through) {
            spawn(child.ray, s.viewer_side, mirrored_way<Only, Media>(s, parent.ray.direction), event.hit,
                  parent.ray.media);
            correct_start(child.ray, parent.ray, event, s, false);
        } else if (split.bends) {
            spawn(child.ray, far_side<Only>(scene_, event.hit, s.point, s.normal), split.through, event.hit,
                  event.beyond);
            correct_start(child.ray, parent.ray, event, s, true);
        } else {
            child.ray = parent.ray;
            if constexpr (lines_go_on<Only>) child.no_light_ahead = parent.no_light_ahead;
            Absorption<false> later;  // the child starts its own absorption
            line_.pass(child.ray, event, later);
        }
        return child;
    }

    /// Corrects a new ray that may start near a shared plane or on a ball.
    CISTULA_INLINE void correct_start(Ray<Real, Media>& ray, const Ray<Real, Media>& parent,
                                      const SurfaceEvent<Real, Media>& event, const Surface<Real>& s,
                                      bool beyond) const {
        if constexpr (meets_contacts<Only, Media>)
            if (starts_at_contact<Only>(scene_, event) &&
                start_at_contact(scene_, parent, event, s.normal, beyond, ray.origin, ray.media)) {
                find_start_plane<Only>(scene_, ray);
                count_meshes(scene_, intersector_, ray);
            }
        if constexpr (meets_balls<Only, Scene>)
            ball_start(scene_, parent, event.hit, ray.origin).begin(scene_, intersector_, ray);
    }

    const Scene& scene_;
    const Intersector& intersector_;
    NextSurface<Real, Only, Intersector, Sums> line_;
    const int depth_;
    Sums& sums_;
    Rays& rays_;
    Stack& stack_;
};

}  // namespace cistula
