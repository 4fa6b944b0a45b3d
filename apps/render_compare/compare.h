// Comparison of two pictures by channel: sizes of differences, and differences other than floats.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/image/picture.h"

namespace cistula {

/// |a - b|; 0 for two NaNs and for two equal infinities, infinity if only one is finite or the infinities have
/// different signs.
double difference(float a, float b);

/// Allowed differences. By default none: every bit counts.
struct Thresholds {
    std::optional<double> fail;      // a pixel fails if a channel differs by more
    double failpercent = 0;          // percentage of pixels that may fail
    std::optional<double> hardfail;  // no pixel may differ by more

    bool any() const { return fail || hardfail; }
};

/// Differences in a channel that both pictures have.
struct ChannelStatistics {
    std::string name;
    size_t differing = 0;  // floats with different bits
    size_t infinite = 0;   // infinite differences; included in max, excluded from mean, rmse and psnr
    double max = 0, mean = 0, rmse = 0;
    double psnr = INFINITY;  // dB; the peak is the largest finite magnitude in either channel, at least 1
    int x = 0, y = 0;        // largest difference, or first float with different bits; origin at the display window
    float a = 0, b = 0;      // the two values there
};

struct Comparison {
    std::vector<std::string> structure;  // differences of windows and channels: never allowed
    std::vector<std::string> header;     // differences of attributes and channel types: allowed if there are thresholds
    std::vector<ChannelStatistics> channels;  // empty if the data windows differ
    size_t pixels = 0, over_fail = 0, over_hardfail = 0;
    double max = 0;

    size_t differing() const;  // floats with different bits in all channels
};

Comparison compare_pictures(const LayeredPicture& a, const LayeredPicture& b, const Thresholds& thresholds);

/// Whether the differences are within the thresholds; without thresholds, whether the pictures are bitwise equal.
bool passes(const Comparison& comparison, const Thresholds& thresholds);

/// The differences by channel as a picture. The data windows must be equal.
LayeredPicture difference_picture(const LayeredPicture& a, const LayeredPicture& b);

}  // namespace cistula
