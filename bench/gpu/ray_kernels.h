// The kernels of the ray benchmark, for the host.
#pragma once

#include <driver_types.h>

#include "testing/parity/ray_work.h"

namespace cistula::bench {

enum class RayStep { primary_rays, primary_hits, further_rays, bounced_hits, light };

template <class Real>
struct RayJob {
    SceneView<Real> scene;  // in device memory
    FrameView frame;
    RayArrays<Real> arrays;  // in device memory, of ray_count
};

/// A thread a ray.
template <class Real>
void launch_rays(RayStep step, const RayJob<Real>& job, cudaStream_t stream);

struct KernelFacts {
    int registers = 0;               // of a thread
    size_t local_bytes = 0;          // ... in memory
    int blocks = 0, block_rays = 0;  // that share a multiprocessor, and their threads
};
template <class Real>
KernelFacts ray_kernel_facts(RayStep step);

}  // namespace cistula::bench
