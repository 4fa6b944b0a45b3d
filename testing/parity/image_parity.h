// Frames of the GPU against the CPU's, in the integers of their sums.
#pragma once

#include <string>

#include "testing/parity/record.h"

namespace cistula::bench {

/// Every scene in FOLDER/scenes and the folders inside it by both backends, and each against its golden hash, in both
/// precisions; a plain loop and a tree, split trees and whole ones.
void check_scenes(GpuRecord& record, const std::string& folder);

/// generated_scene(0) to generated_scene(count - 1), with the pictures and meshes of FOLDER/scenes, in both precisions.
void check_generated(GpuRecord& record, const std::string& folder, uint64_t count);

}  // namespace cistula::bench
