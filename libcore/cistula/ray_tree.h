// One ray's tree (Whitted 1980), without recursion: the lighter child is followed and the heavier one waits, so that a
// few entries hold any tree. Whatever is not followed goes into the ledger.
#pragma once

#include <new>

#include "cistula/absorption.h"
#include "cistula/interface.h"
#include "cistula/lighting.h"
#include "cistula/meeting.h"
#include "cistula/seen_light.h"

namespace cistula {

inline constexpr int largest_depth = 1024;
/// Faces that one ray may pass without shading or bending; more fail the render (flag_too_many_crossings).
inline constexpr int largest_crossings = 1 << 20;
/// How often a walk asks a stack that can be stopped whether it is.
inline constexpr uint32_t turns_between_stops = 64;
/// The branch that is followed while k others wait weighs at most 2^-k, and one under 2^-62 is dropped.
inline constexpr int branch_stack = 67;

/// Whether rays pass faces without bending, all of them.
template <class E>
inline constexpr bool lines_go_on = E::has(effect_transmission) && !E::has(effect_refraction);

/// Part of a tree that is still to be followed: `weight`, a Share, times what `ray` sees.
template <class Real, class Media = MediaList, class Weight = Vec3<Real>>
struct Branch {
    Ray<Real, Media> ray;
    Weight weight{Real(1)};
    uint32_t depth : 30 = 0;  // surfaces above it
    uint32_t mirrored : 1 = 0;
    uint32_t dark : 1 = 0;  // its line is known to meet no seen light, however many faces it passes
};

template <class Entry>
class WaitingBranch;
/// A branch as it lies in memory: value by value, as a processor waits before it reads as a whole what was just set in
/// parts, and without gaps, as all threads of a device together have little room.
template <class Real, class Media, class Weight>
class WaitingBranch<Branch<Real, Media, Weight>> {
  public:
    using Entry = Branch<Real, Media, Weight>;

    CISTULA_INLINE explicit WaitingBranch(const Entry& branch)
        : origin_(branch.ray.origin),
          direction_(branch.ray.direction),
          weight_(branch.weight),
          after_(branch.ray.after.t),
          key_{uint32_t(branch.ray.after.key), uint32_t(branch.ray.after.key >> 32)},
          from_solid_(branch.ray.from_solid),
          from_face_(branch.ray.from_face),
          depth_(branch.depth),
          mirrored_(branch.mirrored),
          dark_(branch.dark),
          media_(branch.ray.media) {}

    CISTULA_INLINE void give(Entry& branch) const {
        static_assert(sizeof *this == sizeof origin_ + sizeof direction_ + sizeof weight_ + sizeof after_ +
                                          sizeof key_ + sizeof from_solid_ + sizeof from_face_ + sizeof(uint32_t) +
                                          sizeof media_);
        branch.ray.origin = origin_;
        branch.ray.direction = direction_;
        branch.ray.from_solid = from_solid_;
        branch.ray.from_face = from_face_;
        branch.ray.after = {after_, uint64_t(key_[1]) << 32 | key_[0]};
        branch.ray.media = media_;
        branch.weight = weight_;
        branch.depth = depth_;
        branch.mirrored = mirrored_;
        branch.dark = dark_;
    }

  private:
    Vec3<Real> origin_, direction_;
    Weight weight_;
    Real after_;
    uint32_t key_[2], from_solid_, from_face_;
    uint32_t depth_ : 30, mirrored_ : 1, dark_ : 1;
    Media media_;
};

/// Room for branches, unset: most trees need a few.
template <class Entry, int size>
class BranchRoom {
  public:
    CISTULA_INLINE BranchRoom() {}

    CISTULA_INLINE void put(int i, const Entry& branch) { new (&entries_[i]) WaitingBranch<Entry>(branch); }
    CISTULA_INLINE void get(int i, Entry& branch) const { waiting(i).give(branch); }
    CISTULA_INLINE const WaitingBranch<Entry>& waiting(int i) const { return entries_[i]; }

  private:
    union {
        WaitingBranch<Entry> entries_[size];
    };
};

/// The branches that wait, in the thread's own memory.
template <class Entry>
class BranchStack {
  public:
    /// False if there is no room.
    CISTULA_INLINE bool push(const Entry& branch) {
        if (count_ == branch_stack) return false;
        pending_.put(count_++, branch);
        return true;
    }
    /// The latest; false if there is none.
    CISTULA_INLINE bool pop(Entry& branch) {
        if (count_ == 0) return false;
        pending_.get(--count_, branch);
        return true;
    }
    CISTULA_INLINE bool empty() const { return count_ == 0; }
    CISTULA_INLINE void clear() { count_ = 0; }

  private:
    BranchRoom<Entry, branch_stack> pending_;
    int count_ = 0;
};

/// The same where no ray passes a face: a branch has one child at most, which is followed next.
template <class Entry>
class OneBranch {
  public:
    CISTULA_INLINE bool push(const Entry& branch) {
        branch_ = branch;
        waits_ = true;
        return true;
    }
    CISTULA_INLINE bool pop(Entry& branch) {
        if (!waits_) return false;
        branch = branch_;
        waits_ = false;
        return true;
    }
    CISTULA_INLINE bool empty() const { return !waits_; }
    CISTULA_INLINE void clear() { waits_ = false; }

  private:
    Entry branch_;
    bool waits_ = false;
};

/// The branches of a mask's trees, and what keeps them.
template <class Real, class E, class Media>
using BranchOf = Branch<Real, Media, Share<Real, E>>;
template <class Real, class E, class Media>
using StackOf = std::conditional_t<E::has(effect_transmission), BranchStack<BranchOf<Real, E, Media>>,
                                   OneBranch<BranchOf<Real, E, Media>>>;

template <class Real, class E, class Intersector, class Stack, class Record = PixelRecord>
class RayTree {
  public:
    using Sums = PixelSums<Real, Record>;
    using Media = typename Intersector::Media;
    using Scene = typename Intersector::Scene;
    using Weight = Share<Real, E>;
    using Entry = BranchOf<Real, E, Media>;

    CISTULA_INLINE RayTree(const Scene& scene, const Intersector& intersector, int depth, Sums& sums, PixelRays& rays,
                           Stack& stack)
        : scene_(scene), intersector_(intersector), depth_(depth), sums_(sums), rays_(rays), stack_(stack) {}

    /// Adds all that the primary ray sees to the sums, and tells what it meets first: first.surface(hit, normal), or
    /// first.nothing(light) where that is no surface but perhaps a seen light.
    template <class First>
    CISTULA_INLINE void trace(const Ray<Real, Media>& primary, const First& first) {
        Entry branch;
        branch.ray = primary;
        walk(branch, first);
    }

    /// Goes on with a branch of another tree, which that one left. In any order only where the budget of truncation is
    /// 0.
    CISTULA_INLINE void resume(Entry& branch) {
        if (follow(branch)) walk(branch, Unnoted());
    }

  private:
    struct Unnoted {
        CISTULA_INLINE void surface(const Hit<Real>&, const Vec3<Real>&) const {}
        CISTULA_INLINE void nothing(bool) const {}
    };

    template <class First>
    CISTULA_INLINE void walk(Entry& branch, const First& first) {
        bool at_first = true;
        [[maybe_unused]] uint32_t turns = 0;
        do {
            // The lanes of a warp ask in the same turn: a question that a few ask alone would part them for long.
            if constexpr (requires { stack_.stopped(); })
                if (++turns % turns_between_stops == 0 && stack_.stopped()) return stack_.clear();
            if constexpr (!E::has(effect_insides)) branch.ray.media = Media();
            Meeting<Real, Media>
                meeting;  // within the loop, as all that only some rays have: it holds no registers elsewhere
            bool light = false;
            if (next_surface(branch, meeting, light)) {
                const Surface<Real> s = surface_at<Real, E>(scene_, branch.ray, meeting.hit);
                if (at_first) first.surface(meeting.hit, s.normal);
                shade(branch, meeting, s);
            } else if (at_first) {
                first.nothing(light);
            }
            at_first = false;
        } while (next(branch));
    }

    /// The latest of the branches that wait and are worth it; false if there is none.
    CISTULA_INLINE bool next(Entry& branch) {
        if constexpr (E::has(effect_reflection | effect_transmission)) {
            do {
                if (!stack_.pop(branch)) return false;
            } while (!follow(branch));
            return true;
        } else {
            return false;
        }
    }

    CISTULA_INLINE bool follow(const Entry& branch) {
        if (!sums_.afford(branch.weight)) return false;
        rays_.reflected += branch.mirrored;
        rays_.transmitted += 1 - branch.mirrored;
        return true;
    }

    /// Straight on through a face.
    template <class Absorbed>
    CISTULA_INLINE void pass(Ray<Real, Media>& ray, const Meeting<Real, Media>& meeting, Absorbed& absorption) {
        Media media = meeting.beyond;
        if constexpr (Media::meshes)
            if (meeting.passed_over) count_passed_over(ray, meeting.taken[0], media, absorption);
        ray.media = media;
        ray.after = meeting.last();
    }

    /// A line's first crossing of a mesh is from the right side. Others of that mesh that rounding puts before it, at
    /// an edge that the line grazes, count all the same once it goes on straight.
    template <class Absorbed>
    CISTULA_INLINE void count_passed_over(const Ray<Real, Media>& ray, const Crossing<Real>& crossing, Media& media,
                                          Absorbed& absorption) {
        Ray<Real, Media> probe = ray;
        probe.meet_all();
        for (;;) {
            const Hit<Real> next = intersector_.closest(probe);
            if (!Crossing<Real>{next.t, next.key}.before(crossing.t, crossing.key)) return;
            // From the wrong side where the line starts: that mesh is behind it.
            if (!lies_at_start(scene_, ray, next)) {
                if (!media.add(key_solid(next.key), media_change(key_kind(next.key)))) sums_.flag(flag_media_overflow);
                absorption.cross(scene_, next.key, next.t);
            }
            probe.after = {next.t, next.key};
        }
    }

    /// A crossing with nothing to shade: inside a medium of higher priority, or of a clear face between equal media.
    CISTULA_INLINE bool invisible(const Ray<Real, Media>& ray, const Meeting<Real, Media>& meeting) {
        if constexpr (!E::has(effect_transmission | effect_insides)) {
            return false;
        } else {
            const uint32_t solid = key_solid(meeting.hit.key), medium = ray.media.medium();
            if (key_kind(meeting.hit.key) != CrossingKind::sheet && medium != no_solid && medium > solid) return true;
            if (!is_clear(scene_, solid)) return false;
            if constexpr (E::has(effect_refraction))
                return index_of(scene_, ray.media) == index_of(scene_, meeting.beyond);
            return true;
        }
    }

    /// Goes on to the next face that has anything to shade. Otherwise adds the light or background that the ray ends
    /// on.
    CISTULA_INLINE bool next_surface(Entry& branch, Meeting<Real, Media>& meeting, bool& light) {
        Absorption<E::has(effect_absorption)> absorption;
        absorption.begin(scene_, branch.ray.media, branch.ray.after.t);
        for (int crossings = 0;; ++crossings) {
            const Hit<Real> hit = intersector_.template closest<E>(branch.ray);
            SeenHit<Real> seen;
            if constexpr (E::has(effect_visible_lights)) {
                seen = light_before(hit, branch);
                light = seen.light != no_light;
            }
            if (light || !hit.found()) {
                absorption.dim(scene_, branch.ray.media, light ? seen.t : hit.t, branch.weight);
                sums_.add(branch.weight * light_or_background(seen));
                return false;
            }
            meet(scene_, intersector_, branch.ray, hit, meeting);
            if (!meeting.fits) sums_.flag(flag_media_overflow);
            if (!invisible(branch.ray, meeting)) {
                absorption.dim(scene_, branch.ray.media, meeting.hit.t, branch.weight);
                return true;
            }
            for (int i = 0; i < meeting.count; ++i) absorption.cross(scene_, meeting.taken[i].key, meeting.taken[i].t);
            pass(branch.ray, meeting, absorption);
            if (crossings == largest_crossings) {
                sums_.flag(flag_too_many_crossings);
                return false;
            }
        }
    }

    /// What a ray sees that meets no face before `seen`.
    CISTULA_INLINE Vec3<Real> light_or_background([[maybe_unused]] const SeenHit<Real>& seen) const {
        if constexpr (E::has(effect_visible_lights))
            if (seen.light != no_light) return scene_.seen_lights[seen.light].radiance;
        return scene_.background;
    }

    /// The seen light that the ray meets before `hit`. A line that may go straight on from there is searched to its
    /// end.
    CISTULA_INLINE SeenHit<Real> light_before(const Hit<Real>& hit, Entry& branch) {
        if constexpr (lines_go_on<E>)
            if (branch.dark) return SeenHit<Real>();
        const bool goes_on =
            lines_go_on<E> && hit.found() && int(branch.depth) + 1 < depth_ && transmits(scene_, key_solid(hit.key));
        const SeenHit<Real> seen = closest_seen_light(scene_, branch.ray, goes_on ? RealTraits<Real>::infinity : hit.t);
        if (seen.light == no_light) branch.dark = goes_on;
        return seen.t <= hit.t ? seen : SeenHit<Real>();
    }

    /// Adds a face's local light. What it sends on waits, before the lights are looked at: nothing of the branch has to
    /// be kept at hand for later then.
    CISTULA_INLINE void shade(const Entry& branch, const Meeting<Real, Media>& meeting, const Surface<Real>& s) {
        if (!is_finite(s.normal)) sums_.flag(flag_not_finite);
        if constexpr (E::has(effect_reflection | effect_transmission)) send_on(branch, meeting, s);
        const Real local = scene_.materials[s.material].local;
        if (local > Real(0))
            add_local_light<Real, E>(scene_, intersector_, branch.ray, meeting.hit, s, branch.weight * local, sums_,
                                     rays_);
    }

    /// Pushes the heavier of the branch's children and then the lighter, which is next.
    CISTULA_INLINE void send_on(const Entry& branch, const Meeting<Real, Media>& meeting, const Surface<Real>& s) {
        const bool sheet = key_kind(meeting.hit.key) == CrossingKind::sheet;
        const Shares<Real, Weight> shares =
            split_at<Real, E>(scene_, scene_.materials[s.material], branch.ray.direction, s.normal, branch.ray.media,
                              meeting.beyond, sheet);
        const Weight mirrored = branch.weight * shares.reflection, through = branch.weight * shares.filter;
        // Sums over colors, so that a child that is not the heavier is at most half its parent.
        const Real mirrored_size = total(mirrored),
                   through_size = E::has(effect_transmission) ? total(through) : Real(0);
        if (int(branch.depth) + 1 >= depth_) {
            CISTULA_NOT_UNROLLED
            for (int i = 0; i < (E::has(effect_transmission) ? 2 : 1); ++i)
                if ((i == 0 ? mirrored_size : through_size) > Real(0)) sums_.cut(i == 0 ? mirrored : through);
            return;
        }
        if constexpr (!E::has(effect_transmission)) {
            // The one child has the room that its parent left.
            if (mirrored_size > Real(0)) stack_.push(child_of(branch, meeting, s, shares, false, mirrored));
        } else {
            bool goes_through = through_size >= mirrored_size;
            CISTULA_NOT_UNROLLED
            for (int i = 0; i < 2; ++i, goes_through = !goes_through) {
                if (!((goes_through ? through_size : mirrored_size) > Real(0))) continue;
                if (!stack_.push(child_of(branch, meeting, s, shares, goes_through, goes_through ? through : mirrored)))
                    sums_.flag(flag_stack_overflow);
            }
        }
    }

    /// The ray that goes through, or the mirrored one.
    CISTULA_INLINE Entry child_of(const Entry& parent, const Meeting<Real, Media>& meeting, const Surface<Real>& s,
                                  const Shares<Real, Weight>& shares, bool goes_through, const Weight& weight) {
        Entry child;
        child.depth = parent.depth + 1;
        child.weight = weight;
        child.mirrored = !goes_through;
        if (!goes_through) {
            spawn(child.ray, s.viewer_side, reflected(parent.ray.direction, s.normal), meeting.hit, parent.ray.media);
        } else if (shares.bends) {
            spawn(child.ray, far_side<E>(scene_, meeting.hit, s.point, s.normal), shares.through, meeting.hit,
                  meeting.beyond);
        } else {
            child.ray = parent.ray;
            if constexpr (lines_go_on<E>) child.dark = parent.dark;
            Absorption<false> later;  // counted from there on
            pass(child.ray, meeting, later);
        }
        return child;
    }

    const Scene& scene_;
    const Intersector& intersector_;
    const int depth_;
    Sums& sums_;
    PixelRays& rays_;
    Stack& stack_;
};

}  // namespace cistula
