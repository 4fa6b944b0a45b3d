// How fast rays are traced through a large mesh, and whether they find what the host finds.
#pragma once

#include "testing/parity/record.h"

namespace cistula::bench {

/// On a bumpy sphere of 1.3 million triangles, in both precisions: the rays of a 3840x2160 picture, a
/// cosine-distributed one from each place that they hit, one from there to a point light. Medians of `runs` after
/// warm-up; every ray and all that it found are compared with the host's, bit for bit.
void time_rays(GpuRecord& record, int runs);

}  // namespace cistula::bench
