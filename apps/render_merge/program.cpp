// render-merge: puts the tiles of frames together.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "apps/common/command_line.h"
#include "base/error.h"
#include "image/color/color_space.h"
#include "image/exr/exr.h"
#include "image/picture/picture.h"
#include "image/picture/picture_io.h"
#include "image/view/picture_view.h"
#include "options.h"
#include "sequence/merge.h"
#include "sequence/run_files.h"

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace cistula {
namespace {

namespace fs = std::filesystem;

/// A file to be made, and the tiles that it is made of.
struct FileToMerge {
    std::string path;
    std::vector<std::string> tiles;
};

/// The names in folders, each read once.
class Folders {
  public:
    const std::set<std::string>& names(const fs::path& folder) {
        const auto [found, is_new] = names_.emplace(folder.string(), std::set<std::string>());
        std::error_code error;
        if (is_new)
            for (const auto& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, error))
                found->second.insert(entry.path().filename().string());
        return found->second;
    }

  private:
    std::map<std::string, std::set<std::string>> names_;
};

/// The layers that have files beside the main one of this name.
std::vector<std::string> layers_beside(const OutputName& name, int frame, Folders& folders) {
    const std::string mark(1, '\1');
    const fs::path example = name.for_layer(frame, mark);
    const std::string file = example.filename().string();
    const std::string before = file.substr(0, file.find(mark));
    const std::string after = file.substr(file.find(mark) + 1);
    const std::string snapshot = fs::path(snapshot_of(name, frame)).filename().string();
    std::vector<std::string> layers;
    const std::set<std::string>& names = folders.names(example.parent_path());
    for (auto own = names.lower_bound(before); own != names.end() && own->starts_with(before); ++own) {
        if (own->size() <= before.size() + after.size() || !own->ends_with(after) || *own == snapshot) continue;
        const std::string layer = own->substr(before.size(), own->size() - before.size() - after.size());
        if (is_layer_file(name.for_layer(frame, layer), layer)) layers.push_back(layer);
    }
    return layers;
}

void require_tiles(const FileToMerge& file, const TileGrid& grid, int frame) {
    std::error_code error;
    size_t missing = 0;
    size_t first = 0;
    for (size_t i = 0; i < file.tiles.size(); ++i)
        if (!fs::exists(file.tiles[i], error) && missing++ == 0) first = i;
    if (missing == 0) return;
    throw Error(ErrorKind::file,
                fmt::format("{}: {} of its {} tiles {} missing: {}{}; render --tiles {}x{} --tile {} -f {} makes it",
                            file.path, missing, file.tiles.size(), missing == 1 ? "is" : "are", file.tiles[first],
                            missing == 1 ? "" : " and others", grid.columns, grid.rows, first, frame));
}

/// The files of a frame: those of layers that have their own (--split files), found beside the first tile, then the
/// main one. Throws Error (file) for tiles that are missing, with the option of render that makes the first of them.
std::vector<FileToMerge> files_to_merge(const MergeOptions& options, int frame, Folders& folders) {
    FileToMerge main{options.output.for_frame(frame), options.files};
    if (!options.request.tiles) return {main};
    std::vector<OutputName> names;
    for (int i = 0; i < options.request.tiles->count(); ++i)
        names.push_back(options.output.named(tile_name(*options.request.tiles, i)));
    for (const OutputName& name : names) main.tiles.push_back(name.for_frame(frame));
    std::vector<FileToMerge> files;
    for (const std::string& layer : layers_beside(names.front(), frame, folders)) {
        FileToMerge& file = files.emplace_back(FileToMerge{options.output.for_layer(frame, layer), {}});
        for (const OutputName& name : names) file.tiles.push_back(name.for_layer(frame, layer));
    }
    files.push_back(std::move(main));
    for (const FileToMerge& file : files) require_tiles(file, *options.request.tiles, frame);
    return files;
}

const std::vector<float>& channel(const LayeredPicture& frame, const char* name, const std::string& path) {
    if (const LayeredPicture::Channel* found = channel_of(frame, name)) return found->values;
    throw Error(ErrorKind::usage, fmt::format("--preview {}: the tiles have no channel {}", path, name));
}

/// Writes the R, G and B of a frame as the PNG that render's --preview is: the very one where they are floats. Throws
/// Error: usage where a preview cannot be made of them, since the background was left out or they are of another color
/// space; file where it cannot be written.
void write_merged_preview(const std::string& path, const LayeredPicture& frame, const PictureView& view) {
    const auto refuse = [&](const char* what) {
        throw Error(ErrorKind::usage, fmt::format("--preview {}: {}; cistula view shows the merged file", path, what));
    };
    if (frame.attributes.count("cistula:background") != 0) refuse("the tiles' background was left out");
    const auto* id = attribute_of<std::string>(frame, "colorInteropID");
    if (id != nullptr && *id != color_spaces().front().id) refuse("the tiles are of another color space");
    const std::vector<float>&r = channel(frame, "R", path), &g = channel(frame, "G", path),
          &b = channel(frame, "B", path);
    ColorPicture picture{static_cast<uint32_t>(frame.width), static_cast<uint32_t>(frame.height), {}};
    picture.texels.reserve(r.size());
    for (size_t i = 0; i < r.size(); ++i) picture.texels.emplace_back(r[i], g[i], b[i]);
    write_preview(path, viewed(std::move(picture), view, static_cast<uint32_t>(frame.display_height)));
}

/// Checks the names of a frame's files against each other.
void require_different_files(const std::vector<FileToMerge>& files, const std::string& preview) {
    RunFiles all;
    for (const FileToMerge& file : files)
        for (const std::string& tile : file.tiles) all.reads(tile, "a tile");
    for (const FileToMerge& file : files) all.writes(file.path, "the whole frame");
    all.writes(preview, "a preview");
}

void merge_frame(const MergeOptions& options, int frame, Folders& folders) {
    const std::vector<FileToMerge> files = files_to_merge(options, frame, folders);
    const std::string preview = options.preview.for_frame(frame);
    const PixelRect& crop = options.request.frame.crop;
    require_different_files(files, preview);
    std::vector<Merge> merges;
    for (const FileToMerge& file : files) {
        Merge& merge = merges.emplace_back(crop.width > 0 ? std::optional(crop) : std::nullopt);
        for (const std::string& tile : file.tiles) merge.add(tile);
        merge.check_whole();
    }
    for (size_t i = 0; i + 1 < merges.size(); ++i) merges[i].check_beside(merges.back());
    for (size_t i = 0; i < files.size(); ++i) {
        const std::vector<PicturePart> whole = std::move(merges[i]).whole();
        if (!preview.empty() && i + 1 == files.size())
            write_merged_preview(preview, whole.front().picture, options.request.view);
        write_exr(files[i].path, whole);
    }
    if (!options.request.quiet)
        note(fmt::format("render-merge: {}: {} tiles", files.back().path, files.back().tiles.size()));
}

void merge(MergeOptions options) {
    const std::string warning = open_config_view(options.request.view);
    if (!warning.empty() && !options.request.quiet) note(fmt::format("render-merge: warning: {}", warning));
    set_exr_threads(tbb::this_task_arena::max_concurrency());
    Folders folders;
    for (const int frame : options.request.frames) {
        make_directories(options.output, {frame});
        if (!options.preview.text().empty()) make_directories(options.preview, {frame});
        merge_frame(options, frame, folders);
    }
}

void run(const MergeOptions& options) {
    switch (options.action) {
        case MergeAction::print_help:
            return print(merge_help_text());
        case MergeAction::print_version:
            return print("render-merge (Cistula) " CISTULA_VERSION "\n");
        case MergeAction::merge:
            return merge(options);
    }
}

}  // namespace

int render_merge_program(int argc, const char* const* argv) {
    return run_program("render-merge", "a whole frame is held at a time; one of fewer layers needs less", [&] {
        run(parse_merge_options(argc, argv));
        return static_cast<int>(ExitCode::done);
    });
}

}  // namespace cistula
