// A branch of a ray tree that is still to be traced, and its compact form in memory.
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/model/effects.h"

namespace cistula {

/// A ray of a ray tree and its throughput: the weight, per channel or for all at once, with which what it sees counts
/// in the pixel.
template <class Real, class Media = InteriorList, class Weight = Vec3<Real>>
struct Branch {
    Ray<Real, Media> ray;
    Weight weight{Real(1)};
    uint32_t depth : 30 = 0;  // number of surfaces before it on the path
    uint32_t mirrored : 1 = 0;
    uint32_t no_light_ahead : 1 = 0;  // its line meets no visible light, however far it goes on
};

/// The type of branches, which lanes specialize.
template <class Real, class Media, class Weight>
struct BranchType {
    using Type = Branch<Real, Media, Weight>;
};
/// The branch type of trees that are rendered with effects E.
template <class Real, class E, class Media>
using BranchOf = typename BranchType<Real, Media, Throughput<Real, E>>::Type;

template <class Entry>
class WaitingBranch;
/// A branch as stored on a stack. Written value by value, since a processor stalls when it reads as a whole what was
/// just written in parts; without padding, since device memory per thread is scarce.
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
          no_light_ahead_(branch.no_light_ahead),
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
        branch.no_light_ahead = no_light_ahead_;
    }

  private:
    Vec3<Real> origin_, direction_;
    Weight weight_;
    Real after_;
    uint32_t key_[2], from_solid_, from_face_;
    uint32_t depth_ : 30, mirrored_ : 1, no_light_ahead_ : 1;
    Media media_;
};

}  // namespace cistula
