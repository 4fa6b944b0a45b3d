// The unparsed command line of `render`.
#pragma once

#include <string>

#include "apps/common/view_options.h"

namespace cistula {

/// The options' texts as CLI11 stores them; empty for options not given that have no default.
struct OptionTexts {
    std::string scene, output, preview, stats, frames, resolution, crop, tiles, tile, supersample, depth, lanes, cutoff,
        target_error, max_samples, threads, layers, z_far, dwa_level, device, pixel, json, explain, max_texture_gb;
    std::string backend = "embree", precision = "auto", effects = "auto", bits = "float", progress = "auto",
                color_space = "lin_rec709_scene", background = "opaque", compression = "zip", split = "none";
    ViewTexts view;
    bool resume = false, strict = false, quiet = false, verbose = false, version = false, print_template = false,
         list_devices = false;
};

}  // namespace cistula
