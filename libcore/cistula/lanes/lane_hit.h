// Keys of crossings in lanes, which fit the integers of a lane: a LaneScene's solids and faces have small numbers.
#pragma once

#include "cistula/lanes/lane_media.h"

namespace cistula {

/// Packs kind, solid and face (LaneKey), so that comparing keys compares (kind, solid, face); sheets are compared
/// in reverse, as in make_key.
template <class T, int n>
struct KeyFormat<Lanes<T, n>> {
    using Key = KeyOf<Lanes<T, n>>;
    static constexpr int32_t none = LaneKey::none;

    CISTULA_INLINE static Key make(CrossingKind kind, uint32_t solid, const Key& face) {
        return Key(without_face(kind, solid)) | face;
    }
    /// The key of a single ray as that of a lane; of no crossing yet, 0, as that of none.
    CISTULA_INLINE static int32_t of_single(uint64_t key) {
        return key == 0 ? 0 : without_face(key_kind(key), key_solid(key)) | int32_t(key_face(key));
    }
    /// The key of a lane as that of a single ray, likewise.
    CISTULA_INLINE static uint64_t of_lane(const Key& key, int lane) {
        const uint32_t one = uint32_t(key[lane]);
        if (one == 0) return 0;
        const CrossingKind kind = CrossingKind(one >> LaneKey::kind_bit);
        const uint32_t place = one >> LaneKey::solid_bit & LaneKey::solids;
        return make_key(kind, kind == CrossingKind::sheet ? place ^ LaneKey::solids : place, one & LaneKey::faces);
    }

  private:
    CISTULA_INLINE static int32_t without_face(CrossingKind kind, uint32_t solid) {
        const uint32_t place = kind == CrossingKind::sheet ? solid ^ LaneKey::solids : solid;
        return int32_t(uint32_t(kind) << LaneKey::kind_bit | place << LaneKey::solid_bit);
    }
};

template <class T, int n>
requires std::is_integral_v<T> CISTULA_INLINE typename Lanes<T, n>::Mask is_kind(const Lanes<T, n>& key,
                                                                                 CrossingKind kind) {
    return key >> LaneKey::kind_bit == T(kind);
}
template <class T, int n>
requires std::is_integral_v<T> CISTULA_INLINE Lanes<T, n> key_solid(const Lanes<T, n>& key) {
    const Lanes<T, n> place = key >> LaneKey::solid_bit & T(LaneKey::solids);
    return select(is_kind(key, CrossingKind::sheet), place ^ T(LaneKey::solids), place);
}
template <class T, int n>
requires std::is_integral_v<T> CISTULA_INLINE Lanes<T, n> key_face(const Lanes<T, n>& key) {
    return key & T(LaneKey::faces);
}

/// The entries of a table at an index in each lane; 0 for an index beyond it.
template <class T, int n>
CISTULA_INLINE Lanes<T, n> entries_of(const Span<uint32_t>& table, const Lanes<T, n>& index) {
    LaneArray<Lanes<T, n>> places(index), entries;
    for (int lane = 0; lane < n; ++lane) {
        const auto place = uint32_t(places.of[lane]);
        entries.of[lane] = place < table.size ? T(table[place]) : T(0);
    }
    return entries.all();
}

/// The key of a single ray with other numbers of solids.
CISTULA_INLINE uint64_t renumbered(uint64_t key, const uint32_t* numbers) {
    return key == 0 ? 0 : make_key(key_kind(key), numbers[key_solid(key)], key_face(key));
}

/// A lane of a ray as a single ray.
template <class Media = SingleInterior, class T, int n>
CISTULA_INLINE Ray<T, Media> lane_of(const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray, int lane) {
    Ray<T, Media> one;
    one.origin = lane_of(ray.origin, lane);
    one.direction = lane_of(ray.direction, lane);
    one.from_solid = uint32_t(ray.from_solid[lane]);
    one.from_face = uint32_t(ray.from_face[lane]);
    one.after = {ray.after.t[lane], KeyFormat<Lanes<T, n>>::of_lane(ray.after.key, lane)};
    if constexpr (Media::contacts)
        one.media = ray.media.of(lane).list(), one.from_plane = uint32_t(ray.from_plane[lane]);
    else
        one.media.solid = ray.media.of(lane).only();
    return one;
}

}  // namespace cistula
