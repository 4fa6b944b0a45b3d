// Results of a frame with --target-error: the proven bound on truncation, the pixels where sampling had to stop, and
// those where rounding is too coarse for the target.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/film/film.h"
#include "scene/film/renderer.h"

namespace cistula {

/// Numbers of pixels that missed the target, by reason.
struct TargetReport {
    uint64_t samples = 0;         // of all pixels
    uint64_t truncated = 0;       // pixels whose error bound exceeds a quarter of the target in any channel
    uint64_t bushy = 0;           // of these, pixels whose ray trees had more branches than are followed
    uint64_t undersampled = 0;    // pixels that needed more samples than allowed
    uint64_t rounded = 0;         // pixels with edges that rounding may move by an amount worth the target
    uint64_t missed = 0;          // pixels of any of these kinds
    double worst_truncation = 0;  // the largest error bound of any pixel and channel, in the scene's units of radiance

    void add(const TargetReport& other);
};

/// The report on the film of a frame with a target error.
TargetReport target_report(const Film& film, const FrameSettings& settings);

struct FrameStats;

/// One line for all frames, which suggests what would reach the target if it was missed.
std::string describe_target(const std::vector<FrameStats>& frames, const FrameSettings& settings, Precision precision);

}  // namespace cistula
