// Compares frames of the GPU with the CPU's, in the integers of their sums.
#pragma once

#include <string>

#include "testing/parity/record.h"

namespace cistula::bench {

/// Compares every scene in FOLDER/scenes and the folders inside it between both backends and with its golden hash, in
/// both precisions; with the chosen path and always with a tree, with the needed and with all effects.
void check_scenes(GpuRecord& record, const std::string& folder);

/// Compares generated_scene(0) to generated_scene(count - 1), with the pictures and meshes of FOLDER/scenes, in both
/// precisions.
void check_generated(GpuRecord& record, const std::string& folder, uint64_t count);

}  // namespace cistula::bench
