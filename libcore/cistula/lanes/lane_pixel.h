// What lanes render: the pixels of a tile, or single samples.
#pragma once

#include "cistula/adaptive/path_hash.h"
#include "cistula/model/layers.h"
#include "cistula/transport/tree_threshold.h"

namespace cistula {

/// What lanes learn of a sample that is rendered by itself, beside its record.
struct LaneSample {
    TreeThreshold threshold;  // if it did not hold: the next one to try
    bool holds = false;
    uint32_t path_hash = 0;  // of frames with a target error
};

/// Samples that lanes render into one record: a pixel of a tile, or a sample by itself.
struct LanePixel {
    int x, y;          // in the full frame
    int first, count;  // samples of the pixel's grid
    TreeThreshold threshold;
    PixelRecord* record;
    PixelLayers layers = {};       // of effects with fills_layers
    LaneSample* sample = nullptr;  // if it is one by itself
    uint32_t rays = 0;             // of all kinds
    int64_t left = 0;              // of the budget
    // of a sample by itself
    uint32_t reflected = 0;
    uint32_t shadow = 0;
    uint32_t branches = 0;
    uint32_t path_hash = 0;

    /// Whether the sample has more branches than a frame with a target error follows.
    CISTULA_INLINE bool is_too_large(bool adaptive) const { return adaptive && branches > most_branches; }
};

}  // namespace cistula
