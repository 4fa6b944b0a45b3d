// Results of a frame with a target error: the proven bound on truncation; the measured rate of pixels whose sampling,
// an estimate, misses the target; and the pixels that are known to miss it.
#pragma once

#include <cstdint>

#include "render/record/film.h"
#include "render/renderer.h"

namespace cistula {

/// Numbers of pixels that missed the target, by reason.
struct TargetReport {
    uint64_t samples = 0;         // of all pixels
    uint64_t truncated = 0;       // pixels whose error bound exceeds a quarter of the target in any channel
    uint64_t coarse = 0;          // of these, pixels that whole units of the sums alone may take that from
    uint64_t bushy = 0;           // of the others, pixels whose ray trees had more branches than are followed
    uint64_t undersampled = 0;    // pixels that needed more samples than allowed
    uint64_t rounded = 0;         // pixels with edges that rounding may move by an amount worth the target
    uint64_t missed = 0;          // pixels of any of these kinds
    uint64_t checked = 0;         // pixels that took all samples of the lattice after those that they wanted
    uint64_t off = 0;             // of these, pixels whose estimate was farther than the target from the mean of all
    double worst_truncation = 0;  // the largest error bound of any pixel and channel, in the scene's units of radiance

    void add(const TargetReport& other);
    /// Whether the ledger proves that truncation took no more than a quarter of the target from any pixel.
    bool proven() const { return truncated == 0; }
};

/// The report on the film of a frame with a target error.
TargetReport target_report(const Film& film, const FrameSettings& settings);

}  // namespace cistula
