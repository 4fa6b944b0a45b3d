// The floating-point mode on which every image rests.
#pragma once

#include <immintrin.h>

namespace cistula {

/// Sets this thread to round to nearest, without flushing to zero: other libraries may have left it otherwise.
inline void use_default_rounding() {
    _mm_setcsr(0x1f80);
}

}  // namespace cistula
