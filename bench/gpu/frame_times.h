// Kernel times of whole frames.
#pragma once

#include <string>

#include "testing/parity/record.h"

namespace cistula::bench {

/// FOLDER/scenes/benchmark.json at 3840x2160 in depth 4 and 8, in both precisions: kernel times of `runs` frames after
/// warm-up. And FOLDER/scenes/spheres.json at 1280x720 with 3 x 3 samples in depth 12, in float.
void time_frames(GpuRecord& record, const std::string& folder, int runs);

/// Times benchmark.json at 3840x2160 in depth 8 with 6 x 6 samples on one GPU, two, ... all: the slowest one's kernels,
/// and that the integers are equal.
void time_devices(GpuRecord& record, const std::string& folder, int runs);

}  // namespace cistula::bench
