// Settings of adaptive sampling, for code that makes frames; lattice.h does the sampling.
#pragma once

#include "cistula/numerics/portable.h"

namespace cistula {

/// Samples along a pixel's side, and samples of a pixel.
inline constexpr int lattice_side = 16;
inline constexpr int lattice_samples = lattice_side * lattice_side;
/// The minimum number of samples of an adaptively sampled pixel: its four corners and its middle.
inline constexpr int least_lattice_samples = 5;
/// The most samples of the lattice that one of `samples` taken stands for (LatticePixel::accumulate): the middle one
/// for 160, where only the first were taken; else a corner of a quarter's cell for 16.
CISTULA_INLINE uint32_t largest_weight(uint32_t samples) {
    return samples >= uint32_t(lattice_samples) ? 1 : samples > uint32_t(least_lattice_samples) ? 16 : 160;
}
/// Fraction bits of the colors that the rules compare: units of 2^-44 of the radiance bound's power of two, since a
/// target may be as small as 2^-32 of it (closed-box.json). Products in the rules need at most 13 bits more.
inline constexpr int color_bits = 44;
inline constexpr int color_shift = 54 - color_bits;

/// A frame's target error for its pixels, and how samples are placed to reach it.
struct LatticeSettings {
    int64_t target = 0;          // target error in units of 2^-color_bits; 0: no adaptive sampling
    int most = lattice_samples;  // maximum number of samples of a pixel
    double significant = 0;      // branches of less throughput than this do not enter the path hash

    /// Whether an error of `color` (in units of 2^-color_bits) over `area` samples changes the pixel by more than the
    /// target.
    CISTULA_INLINE bool exceeded_by(int64_t color, int64_t area) const {
        return color * area > target * lattice_samples;
    }
};

/// Whether a pixel of a frame with a target error is checked: one in each block of 16 x 16 pixels, at a place that
/// depends on the block.
CISTULA_INLINE bool is_checked(int x, int y) {
    const uint32_t block = uint32_t(x / 16) * 0x9e3779b1u + uint32_t(y / 16) * 0x85ebca77u;
    return ((block ^ block >> 15) * 0xc2b2ae35u) >> 24 == uint32_t(y % 16 * 16 + x % 16);
}

}  // namespace cistula
