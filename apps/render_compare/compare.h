// Two pictures, channel by channel: how far apart they are, and what differs beside the floats.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "scene/image/picture.h"

namespace cistula {

/// |a - b|; 0 for two NaNs and for the same infinity twice, infinity where only one is finite or the signs of
/// infinities differ.
double difference(float a, float b);

/// What may differ. None given: nothing, every bit counts.
struct Thresholds {
    std::optional<double> fail;      // a pixel fails where a channel differs by more
    double failpercent = 0;          // as many pixels may fail
    std::optional<double> hardfail;  // no pixel may differ by more

    bool any() const { return fail || hardfail; }
};

/// How a channel that both pictures have differs between them.
struct ChannelStatistics {
    std::string name;
    size_t differing = 0;  // floats of other bits
    size_t infinite = 0;   // infinite differences; max knows them, mean, rmse and psnr leave them out
    double max = 0, mean = 0, rmse = 0;
    double psnr = INFINITY;  // dB; the peak is the largest finite magnitude in either channel, at least 1
    int x = 0, y = 0;        // the largest difference, else the first float of other bits; from the display window
    float a = 0, b = 0;      // what stands there
};

struct Comparison {
    std::vector<std::string> structure;  // windows and channels: what no threshold forgives
    std::vector<std::string> header;     // attributes and the type of channels: forgiven where there are thresholds
    std::vector<ChannelStatistics> channels;  // none where the data windows differ
    size_t pixels = 0, over_fail = 0, over_hardfail = 0;
    double max = 0;

    size_t differing() const;  // floats of other bits in all channels
};

Comparison compare_pictures(const LayeredPicture& a, const LayeredPicture& b, const Thresholds& thresholds);

/// Whether the thresholds hold; without them, whether the pictures are equal in every bit.
bool passes(const Comparison& comparison, const Thresholds& thresholds);

/// The differences, channel by channel. The data windows must be equal.
LayeredPicture difference_picture(const LayeredPicture& a, const LayeredPicture& b);

}  // namespace cistula
