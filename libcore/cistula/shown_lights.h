// The seen lights that lines from the camera may come upon in a part of the picture: straight on, or where the first
// mirror that they meet sends them. The host lists them (scene/light_images.h).
#pragma once

#include "cistula/portable.h"

namespace cistula {

/// Numbers of flat faces that mirror, a bit each in a word; the last bit stands for no mirror.
struct MirrorNumbers {
    static constexpr uint32_t most = 63, straight = most, none = 1u << 31, solids = 24;

    uint32_t first[solids];  // the face's number less its number in keys; none: that solid's have no numbers

    /// `most` or more: it has no number.
    CISTULA_INLINE uint32_t of(uint32_t solid, uint32_t face) const { return first[solid] + face; }
    /// No face has a number.
    CISTULA_INLINE void clear() {
        for (uint32_t& number : first) number = none;
    }
};

/// A light, by its place among the seen ones, and the mirror that shows it.
struct ShownLight {
    static constexpr uint32_t most = 1024;  // seen lights of a scene that are listed

    uint32_t bits;  // one word, which devices read at once

    CISTULA_INLINE static ShownLight of(uint32_t light, uint32_t mirror) { return {mirror << 16 | light}; }
    CISTULA_INLINE uint32_t light() const { return bits & 0xffffu; }
    CISTULA_INLINE uint32_t mirror() const { return bits >> 16; }
};

/// Part of a picture. Of a mirror whose bit is set but of which none is listed any light may show.
struct alignas(16) LitCell {
    static constexpr uint32_t most = 16;  // lights listed

    uint64_t mirrors = ~uint64_t{0};  // those that may show any
    uint32_t first = 0, count = 0;    // of ShownLights

    CISTULA_INLINE bool is_dark(uint32_t mirror) const {
        return mirror <= MirrorNumbers::straight && (mirrors >> mirror & 1u) == 0;
    }
};

/// A cell, and where its list counts from.
struct ShownLights {
    const LitCell* cell = nullptr;  // null: nothing is known
    const ShownLight* lights = nullptr;

    /// What is known of lines that `mirror` shows.
    CISTULA_INLINE LitCell seen_in(uint32_t mirror) const {
        return cell != nullptr && mirror <= MirrorNumbers::straight ? *cell : LitCell();
    }
};

}  // namespace cistula
