// Structural similarity.
#pragma once

#include <optional>

#include "compare/metrics/channel_statistics.h"
#include "compare/metrics/selection.h"

namespace cistula {

/// SSIM of two channels: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image quality assessment: from error
/// visibility to structural similarity", IEEE Trans. Image Processing 13(4), 2004; windows of 11x11 pixels with a
/// Gaussian of 1.5 pixels, K1 = 0.01, K2 = 0.03, the mean over all windows that lie in the region, with all pixels.
/// Codes are compared as fractions of their largest; other values as the 8-bit sRGB codes of a preview, so the dynamic
/// range L is 1. None for channels that are neither codes nor R, G, B, or Y alone, and for regions without a window.
std::optional<double> ssim_of(const PlacedChannel& a, const PlacedChannel& b, const Region& region);

}  // namespace cistula
