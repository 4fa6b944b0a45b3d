// The tasks of a film: frames by tiles, in portions of about equal time.
#pragma once

#include <vector>

#include "sequence/frame_list.h"

namespace cistula {

/// Frames of one tile that a machine renders one after the other.
struct FarmTask {
    std::vector<int> frames;
    int tile = 0;
    double seconds = 0;  // estimated

    bool operator==(const FarmTask&) const = default;
};

/// The estimated seconds of each tile of some frames of a film, from which those of all follow: between two measured
/// frames linearly, by the place in the film.
struct MeasuredFrames {
    std::vector<size_t> indices;               // in the film, ascending
    std::vector<std::vector<double>> seconds;  // of each, by tile

    double of(size_t index, size_t tile) const;
};

/// The indices of at most `most` of so many frames, evenly from the first to the last.
std::vector<size_t> frames_to_measure(size_t frames, size_t most);

/// The tasks, in the order of their first frames: of each tile as many frames in a row as take `seconds`, one at least.
/// Longer ones if there would be more than `most`. Throws Error (usage) if there are more tiles than that.
std::vector<FarmTask> plan_tasks(const std::vector<int>& frames, size_t tiles, const MeasuredFrames& measured,
                                 double seconds, size_t most);

}  // namespace cistula
