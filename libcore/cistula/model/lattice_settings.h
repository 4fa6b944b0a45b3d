// What a frame asks of adaptive sampling, for whoever makes frames: lattice.h samples by it.
#pragma once

#include "cistula/numerics/portable.h"

namespace cistula {

/// Samples along a pixel's side, and in a pixel.
inline constexpr int lattice_side = 16, lattice_samples = lattice_side * lattice_side;
/// The fewest samples that a pixel can do with: its corners and its middle.
inline constexpr int least_lattice_samples = 5;
/// Colors are compared in units of 2^-44 of the radiance bound's power of two: a target may be 2^-32 of that, as in
/// closed-box.json. What is computed of them takes at most 13 bits more.
inline constexpr int color_bits = 44, color_shift = 54 - color_bits;

/// The error that a frame allows its pixels, and how to look for it.
struct LatticeSettings {
    int64_t target = 0;          // error that sampling may leave, in units of 2^-color_bits; 0: no adaptive sampling
    int most = lattice_samples;  // samples of a pixel
    bool fine = true;            // also looks at the middle of every pixel, and splits in four first: for small targets
    double significant = 0;      // branches of less weight than this do not tell samples apart

    /// Whether an error of `color` in `area` samples, in units of 2^-color_bits, is worth more than the target to the
    /// pixel.
    CISTULA_INLINE bool exceeded_by(int64_t color, int64_t area) const {
        return color * area > target * lattice_samples;
    }
};

}  // namespace cistula
