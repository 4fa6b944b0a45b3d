#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/common/command_line.h"
#include "apps/common/picture_size.h"
#include "apps/common/view_options.h"
#include "scene/base/file_bytes.h"

namespace cistula {
namespace {

/// The options' texts as CLI11 stores them.
struct Texts {
    std::vector<std::string> files;
    std::string output, tiles, frames, crop, preview;
    ViewTexts view;
    bool quiet = false, version = false;
};

void declare(CLI::App& app, Texts& texts) {
    app.add_option("TILE.exr", texts.files, "the tiles of one frame, in any order")->type_name("");
    app.add_option("-o,--output", texts.output, "the whole frame's file; with --tiles the name that render was given")
        ->type_name("FILE");
    app.add_option("--tiles", texts.tiles, "the tiles of render's --tiles CxR, by the names that it gave them")
        ->type_name("CxR");
    app.add_option("-f,--frames", texts.frames, "with --tiles: the frames, e.g. 0-299x5,7")->type_name("LIST");
    app.add_option("--crop", texts.crop, "the pixels to be covered, where render had this crop; the full frame")
        ->type_name("WxH+X+Y");
    add_preview_options(app, texts.preview, texts.view);
    app.add_flag("-q,--quiet", texts.quiet, "errors only");
    app.add_flag("--version", texts.version, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

}  // namespace

MergeOptions parse_merge_options(int argc, const char* const* argv) {
    CLI::App app;
    Texts texts;
    declare(app, texts);
    MergeOptions options;
    const bool whole = parse_command_line(app, argc, argv, [](const std::string& extra) { return extra; });
    if (!whole || texts.version) {
        options.action = whole ? MergeAction::print_version : MergeAction::print_help;
        return options;
    }
    if (texts.output.empty()) fail_usage("no output is given: -o FILE.exr; --help tells more");
    options.output = OutputName(texts.output, "-o");
    if (lower_extension(texts.output) != ".exr")
        fail_usage(fmt::format("-o {}: tiles and what they make are EXRs; name it *.exr", texts.output));
    options.files = texts.files;
    if (!texts.tiles.empty()) options.grid = parse_tiles(texts.tiles);
    if (options.grid && !options.files.empty())
        fail_usage(fmt::format("{}: --tiles {} finds the tiles by their names; leave one out", options.files.front(),
                               texts.tiles));
    if (!options.grid && options.files.empty())
        fail_usage("no tiles are given: render-merge TILE.exr... -o FILE.exr, or --tiles CxR; --help tells more");
    if (!texts.frames.empty() && !options.grid)
        fail_usage(fmt::format("--frames {}: is for --tiles CxR; tiles that are named are of one frame", texts.frames));
    if (!texts.frames.empty()) options.frames = parse_frames(texts.frames);
    if (options.grid && options.output.has_pattern() && options.frames.empty())
        fail_usage(fmt::format("-o {}: has a place for frame numbers; --frames LIST says which", texts.output));
    if (!options.grid && options.output.has_pattern())
        fail_usage(fmt::format("-o {}: the tiles that are named are of one frame; give its name", texts.output));
    options.frames = frames_to_render(options.output, options.frames, 1);
    if (!texts.crop.empty()) options.window = parse_crop(texts.crop);
    options.view = parse_view(texts.view);
    for (const auto& [option, text] : {std::pair{"--exposure", texts.view.exposure},
                                       std::pair{"--view", texts.view.view}, std::pair{"--bloom", texts.view.bloom}})
        if (!text.empty() && texts.preview.empty())
            fail_usage(
                fmt::format("{} {}: is for --preview FILE.png; the image keeps the scene's light", option, text));
    options.preview = preview_name(texts.preview, options.frames);
    options.quiet = texts.quiet;
    return options;
}

std::string merge_help_text() {
    CLI::App app("Puts the tiles of a frame together: to the file, byte for byte, that one job would have written.",
                 "render-merge");
    Texts texts;
    declare(app, texts);
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
