// The command line of `render` as it was written.
#pragma once

#include <string>

namespace cistula {

/// The options' texts as CLI11 leaves them; empty where an option without a default is not given.
struct OptionTexts {
    std::string scene, output, preview, stats, frames, resolution, crop, supersample, depth, cutoff, target_error,
        max_samples, threads, layers, device, pixel, json, explain;
    std::string backend = "embree", precision = "float", intersector = "exact", effects = "auto", bits = "float",
                progress = "auto";
    bool resume = false, quiet = false, verbose = false, version = false, print_template = false, list_devices = false;
};

}  // namespace cistula
