// 8-bit sRGB integers of linear values, by a table made from cistula/numerics/elementary.h.
#pragma once

#include <cstdint>

namespace cistula {

/// The 8-bit sRGB code nearest to a linear value, clamped to [0, 1]; NaN gives 0.
uint8_t srgb8_from_linear(float linear);

}  // namespace cistula
