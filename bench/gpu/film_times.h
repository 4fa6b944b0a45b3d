// How well a film's parts overlap: the kernels alone, the writers alone, and the whole film.
#pragma once

#include <string>

#include "testing/parity/record.h"

namespace cistula::bench {

/// FOLDER/scenes/benchmark.json at 1280x720, 3 x 3 samples a pixel, depth 4, in single precision, to EXRs in a
/// temporary directory; `frames` films are held in memory. The entry of the whole film has `overlap`: the slower of
/// kernels and writers, each timed alone, over its own time.
void time_film(GpuRecord& record, const std::string& folder, int frames);

}  // namespace cistula::bench
