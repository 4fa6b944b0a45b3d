#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <filesystem>

#include "apps/common/command_line.h"
#include "apps/common/render_options.h"
#include "base/file_bytes.h"
#include "sequence/run_files.h"

namespace cistula {
namespace {

constexpr int most_columns = 1000;

/// Adds the options; `request`: how colors are shown.
void declare(CLI::App& app, ViewOptions& options, RenderRequest& request) {
    app.add_option("FILE.exr", options.file, "the image")->type_name("");
    app.add_option("-o,--output", options.output, "the PNG; FILE.view.png in the working directory")->type_name("FILE");
    app.add_option("--layer", options.layers,
                   "a layer, or several with commas between; may be given several times; the first of colors")
        ->type_name("NAME")
        ->expected(1)
        ->allow_extra_args(false)  // the next word is the image
        ->take_all();
    app.add_flag("--all", options.all, "all layers");
    const auto add_action = [&](const char* name, const char* description, ViewAction action) {
        app.add_flag_callback(
            name, [&options, action] { options.action = action; }, description);
    };
    add_action("--list", "print the layers and how each is shown, and exit", ViewAction::list);
    add_option(app, "--columns", "N", "of several layers: so many in a row; 4",
               read_whole(options.columns, 1, most_columns));
    add_key(app, request, "exposure", "stops by which colors and scalars are brighter; 0");
    add_key(app, request, "view",
            "of colors: srgb cuts off above white, filmic tells bright colors apart, or a view of $OCIO; srgb");
    add_key(app, request, "bloom", "of colors: how much light above white glows around; 0");
    app.add_flag("-q,--quiet", options.quiet, "errors only");
    add_action("--version", "print the version and exit", ViewAction::print_version);
    app.set_help_flag("-h,--help", "print this and exit");
}

/// FILE.view.png in the working directory: never the preview that `render` wrote.
std::string default_view_name(const std::string& file) {
    return std::filesystem::path(file).stem().string() + ".view.png";
}

}  // namespace

ViewOptions parse_view_options(int argc, const char* const* argv) {
    CLI::App app;
    ViewOptions options;
    RenderRequest request;
    declare(app, options, request);
    const bool whole = parse_command_line(app, argc, argv, [&](const std::string& extra) {
        return fmt::format("{}: one image at a time, and {} is it already", extra, options.file);
    });
    if (!whole) options.action = ViewAction::print_help;
    if (!whole || options.action == ViewAction::print_version) return options;
    if (options.file.empty()) fail_usage("no image is given: render-view FILE.exr; --help tells more");
    options.view = request.view;
    options.exposed = app.count("--exposure") > 0;
    if (options.all && !options.layers.empty())
        fail_usage(fmt::format("--layer {}: has no place beside --all, which shows every layer; leave one out",
                               options.layers.front()));
    if (options.action == ViewAction::list) {
        if (!options.output.empty())
            fail_usage(fmt::format("-o {}: --list writes no picture; leave it out", options.output));
        return options;
    }
    if (options.output.empty()) options.output = default_view_name(options.file);
    if (lower_extension(options.output) != ".png")
        fail_usage(fmt::format("-o {}: what is seen is written as a PNG; name it *.png", options.output));
    RunFiles files;
    files.reads(options.file, "the image");
    files.writes(options.output, "-o");
    return options;
}

std::string view_help_text() {
    CLI::App app("Shows layers of an EXR image as a PNG: colors, ids, mattes, depth, normals, any channel.",
                 "render-view");
    ViewOptions options;
    RenderRequest request;
    declare(app, options, request);
    app.footer(R"(
Examples:
  render-view film.exr --list
  render-view film.exr --exposure 2 --view filmic -o film.png
  render-view film.exr --layer RGB,Z,N,id
  render-view film.exr --all --columns 3 -o sheet.png

Pixels that are not a number are magenta, infinite ones cyan; standard output says how many, and what values were mapped.

Exit codes: 0 done, 2 command line or no such layer, 3 file.)");
    return app.help();
}

}  // namespace cistula
