// What one source needs to run for a number and for lanes of numbers (lanes.h): masks in place of conditions, selects
// in place of branches. For a number a mask is a bool, so nothing of this is left in its code.
#pragma once

#include <type_traits>

#include "cistula/numerics/portable.h"

namespace cistula {

/// The types that go with a number type, for float and double; lanes.h has those of lanes.
template <class Real>
struct LaneTraits {
    using Scalar = Real;     // of scene data, which all lanes read
    using Mask = bool;       // the result of a comparison
    using Index = uint32_t;  // numbers of solids and faces
    using Key = uint64_t;    // of a crossing (hit.h)
    using Wide = double;     // at least double, where a scene's own precision is not enough
    using Loss = uint64_t;   // of transmittance.h
    static constexpr int lanes = 1;
};
template <class Real>
using ScalarOf = typename LaneTraits<Real>::Scalar;
template <class Real>
using MaskOf = typename LaneTraits<Real>::Mask;
template <class Real>
using IndexOf = typename LaneTraits<Real>::Index;
template <class Real>
using KeyOf = typename LaneTraits<Real>::Key;
template <class Real>
using WideOf = typename LaneTraits<Real>::Wide;
template <class Real>
using LossOf = typename LaneTraits<Real>::Loss;

/// Whether a number type is lanes of numbers.
template <class Real>
inline constexpr bool in_lanes = LaneTraits<Real>::lanes > 1;

/// Whether a mask holds for any lane, and for all.
CISTULA_INLINE bool any(bool mask) {
    return mask;
}
CISTULA_INLINE bool all(bool mask) {
    return mask;
}

/// `a` where the mask holds, else `b`.
template <class T>
CISTULA_INLINE T select(bool mask, const T& a, const T& b) {
    return mask ? a : b;
}

/// Sets `to` to `from` where the mask holds.
template <class T>
CISTULA_INLINE void assign_where(bool mask, T& to, const std::type_identity_t<T>& from) {
    if (mask) to = from;
}

/// A mask for lanes of `Real`, from the mask of a comparison of WideOf<Real> or of its higher precision.
template <class Real>
CISTULA_INLINE bool narrowed(bool mask) {
    return mask;
}
/// A mask for values of 64 bits, from one for lanes.
CISTULA_INLINE bool widened(bool mask) {
    return mask;
}

}  // namespace cistula
