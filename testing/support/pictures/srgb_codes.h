// Linear values of sRGB integers, as tests expect them of textures.
#pragma once

#include <cstdint>

#include "cistula/numerics/elementary.h"

namespace cistula {

inline float linear_from_srgb8(uint8_t code) {
    return static_cast<float>(elementary::srgb_to_linear(code / 255.0));
}

inline float linear_from_srgb16(uint16_t code) {
    return static_cast<float>(elementary::srgb_to_linear(code / 65535.0));
}

}  // namespace cistula
