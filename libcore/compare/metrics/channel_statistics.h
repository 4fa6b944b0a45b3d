// Differences between two channels, and their structural similarity.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compare/metrics/selection.h"
#include "image/picture/stored_picture.h"

namespace cistula {

/// |a - b|; 0 for two NaNs and for two equal infinities, infinity if only one is finite or the infinities have
/// different signs.
double difference(double a, double b);

/// What the differences of a channel are counted in.
enum class DifferenceUnit {
    value,     // of numbers, as they stand
    integer,   // of whole numbers of one type, exactly
    fraction,  // codes are fractions of their largest, since the other channel has another type
};

/// Pixels of a channel that have a value that is not finite, and the first of them.
struct NonfiniteValues {
    size_t count = 0;
    int x = 0, y = 0;     // in pixel space
    double a = 0, b = 0;  // the two values there
};

/// Differences in a channel that both files have.
struct ChannelStatistics {
    std::string name;
    StoredType first_type = StoredType::float_;
    StoredType second_type = StoredType::float_;
    size_t values = 0;     // compared
    size_t differing = 0;  // with different bits
    size_t infinite = 0;   // infinite differences; included in max, excluded from mean, rmse, psnr and relative_mse
    NonfiniteValues nonfinite_alike;  // both are NaN, or one infinity
    NonfiniteValues nonfinite_other;  // only one is, or they are different
    double max = 0, mean = 0, rmse = 0;
    double psnr = INFINITY;      // dB; the peak is the largest code, or finite magnitude in either channel, at least 1
    double relative_mse = 0;     // mean of (a - b)^2 / (a^2 + 0.01), codes as fractions
    std::optional<double> ssim;  // where it was asked for, and is defined
    int x = 0, y = 0;            // largest difference, or first value with different bits; in pixel space
    double a = 0, b = 0;         // the two values there
    uint64_t a_bits = 0;
    uint64_t b_bits = 0;

    DifferenceUnit unit() const;
};

/// A channel of a picture.
struct PlacedChannel {
    const StoredChannel& channel;
    const PixelRect& data;
};

/// Statistics over a region, which lies in both data windows. `worst_of_pixels`, row-major over the region's window,
/// becomes at least the difference of each pixel.
ChannelStatistics statistics_of(const PlacedChannel& a, const PlacedChannel& b, const Region& region,
                                std::vector<double>& worst_of_pixels);

/// The differences of all pixels of the region's window; 0 where they do not count.
std::vector<float> differences_of(const PlacedChannel& a, const PlacedChannel& b, const Region& region);

/// SSIM of two channels: Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image quality assessment: from error
/// visibility to structural similarity", IEEE Trans. Image Processing 13(4), 2004; windows of 11x11 pixels with a
/// Gaussian of 1.5 pixels, cut to the region where it has fewer, K1 = 0.01, K2 = 0.03, the mean over all windows that
/// lie in the region, with all pixels. Codes are compared as fractions of their largest; other values as the 8-bit sRGB
/// codes of a preview, so the dynamic range L is 1. None for channels that are neither codes nor R, G, B, or Y alone,
/// and for regions without a window.
std::optional<double> ssim_of(const PlacedChannel& a, const PlacedChannel& b, const Region& region);

}  // namespace cistula
