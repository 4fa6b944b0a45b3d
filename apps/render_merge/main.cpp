// render-merge: puts the tiles of frames together.
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "apps/common/command_line.h"
#include "apps/common/run_files.h"
#include "apps/common/view_options.h"
#include "frame_tiles.h"
#include "merge.h"
#include "options.h"
#include "preview.h"
#include "scene/base/error.h"
#include "scene/image/exr.h"

namespace cistula {
namespace {

/// Checks the names of a frame's files against each other.
void require_different_files(const std::vector<FileToMerge>& files, const std::string& preview) {
    RunFiles all;
    for (const FileToMerge& file : files)
        for (const std::string& tile : file.tiles) all.reads(tile, "a tile");
    for (const FileToMerge& file : files) all.writes(file.path, "the whole frame");
    all.writes(preview, "a preview");
}

void merge_frame(const MergeOptions& options, int frame) {
    const std::vector<FileToMerge> files = files_to_merge(options, frame);
    const std::string preview = options.preview.for_frame(frame);
    require_different_files(files, preview);
    for (const FileToMerge& file : files) {
        Merge merge(options.window);
        for (const std::string& tile : file.tiles) merge.add(tile);
        const std::vector<PicturePart> whole = std::move(merge).whole();
        if (!preview.empty() && &file == &files.back())
            write_merged_preview(preview, whole.front().picture, options.view);
        write_exr(file.path, whole);
    }
    if (!options.quiet) note(fmt::format("render-merge: {}: {} tiles", files.back().path, files.back().tiles.size()));
}

void merge(MergeOptions options) {
    const std::string warning = open_config_view(options.view);
    if (!warning.empty() && !options.quiet) note(fmt::format("render-merge: warning: {}", warning));
    const int threads = tbb::this_task_arena::max_concurrency();
    set_exr_threads(threads, threads);
    for (const int frame : options.frames) {
        make_directories(options.output, {frame});
        if (!options.preview.text().empty()) make_directories(options.preview, {frame});
        merge_frame(options, frame);
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
}  // namespace cistula

int main(int argc, char** argv) {
    using namespace cistula;
    return run_program("render-merge", "a whole frame is held at a time; one of fewer layers needs less", [&] {
        run(parse_merge_options(argc, argv));
        return static_cast<int>(ExitCode::done);
    });
}
