// How far a frame with --target-error came: what is proven of truncation, where sampling had to stop, and where places
// are too coarse for it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/film/film.h"
#include "scene/film/renderer.h"

namespace cistula {

/// How many pixels of a frame missed the target, by reasons.
struct TargetReport {
    uint64_t samples = 0;         // of all pixels
    uint64_t truncated = 0;       // pixels whose ledger is above a quarter of the target, in any channel
    uint64_t bushy = 0;           // of these, pixels with trees of more branches than are followed
    uint64_t undersampled = 0;    // pixels that wanted more samples than they may have
    uint64_t rounded = 0;         // pixels with borders that rounding may move by what is worth the target
    uint64_t missed = 0;          // pixels of any of these kinds
    double worst_truncation = 0;  // the largest ledger of any pixel and channel, in the scene's units of radiance

    void add(const TargetReport& other);
};

/// Judges the film of a frame that has a target error.
TargetReport target_report(const Film& film, const FrameSettings& settings);

struct FrameStats;

/// One line for all frames; says what would reach the target where it was missed.
std::string describe_target(const std::vector<FrameStats>& frames, const FrameSettings& settings, Precision precision);

}  // namespace cistula
