#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <filesystem>

#include "apps/common/command_line.h"
#include "apps/common/view_options.h"
#include "base/file_bytes.h"
#include "sequence/run_files.h"

namespace cistula {
namespace {

constexpr int most_columns = 1000;

/// The options' texts as CLI11 stores them.
struct Texts {
    std::string file, output, columns;
    std::vector<std::string> layers;
    bool all = false, list = false, quiet = false, version = false;
};

void declare(CLI::App& app, Texts& texts, PictureView& view) {
    app.add_option("FILE.exr", texts.file, "the image")->type_name("");
    app.add_option("-o,--output", texts.output, "the PNG; FILE.view.png in the working directory")->type_name("FILE");
    app.add_option("--layer", texts.layers,
                   "a layer, or several with commas between; may be given several times; the first of colors")
        ->type_name("NAME")
        ->expected(1)
        ->allow_extra_args(false)  // the next word is the image
        ->take_all();
    app.add_flag("--all", texts.all, "all layers");
    app.add_flag("--list", texts.list, "print the layers and how each is shown, and exit");
    app.add_option("--columns", texts.columns, "of several layers: so many in a row; 4")->type_name("N");
    add_option(app, "--exposure", "EV", "stops by which colors and scalars are brighter; 0", read_exposure(view));
    add_option(app, "--view", "NAME",
               "of colors: srgb cuts off above white, filmic tells bright colors apart, or a view of $OCIO; srgb",
               read_view(view));
    add_option(app, "--bloom", "AMOUNT", "of colors: how much light above white glows around; 0", read_bloom(view));
    app.add_flag("-q,--quiet", texts.quiet, "errors only");
    app.add_flag("--version", texts.version, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

/// FILE.view.png in the working directory: never the preview that `render` wrote.
std::string default_view_name(const std::string& file) {
    return std::filesystem::path(file).stem().string() + ".view.png";
}

}  // namespace

ViewOptions parse_view_options(int argc, const char* const* argv) {
    CLI::App app;
    Texts texts;
    ViewOptions options;
    declare(app, texts, options.view);
    const bool whole = parse_command_line(app, argc, argv, [&](const std::string& extra) {
        return fmt::format("{}: one image at a time, and {} is it already", extra, texts.file);
    });
    if (!whole || texts.version) {
        options.action = whole ? ViewAction::print_version : ViewAction::print_help;
        return options;
    }
    if (texts.file.empty()) fail_usage("no image is given: render-view FILE.exr; --help tells more");
    options.file = texts.file;
    options.exposed = app.count("--exposure") > 0;
    options.layers = texts.layers;
    options.all = texts.all;
    options.quiet = texts.quiet;
    if (!texts.columns.empty()) options.columns = integer_option("--columns", texts.columns, 1, most_columns);
    if (texts.all && !texts.layers.empty())
        fail_usage(fmt::format("--layer {}: has no place beside --all, which shows every layer; leave one out",
                               texts.layers.front()));
    if (texts.list) {
        options.action = ViewAction::list;
        if (!texts.output.empty())
            fail_usage(fmt::format("-o {}: --list writes no picture; leave it out", texts.output));
        return options;
    }
    options.output = texts.output.empty() ? default_view_name(texts.file) : texts.output;
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
    Texts texts;
    PictureView view;
    declare(app, texts, view);
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
