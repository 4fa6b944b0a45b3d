// A ray's hit: ids and parameters. The point, normal and color are computed from them afterwards (surface.h).
#pragma once

#include "cistula/numerics/vec.h"

namespace cistula {

/// The kind of a crossing, in the order in which crossings at equal t are taken (docs/rules.md, 11): what lies on a
/// face is met before the face, and a body that begins there before the one that ends.
enum class CrossingKind : uint32_t { sheet = 0, enter = 1, leave = 2 };

/// Packs kind (8 bits), solid (24 bits) and face (32 bits), so that comparing keys compares (kind, solid, face). Sheets
/// are compared in reverse: the one declared last comes first.
CISTULA_INLINE uint64_t make_key(CrossingKind kind, uint32_t solid, uint32_t face) {
    const uint32_t place = kind == CrossingKind::sheet ? solid ^ 0xffffffu : solid;
    return uint64_t(kind) << 56 | uint64_t(place) << 32 | face;
}
CISTULA_INLINE CrossingKind key_kind(uint64_t key) {
    return CrossingKind(key >> 56);
}
CISTULA_INLINE bool is_kind(uint64_t key, CrossingKind kind) {
    return key_kind(key) == kind;
}
/// The change of a solid's entry count at a crossing: 1 on entering, -1 on leaving, 0 for a sheet.
CISTULA_INLINE int media_change(CrossingKind kind) {
    return kind == CrossingKind::enter ? 1 : kind == CrossingKind::leave ? -1 : 0;
}
CISTULA_INLINE uint32_t key_solid(uint64_t key) {
    const uint32_t place = uint32_t(key >> 32) & 0xffffffu;
    return key_kind(key) == CrossingKind::sheet ? place ^ 0xffffffu : place;
}
CISTULA_INLINE uint32_t key_face(uint64_t key) {
    return uint32_t(key);
}
inline constexpr uint64_t no_key = ~uint64_t(0);

/// The keys of rays of a number type: those above, and those of lanes (lane_hit.h).
template <class Real>
struct KeyFormat {
    static constexpr uint64_t none = no_key;

    CISTULA_INLINE static uint64_t make(CrossingKind kind, uint32_t solid, uint32_t face) {
        return make_key(kind, solid, face);
    }
};

/// A position along a ray. Crossings are ordered by (t, key).
template <class Real>
struct Crossing {
    Real t = -1;
    KeyOf<Real> key = 0;

    CISTULA_INLINE MaskOf<Real> before(const Real& other_t, const KeyOf<Real>& other_key) const {
        return (t < other_t) | ((t == other_t) & (key < other_key));  // without branches
    }
};

/// A hit; key == no_key means a miss, with infinite t.
template <class Real>
struct Hit {
    Real t = RealTraits<Real>::infinity;
    KeyOf<Real> key = KeyFormat<Real>::none;
    // triangles: weights of the second and third corner
    Real u = 0;
    Real v = 0;
    IndexOf<Real> slot = 0;      // triangles: 8 cluster + lane
    MaskOf<Real> enters = true;  // triangles: against the normal; the sign of det, not of a rounded dot product
    /// The smallest t of mesh crossings that were refused because they come from the wrong side (triangle.h).
    Real wrong_side_t = RealTraits<Real>::infinity;

    CISTULA_INLINE MaskOf<Real> found() const { return key != KeyFormat<Real>::none; }

    /// Replaces the hit by another crossing where `active` holds, keeping `wrong_side_t`.
    CISTULA_INLINE void take(const MaskOf<Real>& active, const Real& other_t, const KeyOf<Real>& other_key,
                             const Real& other_u, const Real& other_v, const IndexOf<Real>& other_slot,
                             const MaskOf<Real>& other_enters) {
        assign_where(active, t, other_t);
        assign_where(active, key, other_key);
        assign_where(active, u, other_u);
        assign_where(active, v, other_v);
        assign_where(active, slot, other_slot);
        assign_where(active, enters, other_enters);
    }

    /// Whether another crossing comes first: the hit with the smallest (t, key) is kept.
    CISTULA_INLINE MaskOf<Real> improves(const Real& other_t, const KeyOf<Real>& other_key) const {
        return (other_t < t) | ((other_t == t) & (other_key < key));
    }
};

}  // namespace cistula
