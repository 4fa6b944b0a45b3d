#include "frame_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scene/base/error.h"

namespace cistula {
namespace {

namespace fs = std::filesystem;

/// The layers that have files beside the main one of this name.
std::vector<std::string> layers_beside(const OutputName& name, int frame) {
    const std::string mark(1, '\1');
    const fs::path example = name.for_layer(frame, mark);
    const std::string file = example.filename().string();
    const std::string before = file.substr(0, file.find(mark)), after = file.substr(file.find(mark) + 1);
    const std::string snapshot = fs::path(snapshot_of(name, frame)).filename().string();
    std::vector<std::string> layers;
    std::error_code error;
    const fs::path folder = example.parent_path();
    for (const auto& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, error)) {
        const std::string own = entry.path().filename().string();
        if (own.size() > before.size() + after.size() && own.starts_with(before) && own.ends_with(after) &&
            own != snapshot)
            layers.push_back(own.substr(before.size(), own.size() - before.size() - after.size()));
    }
    std::sort(layers.begin(), layers.end());
    return layers;
}

void require_tiles(const FileToMerge& file, const TileGrid& grid, int frame) {
    std::error_code error;
    size_t missing = 0, first = 0;
    for (size_t i = 0; i < file.tiles.size(); ++i)
        if (!fs::exists(file.tiles[i], error) && missing++ == 0) first = i;
    if (missing == 0) return;
    throw Error(ExitCode::file,
                fmt::format("{}: {} of its {} tiles {} missing: {}{}; render --tiles {}x{} --tile {} -f {} makes it",
                            file.path, missing, file.tiles.size(), missing == 1 ? "is" : "are", file.tiles[first],
                            missing == 1 ? "" : " and others", grid.columns, grid.rows, first, frame));
}

}  // namespace

std::vector<FileToMerge> files_to_merge(const MergeOptions& options, int frame) {
    FileToMerge main{options.output.for_frame(frame), options.files};
    if (!options.grid) return {main};
    std::vector<OutputName> names;
    for (int i = 0; i < options.grid->count(); ++i) names.push_back(options.output.named(tile_name(*options.grid, i)));
    for (const OutputName& name : names) main.tiles.push_back(name.for_frame(frame));
    std::vector<FileToMerge> files;
    for (const std::string& layer : layers_beside(names.front(), frame)) {
        FileToMerge& file = files.emplace_back(FileToMerge{options.output.for_layer(frame, layer), {}});
        for (const OutputName& name : names) file.tiles.push_back(name.for_layer(frame, layer));
    }
    files.push_back(std::move(main));
    for (const FileToMerge& file : files) require_tiles(file, *options.grid, frame);
    return files;
}

}  // namespace cistula
