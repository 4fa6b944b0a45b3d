#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/common/command_line.h"
#include "base/file_bytes.h"
#include "render/picture_size.h"

namespace cistula {
namespace {

void declare(CLI::App& app, MergeOptions& options) {
    RenderRequest& request = options.request;
    app.add_option("TILE.exr", options.files, "the tiles of one frame, in any order")->type_name("");
    add_key(app, request, "output", "the whole frame's file; with --tiles the name that render was given");
    CLI::Option* const tiles =
        add_key(app, request, "tiles", "the tiles of render's --tiles CxR, by the names that it gave them");
    add_key(app, request, "frames", "with --tiles: the frames, e.g. 0-299x5,7")->needs(tiles);
    add_key(app, request, "crop", "the pixels to be covered, where render had this crop; the full frame");
    for (const char* key : {"preview", "exposure", "view", "bloom", "quiet"}) add_key(app, request, key);
    app.add_flag_callback(
        "--version", [&] { options.action = MergeAction::print_version; }, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

}  // namespace

MergeOptions parse_merge_options(int argc, const char* const* argv) {
    CLI::App app;
    MergeOptions options;
    declare(app, options);
    const bool whole = parse_command_line(app, argc, argv, [](const std::string& extra) { return extra; });
    if (!whole) options.action = MergeAction::print_help;
    if (options.action != MergeAction::merge) return options;
    RenderRequest& request = options.request;
    check_request(request);
    const std::string& output = request.output;
    if (output.empty()) fail_usage("no output is given: -o FILE.exr; --help tells more");
    options.output = OutputName(output, "-o");
    if (lower_extension(output) != ".exr")
        fail_usage(fmt::format("-o {}: tiles and what they make are EXRs; name it *.exr", output));
    if (request.tiles && !options.files.empty())
        fail_usage(fmt::format("{}: --tiles {} finds the tiles by their names; leave one out", options.files.front(),
                               given_text(app, "--tiles")));
    if (!request.tiles && options.files.empty())
        fail_usage("no tiles are given: render-merge TILE.exr... -o FILE.exr, or --tiles CxR; --help tells more");
    if (request.tiles && options.output.has_pattern() && request.frames.empty())
        fail_usage(fmt::format("-o {}: has a place for frame numbers; --frames LIST says which", output));
    if (!request.tiles && options.output.has_pattern())
        fail_usage(fmt::format("-o {}: the tiles that are named are of one frame; give its name", output));
    request.frames = frames_to_render(options.output, request.frames, 1);
    options.preview = preview_name(request.preview, request.frames);
    return options;
}

std::string merge_help_text() {
    CLI::App app("Puts the tiles of a frame together: to the file, byte for byte, that one job would have written.",
                 "render-merge");
    MergeOptions options;
    declare(app, options);
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
