#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>

#include "apps/common/command_line.h"
#include "base/file_bytes.h"
#include "render/picture_size.h"
#include "sequence/output_name.h"
#include "sequence/run_files.h"

namespace cistula {
namespace {

/// X,Y,W,H, in which X and Y may be negative, or what --crop of render takes.
PixelRect parse_window(const std::string& text) {
    const std::vector<std::string_view> parts = parts_at_commas(text);
    if (parts.size() == 1) return parse_crop(text);
    std::vector<int> numbers;
    for (const std::string_view part : parts)
        if (const auto number = whole_number<int>(part)) numbers.push_back(*number);
    if (parts.size() != 4 || numbers.size() != 4 || numbers[2] < 1 || numbers[3] < 1)
        fail_usage("must be X,Y,WIDTH,HEIGHT in pixels, as in 128,96,64,64");
    return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

std::vector<std::string> parse_patterns(const std::string& text) {
    std::vector<std::string> patterns;
    for (const std::string_view pattern : parts_at_commas(text)) {
        if (pattern.empty()) fail_usage("has an empty name; names have commas between, as in R,G,B,diffuse.*");
        patterns.emplace_back(pattern);
    }
    return patterns;
}

/// Adds the options; `sums`: the image given to --sums.
void declare(CLI::App& app, CompareOptions& options, std::string& sums) {
    constexpr const char* amount = "a number, 0 or above, in the units of the channels";
    Thresholds& thresholds = options.thresholds;
    Selection& selection = options.selection;
    app.add_option("A", options.a, "an image, a folder, or a sequence, as a.####.exr; differences are relative to it")
        ->type_name("");
    app.add_option("B", options.b, "another")->type_name("");
    CLI::Option* const fail = add_option(app, "--fail", "E", "a pixel fails where a channel differs by more than E",
                                         read_number(thresholds.fail, 0, INFINITY, amount));
    add_option(app, "--failpercent", "P", "with --fail: P % of the pixels may fail; 0",
               read_number(thresholds.failpercent, 0, 100, "a number from 0 to 100, as in 0.5"))
        ->needs(fail);
    add_option(app, "--hardfail", "E", "no pixel may differ by more than E",
               read_number(thresholds.hardfail, 0, INFINITY, amount));
    add_option(app, "--failflip", "E", "the mean of FLIP may be no more than E",
               read_number(thresholds.flip, 0, 1, "a number from 0 to 1"));
    add_option(app, "--failssim", "S", "SSIM of no channel may be less than S",
               read_number(thresholds.ssim, -1, 1, "a number from -1 to 1"));
    app.add_flag("--allow-nonfinite", thresholds.allow_nonfinite,
                 "with a threshold: NaN and infinities that both have in the same places pass");
    add_option(app, "--layers", "LIST", "only channels and layers of these names, with * and ?; e.g. R,G,B,diffuse.*",
               read_by(selection.layers, parse_patterns));
    app.add_flag("--intersection", selection.intersection, "only pixels that both data windows have");
    add_option(app, "--crop", "X,Y,W,H", "only these pixels; X and Y in the file's pixel space",
               read_by(selection.crop, parse_window));
    app.add_option("--mask", options.mask, "only pixels where this image is above 0")->type_name("FILE");
    add_option(
        app, "--metrics", "LIST", "also ssim, or flip (by NVIDIA's program), or both", [&](const std::string& text) {
            for (const std::string_view metric : parts_at_commas(text))
                *chosen<bool*>(std::string(metric), {{"ssim", &selection.ssim}, {"flip", &selection.flip}}) = true;
        });
    app.add_option("--diff", options.diff, "write the absolute differences as an image")->type_name("FILE.exr");
    app.add_option("--json", options.json, "write the result as JSON; - is standard output")->type_name("FILE");
    app.add_option("--sums", sums, "whether an image's layers by path and by light add up to its R G B")
        ->type_name("FILE.exr");
    app.add_flag("-q,--quiet", options.quiet, "errors only; the exit code tells");
    app.add_flag_callback(
        "--version", [&] { options.action = CompareAction::print_version; }, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

void check_images(const CompareOptions& options) {
    if (options.a.empty() || options.b.empty())
        fail_usage(fmt::format("{}; render-compare A.exr B.exr; --help tells more",
                               options.a.empty() ? "no images are given" : "only one image is given"));
    if (options.thresholds.allow_nonfinite && !options.thresholds.any())
        fail_usage("--allow-nonfinite: is for thresholds; without one every bit counts; add --fail E");
    if (names_several(options.a) != names_several(options.b))
        fail_usage(fmt::format("{} and {}: one of them is several images; give two folders, or two sequences",
                               options.a, options.b));
    if (names_several(options.a) && !options.diff.empty())
        fail_usage(fmt::format("--diff {}: is one image, and several are compared; leave it out", options.diff));
    RunFiles files;
    files.reads(options.a, "the first image");
    files.reads(options.b, "the second image");
    files.reads(options.mask, "--mask");
    files.writes(options.diff, "--diff");
    if (options.json != "-") files.writes(options.json, "--json");
    if (!options.diff.empty() && lower_extension(options.diff) != ".exr")
        fail_usage(fmt::format("--diff {}: differences are written as an EXR; name it *.exr", options.diff));
}

/// Refuses what chooses among the pixels and channels of two images, or tells of their difference.
void check_sums(const CLI::App& app, const CompareOptions& options) {
    constexpr const char* why = "--sums looks at one image by itself; leave it out";
    if (!options.a.empty()) fail_usage(fmt::format("{}: {}", options.a, why));
    for (const char* option : {"--fail", "--failpercent", "--hardfail", "--failflip", "--failssim", "--allow-nonfinite",
                               "--layers", "--intersection", "--crop", "--mask", "--metrics", "--diff", "--json"})
        if (app.count(option) > 0) fail_usage(fmt::format("{}: {}", option, why));
}

}  // namespace

bool names_several(const std::string& text) {
    std::error_code error;
    if (std::filesystem::exists(text, error)) return std::filesystem::is_directory(text, error);
    return text.find_first_of("#%") != text.npos && OutputName(text, "the images").has_pattern();
}

CompareOptions parse_compare_options(int argc, const char* const* argv) {
    CLI::App app;
    CompareOptions options;
    std::string sums;
    declare(app, options, sums);
    const bool whole = parse_command_line(app, argc, argv, [](const std::string& extra) {
        return fmt::format("{}: one image too many; two are compared at a time", extra);
    });
    if (!whole) options.action = CompareAction::print_help;
    if (options.action != CompareAction::compare) return options;
    if (sums.empty()) {
        // With tolerances what both have is judged, where nothing else says what.
        options.selection.common_channels = options.thresholds.any() && options.selection.layers.empty();
        check_images(options);
        return options;
    }
    check_sums(app, options);
    options.action = CompareAction::sums;
    options.a = sums;
    return options;
}

std::string compare_help_text() {
    CLI::App app(
        "Compares two images channel by channel: all parts of EXRs, and what OpenImageIO reads; or folders and "
        "sequences of them. Without thresholds they must be equal in every bit, header included; with them what both "
        "have is compared.",
        "render-compare");
    CompareOptions options;
    std::string sums;
    declare(app, options, sums);
    app.footer(R"(
Examples:
  render-compare a.exr b.exr
  render-compare float.exr double.exr --fail 0.002 --failpercent 0.1 --hardfail 0.5 --diff differences.exr
  render-compare a.png b.png --fail 2                      of 8 bits: by more than 2 codes
  render-compare whole.exr crop.exr --intersection --layers 'R,G,B,diffuse.*' --metrics ssim
  render-compare ours/ theirs/ --layers R,G,B --fail 0.01  all images, by their names
  render-compare a.####.exr b.%04d.exr --failssim 0.99     all frames, by their numbers
  render-compare --sums layers.exr                         whether layers by path and by light add up
  render-compare suite DIR                                 golden images of DIR/suite.json; suite --help tells more

Exit codes: 0 the comparison holds, 1 it does not, 2 command line, 3 file.)");
    return app.help();
}

}  // namespace cistula
