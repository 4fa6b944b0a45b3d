// 8-bit sRGB integers of linear values and back, by tables made from cistula/numerics/elementary.h.
#pragma once

#include <cstdint>

namespace cistula {

/// The 8-bit sRGB code nearest to a linear value, clamped to [0, 1]; NaN gives 0.
uint8_t srgb8_from_linear(float linear);

/// The linear value of an 8-bit sRGB code: 0 -> 0, 255 -> 1.
float srgb8_to_linear(uint8_t code);

}  // namespace cistula
