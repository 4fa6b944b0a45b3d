// The two ways to run the course work's algorithm. Each is compiled by itself, with the flags that such a program has.
#pragma once

#include <string>
#include <vector>

#include "base/timing.h"
#include "bench/seed_baseline.h"

namespace cistula::seed {

/// ray<depth> is compiled for these.
inline constexpr int depths[] = {1, 2, 4, 8};

/// One of `depths`, or nothing is drawn.
void render_on_host(int depth, const Scene& scene, const View& view, Pixel* pixels);

struct DeviceDescription {
    std::string name;
    // compute capability
    int major = 0;
    int minor = 0;
    std::string driver, runtime;  // the CUDA versions of both, "13.0"
    std::string compiler;
};

/// The first GPU. Throws Error (device) with CUDA's own words where there is none.
DeviceDescription describe_device();

struct DeviceRun {
    Timing time;  // of the kernel, by events
    std::vector<Pixel> pixels;
};

/// A grid of grid x grid blocks of 16 x 16 threads, after warm-up. Throws Error (device).
DeviceRun render_on_device(int depth, int grid, int warm_ups, int repetitions, const OwnedScene& scene,
                           const View& view);

}  // namespace cistula::seed
