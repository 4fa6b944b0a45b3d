// A rendered frame as the backends fill it: integer sums, from which every channel of a file is made.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/pixel_rect.h"
#include "cistula/model/lattice_settings.h"
#include "render/record/film_layers.h"
#include "render/record/film_pixels.h"

namespace cistula {

/// A bound on what whole units took from each channel of a pixel's sums: less than one for each contribution, of which
/// there are no more than rays (docs/rules.md, 8). `samples`: of the frame's pixels.
inline uint64_t units_lost(const PixelRecord& pixel, int samples) {
    const bool is_adaptive = pixel.samples < static_cast<uint32_t>(samples);
    return uint64_t{pixel.rays} * (is_adaptive ? largest_weight(pixel.samples) : 1);
}

/// What is counted over the pixels of a frame or of a part of it.
struct FrameCounts {
    RayCounts rays;
    uint32_t flags = 0;  // RenderFlag bits of all pixels
    PixelTotals totals;

    void add(const FrameCounts& o) {
        rays.add(o.rays);
        flags |= o.flags;
        totals.add(o.totals);
    }
};

/// One rendered frame (or its crop), with its counts. pixels is row-major over rect.
struct Film : FrameCounts {
    int full_width = 0;
    int full_height = 0;
    PixelRect rect;
    int radiance_exponent = 0;          // radiances were divided by 2^radiance_exponent
    int samples = 1;                    // per pixel
    int fixed_shift = 0;                // s of the fixed sums
    int64_t background[3] = {0, 0, 0};  // what a sample that meets nothing adds to its pixel's sums
    double rounding = 0;  // bound on how far rounding moves points, in widths of a pixel at distance 1 (scene units)
    FilmPixels pixels;
    FilmLayers layers;  // as asked for

    /// Contribution of one unit of a pixel's sums to its mean, in the scene's units of radiance.
    double unit() const { return std::ldexp(1.0, radiance_exponent - fixed_shift) / samples; }

    uint64_t units_lost(const PixelRecord& pixel) const { return cistula::units_lost(pixel, samples); }
};

}  // namespace cistula
