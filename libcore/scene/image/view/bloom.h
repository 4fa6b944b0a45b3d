// Bloom: the glow around what is brighter than white.
#pragma once

#include <cstdint>

#include "scene/image/picture/picture.h"

namespace cistula {

/// Half the width in pixels of the boxes by which light is spread in a frame of this height: 1/64 of it, at least 1.
/// Their standard deviation together is half a pixel more.
uint32_t bloom_radius(uint32_t full_height);

/// Adds `amount` times the light above white, spread over the pixels around: three boxes of 2 * bloom_radius + 1
/// pixels, one after the other, in each direction, so nearly a Gaussian. The light above white of a color whose largest
/// channel m is above 1 is the color times (m - 1) / m, each channel from 0 to 65,504 (NaN counts as 0). What falls
/// outside of the picture is lost. One thread, one order of sums: the same bits everywhere.
void add_bloom(ColorPicture& picture, double amount, uint32_t full_height);

}  // namespace cistula
