// What the effects cost that a scene does not call for, and what each mask's kernels take of a GPU.
#pragma once

#include <string>

#include "testing/parity/record.h"

namespace cistula::bench {

/// Every scene of effect_scenes at 1280x720 with one sample a pixel, those of depth 4 with 4 x 4 too, with the mask it
/// calls for and with the largest, in turns: medians of `runs`, and that the integers are the same. Then the resources
/// of all kernels.
void time_effects(GpuRecord& record, const std::string& folder, int runs);

}  // namespace cistula::bench
