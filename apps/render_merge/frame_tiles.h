// The files that a frame's tiles are merged from, and those that they are merged to.
#pragma once

#include <string>
#include <vector>

#include "options.h"

namespace cistula {

/// A file to be made, and the tiles that it is made of.
struct FileToMerge {
    std::string path;
    std::vector<std::string> tiles;
};

/// The files of a frame: those of layers that have their own (--split files), found beside the first tile, then the
/// main one. Throws Error (file) for tiles that are missing, with the option of render that makes the first of them.
std::vector<FileToMerge> files_to_merge(const MergeOptions& options, int frame);

}  // namespace cistula
