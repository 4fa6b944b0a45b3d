// The pixels of a failed case that differ most, and why each side has its value.
#pragma once

#include <string>
#include <vector>

#include "compare/suite/suite_judge.h"

namespace cistula {

/// A pixel, counted from the top left of the full frame.
struct SuitePixel {
    int x = 0;
    int y = 0;
    double difference = 0;  // the largest of a channel
};

/// The differences of a golden image and a render with the same data window: of each pixel the largest of the channels
/// that both have. Where values are equal and bits are not, the least positive number.
std::vector<double> pixel_differences(const LayeredPicture& golden, const LayeredPicture& fresh);

/// The pixels that differ most, at most `count`, none of them beside another one.
std::vector<SuitePixel> worst_pixels(const LayeredPicture& fresh, const std::vector<double>& differences, size_t count);

/// How a pixel's value comes about, as render --pixel tells it, or why that is not known.
struct SuitePixelWhy {
    std::string golden, fresh;            // trees; empty: not known
    std::string golden_note, fresh_note;  // what there is to say beside or in the place of a tree, one line
};

/// The trees of both sides, of so many branches at most. That of the golden image is known where its header names the
/// same scene and camera: then its own precision, depth, samples and cutoff are followed, and shown where they give its
/// value to the last bit.
SuitePixelWhy why_pixel(const SuiteResult& result, const std::string& folder, const LayeredPicture* golden,
                        const LayeredPicture& fresh, const SuitePixel& pixel, StopSignal stop);

}  // namespace cistula
