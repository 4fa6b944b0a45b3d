// Keys of crossings in lanes, which fit the integers of a lane: rays in lanes trace a ConstantScene, whose solids and
// faces have small numbers.
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/lanes/lanes.h"
#include "cistula/model/constant_scene.h"

namespace cistula {

/// Packs kind, solid and face (8 bits each), so that comparing keys compares (kind, solid, face); sheets are compared
/// in reverse, as in make_key.
template <class T, int n>
struct KeyFormat<Lanes<T, n>> {
    using Key = KeyOf<Lanes<T, n>>;
    static constexpr int32_t none = 0x7fffffff;
    static constexpr uint32_t most = 0xff;  // the maximum number of a solid or a face
    static_assert(ShadowPlan::solids <= most && 2 * ConstantScene<T>::most_slabs <= most);

    CISTULA_INLINE static Key make(CrossingKind kind, uint32_t solid, const Key& face) {
        const uint32_t place = kind == CrossingKind::sheet ? solid ^ most : solid;
        return Key(int32_t(uint32_t(kind) << 16 | place << 8)) | face;
    }
    /// The key of a lane as that of a single ray.
    CISTULA_INLINE static uint64_t of_lane(const Key& key, int lane) {
        const uint32_t one = uint32_t(key[lane]);
        const CrossingKind kind = CrossingKind(one >> 16);
        const uint32_t place = one >> 8 & most;
        return make_key(kind, kind == CrossingKind::sheet ? place ^ most : place, one & most);
    }
};

template <class T, int n>
requires std::is_integral_v<T> CISTULA_INLINE typename Lanes<T, n>::Mask is_kind(const Lanes<T, n>& key,
                                                                                 CrossingKind kind) {
    return key >> 16 == T(kind);
}
template <class T, int n>
requires std::is_integral_v<T> CISTULA_INLINE Lanes<T, n> key_solid(const Lanes<T, n>& key) {
    const Lanes<T, n> place = key >> 8 & T(0xff);
    return select(is_kind(key, CrossingKind::sheet), place ^ T(0xff), place);
}
template <class T, int n>
requires std::is_integral_v<T> CISTULA_INLINE Lanes<T, n> key_face(const Lanes<T, n>& key) {
    return key & T(0xff);
}

/// Whether a bit that belongs to each lane's solid is set.
template <class T, int n>
CISTULA_INLINE typename Lanes<T, n>::Mask has_bit(uint32_t bits, const Lanes<T, n>& solid) {
    return (Lanes<T, n>(T(bits)) & Lanes<T, n>(T(1)) << (solid & T(31))) != T(0);
}

/// A lane of a ray as a single ray.
template <class T, int n>
CISTULA_INLINE Ray<T, SingleInterior> lane_of(const Ray<Lanes<T, n>, SingleInteriorOf<Lanes<T, n>>>& ray, int lane) {
    Ray<T, SingleInterior> one;
    one.origin = lane_of(ray.origin, lane);
    one.direction = lane_of(ray.direction, lane);
    one.from_solid = uint32_t(ray.from_solid[lane]);
    one.from_face = uint32_t(ray.from_face[lane]);
    one.after = {ray.after.t[lane], KeyFormat<Lanes<T, n>>::of_lane(ray.after.key, lane)};
    one.media.solid = uint32_t(ray.media.solid[lane]);
    return one;
}

}  // namespace cistula
