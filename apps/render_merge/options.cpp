#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/common/command_line.h"
#include "apps/common/view_options.h"
#include "base/file_bytes.h"
#include "render/picture_size.h"

namespace cistula {
namespace {

void declare(CLI::App& app, MergeOptions& options, std::string& preview) {
    app.add_option("TILE.exr", options.files, "the tiles of one frame, in any order")->type_name("");
    add_option(app, "-o,--output", "FILE", "the whole frame's file; with --tiles the name that render was given",
               [&](const char*, const std::string& text) {
                   options.output = OutputName(text, "-o");
                   if (lower_extension(text) != ".exr")
                       fail_usage(fmt::format("-o {}: tiles and what they make are EXRs; name it *.exr", text));
               });
    CLI::Option* const tiles =
        add_option(app, "--tiles", "CxR", "the tiles of render's --tiles CxR, by the names that it gave them",
                   read_by(options.grid, parse_tiles));
    add_option(app, "-f,--frames", "LIST", "with --tiles: the frames, e.g. 0-299x5,7",
               read_by(options.frames, parse_frames))
        ->needs(tiles);
    add_option(app, "--crop", "WxH+X+Y", "the pixels to be covered, where render had this crop; the full frame",
               read_by(options.window, parse_crop));
    add_preview_options(app, preview, options.view);
    app.add_flag("-q,--quiet", options.quiet, "errors only");
    app.add_flag_callback(
        "--version", [&] { options.action = MergeAction::print_version; }, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

}  // namespace

MergeOptions parse_merge_options(int argc, const char* const* argv) {
    CLI::App app;
    MergeOptions options;
    std::string preview;
    declare(app, options, preview);
    const bool whole = parse_command_line(app, argc, argv, [](const std::string& extra) { return extra; });
    if (!whole) options.action = MergeAction::print_help;
    if (options.action != MergeAction::merge) return options;
    const std::string& output = options.output.text();
    if (output.empty()) fail_usage("no output is given: -o FILE.exr; --help tells more");
    if (options.grid && !options.files.empty())
        fail_usage(fmt::format("{}: --tiles {} finds the tiles by their names; leave one out", options.files.front(),
                               given_text(app, "--tiles")));
    if (!options.grid && options.files.empty())
        fail_usage("no tiles are given: render-merge TILE.exr... -o FILE.exr, or --tiles CxR; --help tells more");
    if (options.grid && options.output.has_pattern() && options.frames.empty())
        fail_usage(fmt::format("-o {}: has a place for frame numbers; --frames LIST says which", output));
    if (!options.grid && options.output.has_pattern())
        fail_usage(fmt::format("-o {}: the tiles that are named are of one frame; give its name", output));
    options.frames = frames_to_render(options.output, options.frames, 1);
    options.preview = preview_name(preview, options.frames);
    return options;
}

std::string merge_help_text() {
    CLI::App app("Puts the tiles of a frame together: to the file, byte for byte, that one job would have written.",
                 "render-merge");
    MergeOptions options;
    std::string preview;
    declare(app, options, preview);
    app.footer(R"(
Examples:
  render-merge f.tile0.exr f.tile1.exr -o f.exr
  render-merge --tiles 4x3 -f 0-299 -o out/beauty.####.exr
  render-merge --tiles 4x3 -f 0-299 -o out/beauty.####.exr --preview out/p.####.png --bloom 2

Tiles of another scene, of other settings or of another version are refused, and so are pixels in two tiles or in none.

Exit codes: 0 done, 1 the tiles make no whole, 2 command line, 3 file.)");
    return app.help();
}

}  // namespace cistula
