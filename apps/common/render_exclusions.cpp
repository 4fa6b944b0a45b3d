#include "apps/common/render_exclusions.h"

#include <fmt/format.h>

#include "apps/common/command_line.h"

namespace cistula {
namespace {

/// `option` cannot be combined with `other`; an option is given if its text is not empty.
struct Exclusion {
    const char* option;
    const std::string& text;
    const char* other;
    bool other_given;
    const char* why;
};

/// `option` requires another option.
struct Need {
    const char* option;
    const std::string& text;
    bool other_given;
    const char* otherwise;
};

}  // namespace

void refuse_exclusions(const OptionTexts& texts) {
    const OptionTexts defaults;
    const std::string measure = texts.explain == "measure" ? texts.explain : "";
    const std::string records = texts.progress == "json" || texts.progress == "openjd" ? texts.progress : "";
    constexpr const char* no_image = "no image is written";
    const Exclusion exclusions[] = {
        {"--pixel", texts.pixel, "-o", !texts.output.empty(), no_image},
        {"--pixel", texts.pixel, "--preview", !texts.preview.empty(), no_image},
        {"--pixel", texts.pixel, "--stats", !texts.stats.empty(), "nothing is timed"},
        {"--pixel", texts.pixel, "--layers", !texts.layers.empty(), no_image},
        {"--pixel", texts.pixel, "--bits", texts.bits != defaults.bits, no_image},
        {"--pixel", texts.pixel, "--strict", texts.strict, no_image},
        {"--pixel", texts.pixel, "--background", texts.background != defaults.background, no_image},
        {"--pixel", texts.pixel, "--colorspace", texts.color_space != defaults.color_space, no_image},
        {"--pixel", texts.pixel, "--compression", texts.compression != defaults.compression, no_image},
        {"--pixel", texts.pixel, "--crop", !texts.crop.empty(), "the pixel counts from the top left of the full frame"},
        {"--pixel", texts.pixel, "--resume", texts.resume, no_image},
        {"--pixel", texts.pixel, "--progress", texts.progress != defaults.progress, "one pixel takes no time"},
        {"--pixel", texts.pixel, "--explain", !texts.explain.empty(), "each prints a report of its own"},
        {"--pixel", texts.pixel, "--target-error", !texts.target_error.empty(),
         "it shows the samples of a grid; --supersample chooses one"},
        {"--pixel", texts.pixel, "--backend", texts.backend != defaults.backend,
         "the CPU follows the rays, and every backend gives the same bits"},
        {"--tile", texts.tile, "--preview", !texts.preview.empty(),
         "it is of whole frames; render-merge --preview makes it"},
        {"--tile", texts.tile, "--compression dwaa and dwab", texts.compression.substr(0, 3) == "dwa",
         "a tile would lose something else than the whole frame does"},
        {"--tile", texts.tile, "--explain", !texts.explain.empty(), "it tells of whole frames"},
        {"--pixel", texts.pixel, "--tile", !texts.tile.empty(), "the pixel counts from the top left of the full frame"},
        {"--progress", records, "--explain", !texts.explain.empty(), "it tells of frames that are written"},
        {"--lanes", texts.lanes, "--backend cuda", texts.backend == "cuda", "a thread of a GPU traces one ray"},
        {"--target-error", texts.target_error, "--supersample", !texts.supersample.empty(),
         "pixels get as many samples as they need"},
        {"--target-error", texts.target_error, "--cutoff", !texts.cutoff.empty(),
         "a quarter of the target is the cutoff"},
        {"--explain", measure, "--target-error", !texts.target_error.empty(),
         "it times the samples of a grid; --supersample chooses one"},
    };
    for (const auto& [option, text, other, other_given, why] : exclusions)
        if (!text.empty() && other_given)
            fail_usage(fmt::format("{} {}: {} has no place here: {}; leave it out", option, text, other, why));

    constexpr const char* for_preview = "is for --preview FILE.png; the image keeps the scene's light";
    const bool has_preview = !texts.preview.empty();
    const Need needs[] = {
        {"--exposure", texts.view.exposure, has_preview, for_preview},
        {"--view", texts.view.view, has_preview, for_preview},
        {"--bloom", texts.view.bloom, has_preview, for_preview},
        {"--tile", texts.tile, !texts.tiles.empty(), "needs --tiles CxR, the grid that it is one of"},
        {"--tiles", texts.tiles, !texts.tile.empty(), "is for --tile N, the one of them to render"},
        {"--json", texts.json, !texts.pixel.empty(),
         "is for --pixel X,Y; of a render, --stats FILE.json tells the times"},
        {"--max-samples", texts.max_samples, !texts.target_error.empty(),
         "is for --target-error E; a grid's are --supersample's"},
        {"--split", texts.split == defaults.split ? "" : texts.split, !texts.layers.empty(), "is for --layers LIST"},
        {"--z-far", texts.z_far, !texts.layers.empty(), "is for --layers Z"},
        {"--dwa-level", texts.dwa_level, texts.compression.substr(0, 3) == "dwa", "is for --compression dwaa and dwab"},
    };
    for (const auto& [option, text, other_given, otherwise] : needs)
        if (!text.empty() && !other_given) fail_usage(fmt::format("{} {}: {}", option, text, otherwise));
    if (texts.quiet && texts.verbose) fail_usage("-q and -v exclude each other; give one");
}

}  // namespace cistula
