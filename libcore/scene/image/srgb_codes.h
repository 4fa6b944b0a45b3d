// Conversion of sRGB integers to linear values and back, by tables made from cistula/numerics/elementary.h.
#pragma once

#include <cstdint>

namespace cistula {

/// The linear value of an 8-bit sRGB code: 0 -> 0, 255 -> 1.
float linear_from_srgb8(uint8_t code);

/// The linear value of a 16-bit sRGB code: 0 -> 0, 65535 -> 1.
float linear_from_srgb16(uint16_t code);

/// The 8-bit sRGB code nearest to a linear value, clamped to [0, 1]; NaN gives 0.
uint8_t srgb8_from_linear(float linear);

}  // namespace cistula
