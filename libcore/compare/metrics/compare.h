// Comparison of two files of pictures by channel: sizes of differences, and what differs beside values.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compare/metrics/channel_statistics.h"
#include "compare/metrics/flip.h"
#include "compare/metrics/selection.h"
#include "image/picture/picture.h"
#include "image/picture/stored_picture.h"

namespace cistula {

/// Allowed differences. By default none: every bit counts.
struct Thresholds {
    std::optional<double> fail;      // a pixel fails if a channel differs by more
    double failpercent = 0;          // percentage of pixels that may fail
    std::optional<double> hardfail;  // no pixel may differ by more
    std::optional<double> flip;      // the mean of FLIP may be no more
    std::optional<double> ssim;      // of no channel it may be less
    bool allow_nonfinite = false;    // NaN and infinities that both have in the same places pass

    bool any() const { return fail || hardfail || flip || ssim; }
};

struct Comparison {
    std::vector<std::string> structure;  // differences of parts, windows and channels: never allowed
    std::vector<std::string> header;     // differences of attributes and channel types: allowed if there are thresholds
    bool compares_headers = true;        // false: the formats are different
    std::vector<std::string> not_compared;    // what the verdict says nothing of
    std::vector<std::string> units;           // what differences are counted in, where that is no plain number
    std::vector<ChannelStatistics> channels;  // of pictures with pixels in common
    size_t pixels = 0;  // that count; pixels of parts with one window are one pixel, as channels of one part are
    size_t over_fail = 0;
    size_t over_hardfail = 0;
    double max = 0;
    std::optional<FlipResult> flip;  // where it was asked for

    size_t values() const;     // compared, in all channels
    size_t differing() const;  // those with different bits
    bool has_only_floats() const;
    size_t nonfinite(NonfiniteValues ChannelStatistics::*kind) const;  // in all channels
    std::optional<double> least_ssim() const;                          // of the channels that have one
};

/// Whether values of two files can count: some windows are the same, or may differ.
bool compares_values(const StoredFile& a, const StoredFile& b, const Selection& selection);

/// Parts are matched by their names where all have one, else by their order. Metrics that the selection or a threshold
/// asks for are taken. Throws Error: `usage` for a selection that fits neither file, `interrupted`.
Comparison compare_files(const StoredFile& a, const StoredFile& b, const Thresholds& thresholds,
                         const Selection& selection = {}, StopSignal stop = {});

Comparison compare_pictures(const LayeredPicture& a, const LayeredPicture& b, const Thresholds& thresholds,
                            const Selection& selection = {}, StopSignal stop = {});

/// Whether the differences are within the thresholds; without thresholds, whether the pictures are bitwise equal.
bool passes(const Comparison& comparison, const Thresholds& thresholds);

/// The absolute differences of the chosen channels that both files have, in the parts of the first at their whole
/// resolution, over the pixels that are compared; 0 where the mask counts none. Empty where no pixel has a partner.
std::vector<PicturePart> difference_parts(const StoredFile& a, const StoredFile& b, const Selection& selection = {});

}  // namespace cistula
