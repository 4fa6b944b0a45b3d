// Texels that are no radiance: negative, infinite, not a number.
#pragma once

#include <cstdint>
#include <string>

#include "image/picture/picture.h"

namespace cistula {

/// How many values of a picture (of one channel of one texel) are no radiance, and what took their place.
struct ClampedTexels {
    uint64_t negative = 0;
    uint64_t infinite = 0;
    uint64_t not_numbers = 0;
    float largest = 1;  // replaces infinity
    // of the first texel that has one
    uint32_t x = 0;
    uint32_t y = 0;
    uint32_t channel = 0;  // of the first
    float first = 0;       // its value
    uint64_t values = 0;   // of the whole picture

    uint64_t count() const { return negative + infinite + not_numbers; }

    /// A sentence for a warning: "values of its texels that are no radiance: 3 negative (taken as 0), of 12; ...".
    std::string warning() const;

    /// A sentence for an error: "texel (1, 0) has G = -0.5; ...".
    std::string refusal() const;
};

/// Takes negative values and NaN as 0, and positive infinity as the largest finite value of the picture (as 1 if
/// that is 0). Minus zero stays.
ClampedTexels clamp_texels(ColorPicture& picture);

}  // namespace cistula
