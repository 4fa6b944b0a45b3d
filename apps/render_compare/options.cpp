#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <cmath>

#include "apps/common/command_line.h"
#include "apps/common/picture_size.h"
#include "apps/common/run_files.h"
#include "scene/base/file_bytes.h"

namespace cistula {
namespace {

/// The options' texts as CLI11 stores them.
struct Texts {
    std::string a, b, fail, failpercent, hardfail, layers, crop, mask, metrics, diff, json, sums;
    bool intersection = false, quiet = false, version = false;
};

void declare(CLI::App& app, Texts& texts) {
    app.add_option("A", texts.a, "an image; differences are relative to it")->type_name("");
    app.add_option("B", texts.b, "another")->type_name("");
    app.add_option("--fail", texts.fail, "a pixel fails where a channel differs by more than E")->type_name("E");
    app.add_option("--failpercent", texts.failpercent, "with --fail: P % of the pixels may fail; 0")->type_name("P");
    app.add_option("--hardfail", texts.hardfail, "no pixel may differ by more than E")->type_name("E");
    app.add_option("--layers", texts.layers,
                   "only channels and layers of these names, with * and ?; e.g. R,G,B,diffuse.*")
        ->type_name("LIST");
    app.add_flag("--intersection", texts.intersection, "only pixels that both data windows have");
    app.add_option("--crop", texts.crop, "only these pixels; X and Y in the file's pixel space")->type_name("X,Y,W,H");
    app.add_option("--mask", texts.mask, "only pixels where this image is above 0")->type_name("FILE");
    app.add_option("--metrics", texts.metrics, "also ssim, or flip (by NVIDIA's program), or both")->type_name("LIST");
    app.add_option("--diff", texts.diff, "write the absolute differences as an image")->type_name("FILE.exr");
    app.add_option("--json", texts.json, "write the result as JSON")->type_name("FILE");
    app.add_option("--sums", texts.sums, "whether an image's layers by path and by light add up to its R G B")
        ->type_name("FILE.exr");
    app.add_flag("-q,--quiet", texts.quiet, "errors only; the exit code tells");
    app.add_flag("--version", texts.version, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

void refuse(bool given, const char* option, const char* why) {
    if (given) fail_usage(fmt::format("{}: {}", option, why));
}

/// Refuses what chooses among the pixels and channels of two images, or measures their difference.
void refuse_selection(const Texts& texts, const char* why) {
    refuse(!texts.layers.empty(), "--layers", why);
    refuse(texts.intersection, "--intersection", why);
    refuse(!texts.crop.empty(), "--crop", why);
    refuse(!texts.mask.empty(), "--mask", why);
    refuse(!texts.metrics.empty(), "--metrics", why);
}

/// X,Y,W,H, in which X and Y may be negative, or what --crop of render takes.
PixelRect parse_window(const std::string& text) {
    const std::vector<std::string_view> parts = parts_at_commas(text);
    if (parts.size() == 1) return parse_crop(text);
    std::vector<int> numbers;
    for (const std::string_view part : parts)
        if (const auto number = whole_number<int>(part)) numbers.push_back(*number);
    if (parts.size() != 4 || numbers.size() != 4 || numbers[2] < 1 || numbers[3] < 1)
        fail_usage(fmt::format("--crop {}: must be X,Y,WIDTH,HEIGHT in pixels, as in 128,96,64,64", text));
    return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

void check_selection(const Texts& texts, CompareOptions& options) {
    Selection& selection = options.selection;
    if (!texts.layers.empty())
        for (const std::string_view pattern : parts_at_commas(texts.layers)) {
            if (pattern.empty())
                fail_usage(fmt::format(
                    "--layers {}: has an empty name; names have commas between, as in R,G,B,diffuse.*", texts.layers));
            selection.layers.emplace_back(pattern);
        }
    selection.intersection = texts.intersection;
    if (!texts.crop.empty()) selection.crop = parse_window(texts.crop);
    options.mask = texts.mask;
    if (texts.metrics.empty()) return;
    for (const std::string_view metric : parts_at_commas(texts.metrics))
        *chosen<bool*>("--metrics", std::string(metric), {{"ssim", &selection.ssim}, {"flip", &options.flip}}) = true;
}

void check_images(const Texts& texts, CompareOptions& options) {
    if (texts.a.empty() || texts.b.empty())
        fail_usage(fmt::format("{}; render-compare A.exr B.exr; --help tells more",
                               texts.a.empty() ? "no images are given" : "only one image is given"));
    if (texts.fail.empty())
        refuse(!texts.failpercent.empty(), "--failpercent", "needs to know when a pixel fails; add --fail E");
    constexpr const char* amount = "a number, 0 or above, in the units of the channels";
    if (!texts.fail.empty()) options.thresholds.fail = number_option("--fail", texts.fail, 0, INFINITY, amount);
    if (!texts.hardfail.empty())
        options.thresholds.hardfail = number_option("--hardfail", texts.hardfail, 0, INFINITY, amount);
    if (!texts.failpercent.empty())
        options.thresholds.failpercent =
            number_option("--failpercent", texts.failpercent, 0, 100, "a number from 0 to 100, as in 0.5");
    check_selection(texts, options);
    options.a = texts.a;
    options.b = texts.b;
    options.diff = texts.diff;
    RunFiles files;
    files.reads(options.a, "the first image");
    files.reads(options.b, "the second image");
    files.reads(options.mask, "--mask");
    files.writes(options.diff, "--diff");
    files.writes(options.json, "--json");
    if (!options.diff.empty() && lower_extension(options.diff) != ".exr")
        fail_usage(fmt::format("--diff {}: differences are written as an EXR; name it *.exr", options.diff));
}

void check_sums(const Texts& texts, CompareOptions& options) {
    constexpr const char* one = "--sums looks at one image by itself; leave it out";
    refuse(!texts.a.empty(), texts.a.c_str(), one);
    refuse(!texts.fail.empty(), "--fail", one);
    refuse(!texts.failpercent.empty(), "--failpercent", one);
    refuse(!texts.hardfail.empty(), "--hardfail", one);
    refuse_selection(texts, one);
    refuse(!texts.diff.empty(), "--diff", one);
    refuse(!texts.json.empty(), "--json", one);
    options.action = CompareAction::sums;
    options.a = texts.sums;
}

}  // namespace

CompareOptions parse_compare_options(int argc, const char* const* argv) {
    CLI::App app;
    Texts texts;
    declare(app, texts);
    CompareOptions options;
    const bool whole = parse_command_line(app, argc, argv, [](const std::string& extra) {
        return fmt::format("{}: one image too many; two are compared at a time", extra);
    });
    if (!whole || texts.version) {
        options.action = whole ? CompareAction::print_version : CompareAction::print_help;
        return options;
    }
    options.quiet = texts.quiet;
    options.json = texts.json;
    if (!texts.sums.empty()) {
        check_sums(texts, options);
    } else {
        check_images(texts, options);
    }
    return options;
}

std::string compare_help_text() {
    CLI::App app(
        "Compares two images channel by channel: all parts of EXRs, and what OpenImageIO reads. Without thresholds "
        "they "
        "must be equal in every bit, header included.",
        "render-compare");
    Texts texts;
    declare(app, texts);
    app.footer(R"(
Examples:
  render-compare a.exr b.exr
  render-compare float.exr double.exr --fail 0.002 --failpercent 0.1 --hardfail 0.5 --diff differences.exr
  render-compare a.png b.png --fail 2                      of 8 bits: by more than 2 codes
  render-compare whole.exr crop.exr --intersection --layers 'R,G,B,diffuse.*' --metrics ssim
  render-compare --sums layers.exr                         whether layers by path and by light add up
  render-compare suite DIR                                 golden images of DIR/suite.json; suite --help tells more

Exit codes: 0 the comparison holds, 1 it does not, 2 command line, 3 file.)");
    return app.help();
}

}  // namespace cistula
