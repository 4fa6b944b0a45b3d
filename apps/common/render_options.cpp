#include "apps/common/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "apps/common/command_line.h"
#include "apps/common/view_options.h"
#include "base/suggest.h"
#include "cistula/model/effects.h"
#include "cistula/model/lattice_settings.h"
#include "cistula/transport/ray_tree.h"
#include "render/frame_settings.h"
#include "render/layer_list.h"
#include "scene/readers/read_scene.h"
#include "sequence/frame_list.h"

namespace cistula {
namespace {

const ColorSpace* parse_color_space(const std::string& text) {
    if (const ColorSpace* space = find_color_space(text)) return space;
    std::vector<std::string_view> names;
    for (const ColorSpace& space : color_spaces()) names.push_back(space.id);
    fail_usage(fmt::format("--colorspace {}: there is no such space; {}", text, nearest_first(text, names, "spaces")));
}

float parse_z_far(const std::string& text) {
    if (text == "inf") return std::numeric_limits<float>::infinity();
    using Limits = std::numeric_limits<float>;
    return static_cast<float>(number_option("--z-far", text, Limits::denorm_min(), Limits::max(),
                                            "a number above 0 in single precision, or inf"));
}

constexpr double above_zero = std::numeric_limits<double>::denorm_min();

/// Throws Error (usage) that says which of two options must be left out, or which one is missing.
void refuse_exclusions(const CLI::App& app, const RenderOptions& options) {
    /// `option`, given as `text`, cannot be combined with `other`.
    struct Exclusion {
        const char* option;
        std::string text;
        const char* other;
        bool other_given;
        const char* why;
    };
    const auto given = [&](const char* option) { return app.count(option) > 0; };
    const std::string pixel = given_text(app, "--pixel"), tile = given_text(app, "--tile"),
                      target = given_text(app, "--target-error");
    const std::string measure = options.action == Action::measure ? "measure" : "";
    const std::string records = is_for_programs(options.progress) ? given_text(app, "--progress") : "";
    const OutputChannels& channels = options.channels;
    constexpr const char* no_image = "no image is written";
    constexpr const char* from_the_corner = "the pixel counts from the top left of the full frame";
    const Exclusion exclusions[] = {
        {"--pixel", pixel, "-o", !options.output.empty(), no_image},
        {"--pixel", pixel, "--preview", !options.preview.empty(), no_image},
        {"--pixel", pixel, "--stats", !options.stats.empty(), "nothing is timed"},
        {"--pixel", pixel, "--layers", !options.layers.empty(), no_image},
        {"--pixel", pixel, "--bits", channels.half, no_image},
        {"--pixel", pixel, "--strict", options.strict, no_image},
        {"--pixel", pixel, "--background", channels.transparent, no_image},
        {"--pixel", pixel, "--colorspace", channels.space != &color_spaces().front(), no_image},
        {"--pixel", pixel, "--compression", channels.compression != Compression::zip, no_image},
        {"--pixel", pixel, "--crop", options.crop.has_value(), from_the_corner},
        {"--pixel", pixel, "--resume", options.resume, no_image},
        {"--pixel", pixel, "--progress", options.progress != ProgressStyle::automatic, "one pixel takes no time"},
        {"--pixel", pixel, "--explain", given("--explain"), "each prints a report of its own"},
        {"--pixel", pixel, "--target-error", options.target_error.has_value(),
         "it shows the samples of a grid; --supersample chooses one"},
        {"--pixel", pixel, "--backend", options.backend != Backend::embree,
         "the CPU follows the rays, and every backend gives the same bits"},
        {"--tile", tile, "--preview", !options.preview.empty(),
         "it is of whole frames; render-merge --preview makes it"},
        {"--tile", tile, "--compression dwaa and dwab", is_dwa(channels.compression), why_no_dwa_of_tiles},
        {"--tile", tile, "--explain", given("--explain"), "it tells of whole frames"},
        {"--pixel", pixel, "--tile", options.tile.has_value(), from_the_corner},
        {"--progress", records, "--explain", given("--explain"), "it tells of frames that are written"},
        {"--lanes", given_text(app, "--lanes"), "--backend cuda", options.backend == Backend::cuda,
         "a thread of a GPU traces one ray"},
        {"--target-error", target, "--supersample", options.supersample.has_value(),
         "pixels get as many samples as they need"},
        {"--target-error", target, "--cutoff", options.cutoff.has_value(), "a quarter of the target is the cutoff"},
        {"--explain", measure, "--target-error", options.target_error.has_value(),
         "it times the samples of a grid; --supersample chooses one"},
    };
    for (const auto& [option, text, other, other_given, why] : exclusions)
        if (!text.empty() && other_given)
            fail_usage(fmt::format("{} {}: {} has no place here: {}; leave it out", option, text, other, why));
    const auto require = [](bool holds, const char* option, const std::string& text, const char* otherwise) {
        if (!text.empty() && !holds) fail_usage(fmt::format("{} {}: {}", option, text, otherwise));
    };
    const bool has_layers = !options.layers.empty();
    const std::string split = options.split == Split::none ? "" : given_text(app, "--split");
    require(has_layers, "--split", split, "is for --layers LIST");
    require(has_layers, "--z-far", given_text(app, "--z-far"), "is for --layers Z");
    require(is_dwa(channels.compression), "--dwa-level", given_text(app, "--dwa-level"),
            "is for --compression dwaa and dwab");
    if (options.quiet && options.verbose) fail_usage("-q and -v exclude each other; give one");
}

}  // namespace

void declare_render_options(CLI::App& app, RenderOptions& options) {
    OutputChannels& channels = options.channels;
    channels.space = &color_spaces().front();
    const auto add = [&](const char* names, const char* value, const char* description, const OptionReader& read) {
        return add_option(app, names, value, description, read);
    };
    const auto add_text = [&](const char* names, const char* value, const char* description, std::string& text) {
        return app.add_option(names, text, description)->type_name(value);
    };
    const auto add_action = [&](const char* name, const char* description, Action action) {
        app.add_flag_callback(
            name, [&options, action] { options.action = action; }, description);
    };
    add_text("SCENE", "", "scene file: JSON or the seed's text; - reads standard input", options.scene);
    add_text("-o,--output", "FILE",
             "image: .exr, or .out/.data for the seed's raw frames; #### or %04d is the frame number", options.output);
    add("-f,--frames", "LIST", "frames to render, e.g. 0-299x5,7", read_by(options.frames, parse_frames));
    add("--backend", "NAME", "embree (CPU) or cuda (GPU)", read_by(options.backend, parse_backend));
    add("--device", "LIST", "with --backend cuda: GPUs that share every frame, e.g. 0,2, or all; 0",
        [&](const char*, const std::string& text) { options.devices = parse_devices(text, options.backend); });
    add_action("--list-devices", "print the GPUs, or why there is none, and exit", Action::list_devices);
    add("--res", "WxH", "full frame in pixels", read_by(options.resolution, parse_size));
    add("--crop", "WxH+X+Y", "render these pixels only; the file's data window", read_by(options.crop, parse_crop));
    CLI::Option* const tiles =
        add("--tiles", "CxR", "with --tile: the grid of tiles that the frame, or the crop, is cut into",
            read_by(options.tiles, parse_tiles));
    add("--tile", "N", "render this tile alone, counted from 0; render-merge joins them",
        [&](const char* option, const std::string& text) {
            options.tile =
                integer_option(option, text, 0, app.count("--tiles") ? options.tiles.count() - 1 : most_tiles);
        })
        ->needs(tiles);
    add("--supersample", "K", "k: a k x k grid of samples per pixel",
        read_whole(options.supersample, 1, largest_supersample));
    add("--depth", "N", "surfaces shaded along a path, 1 to 1024", read_whole(options.depth, 1, largest_depth));
    add("--cutoff", "E", "radiance that dropping faint branches may cost a pixel; 0: none",
        read_number(options.cutoff, 0, INFINITY, "a number, 0 or above, in the scene's units of radiance"));
    CLI::Option* const target = add(
        "--target-error", "E",
        "radiance by which a pixel may be wrong: samples and branches as needed, whatever --supersample",
        read_number(options.target_error, above_zero, INFINITY, "a number above 0, in the scene's units of radiance"));
    add("--max-samples", "N", "with --target-error: samples of a pixel, 5 to 256; 256",
        read_whole(options.max_samples, least_lattice_samples, lattice_samples))
        ->needs(target);
    add("--effects", "NAME", "auto: compiled are those the scene calls for; all: every one, to compare",
        read_choice(options.all_effects, {{"auto", false}, {"all", true}}));
    add("--precision", "NAME", "auto (float, or double where parts are too small for it), float or double",
        read_choice(options.wanted_precision,
                    {{"auto", std::nullopt}, {"float", Precision::single_}, {"double", Precision::double_}}));
    add("--threads", "N", "threads; all by default", read_whole(options.threads, 1, 1024));
    add("--lanes", "N", "rays that a CPU thread traces at once, at most; 1 to 16, all that it can by default",
        read_whole(options.lanes, 1, 16));
    add("--max-texture-gb", "N", "memory for all textures, in GB of 10^9 bytes; a quarter of the machine's",
        [&](const char* option, const std::string& text) {
            options.texture_bytes = static_cast<uint64_t>(
                number_option(option, text, above_zero, 1e6, "a number above 0, to 1000000") * 1e9);
        });
    add("--bits", "NAME", "float (32 bits a channel) or half (16)",
        read_choice(channels.half, {{"float", false}, {"half", true}}));
    app.add_flag("--strict", options.strict, "with --bits half: a value over 65504 is an error, and not clamped");
    const OptionReader read_layers = [&](const char*, const std::string& text) {
        options.layers = text;
        channels = parse_layers(text, channels);
    };
    add("--layers", "LIST", "more layers: path, light, data, cryptomatte, or single ones such as diffuse, Z, N",
        read_layers);
    add("--aov", "LIST", "as --layers", read_layers)->group("");  // its name in earlier versions: not in --help
    add("--split", "NAME",
        "layers go into: none, the beauty's part of the file; parts of their own; or files of their own",
        read_choice(options.split, {{"none", Split::none}, {"parts", Split::parts}, {"files", Split::files}}));
    add("--z-far", "Z", "with --layers Z: the depth of nothing, a number or inf; 1e10",
        read_by(channels.z_far, parse_z_far));
    add("--background", "NAME", "opaque, or transparent: alpha is coverage, color premultiplied",
        read_choice(channels.transparent, {{"opaque", false}, {"transparent", true}}));
    add("--colorspace", "NAME",
        "lin_rec709_scene, lin_ap1_scene (ACEScg), lin_ap0_scene (ACES2065-1), lin_rec2020_scene, lin_p3d65_scene or "
        "lin_adobergb_scene",
        read_by(channels.space, parse_color_space));
    add("--compression", "NAME", "none, rle, zips, zip, piz, or with losses dwaa, dwab",
        read_choice(channels.compression, {{"none", Compression::none},
                                           {"rle", Compression::rle},
                                           {"zips", Compression::zips},
                                           {"zip", Compression::zip},
                                           {"piz", Compression::piz},
                                           {"dwaa", Compression::dwaa},
                                           {"dwab", Compression::dwab}}));
    add("--dwa-level", "L", "with dwaa and dwab: 0 to 1000, more is smaller; 45",
        read_number(channels.dwa_level, 0, 1000, "a number from 0 to 1000"));
    add_preview_options(app, options.preview, options.view);
    add_text("--stats", "FILE", "times, rays, memory and the effects mask as JSON", options.stats);
    add_valued_flag(
        app, "--explain", "needs",
        "print the effects the scene calls for and why; renders nothing. --explain=measure: and what each costs",
        read_choice(options.action, {{"needs", Action::explain}, {"measure", Action::measure}}));
    CLI::Option* const pixel = add("--pixel", "X,Y", "print how this pixel comes about, ray by ray; renders nothing",
                                   [&](const char*, const std::string& text) {
                                       options.pixel = parse_pixel(text);
                                       options.action = Action::pixel;
                                   });
    add_text("--json", "FILE", "with --pixel: the same as JSON; - is standard output", options.json)
        ->needs(pixel)
        ->option_text("FILE");
    app.add_flag("--resume", options.resume, "skip frames whose file is complete and of the same scene and settings");
    add("--progress", "STYLE",
        "auto, plain or none; or, for programs, on standard output: json, or openjd (Open Job Description)",
        read_choice(options.progress, {{"auto", ProgressStyle::automatic},
                                       {"plain", ProgressStyle::plain},
                                       {"none", ProgressStyle::none},
                                       {"json", ProgressStyle::json},
                                       {"openjd", ProgressStyle::openjd}}));
    app.add_flag("-q,--quiet", options.quiet, "errors only");
    app.add_flag("-v,--verbose", options.verbose, "also times, hashes and effects");
    add_action("--print-template", "print the seed's text input and exit", Action::print_template);
    add_action("--version", "print the version and exit", Action::print_version);
    app.set_help_flag("-h,--help", "print this and exit");
}

void check_render_options(const CLI::App& app, RenderOptions& options) {
    options.precision = options.wanted_precision.value_or(Precision::single_);
    refuse_exclusions(app, options);
    if (options.action == Action::pixel && options.frames.size() > 1)
        fail_usage(fmt::format("--frames names {} frames, and --pixel {} is of one; name that one",
                               options.frames.size(), given_text(app, "--pixel")));
    if (options.scene.empty())
        fail_usage("no scene is given: render SCENE -o FILE.exr, or - for standard input; --help tells more");
}

RenderOptions parse_options(int argc, const char* const* argv) {
    CLI::App app;
    RenderOptions options;
    declare_render_options(app, options);
    const bool whole = parse_command_line(app, argc, argv, [&](const std::string& extra) {
        return fmt::format("{}: one scene at a time, and {} is it already", extra, options.scene);
    });
    if (app.count("--list-devices") > 0) options.action = Action::list_devices;  // whatever report is asked for, too
    if (!whole) options.action = Action::print_help;
    constexpr Action prints[] = {Action::print_help, Action::print_version, Action::print_template,
                                 Action::list_devices};
    if (std::find(std::begin(prints), std::end(prints), options.action) != std::end(prints)) return options;
    check_render_options(app, options);
    if (app.count("--tiles") > 0 && !options.tile)
        fail_usage(fmt::format("--tiles {}: is for --tile N, the one of them to render", given_text(app, "--tiles")));
    return options;
}

std::string help_text() {
    CLI::App app("Renders a scene to OpenEXR: the same bits on every machine and with any number of threads.",
                 "render");
    RenderOptions options;
    declare_render_options(app, options);
    app.footer(R"(
Examples:
  render scenes/platonic.json -o platonic.exr --preview platonic.png
  render scenes/platonic.json -o p.exr --preview p.png --view filmic --exposure 1 --bloom 2
  render scenes/seed.json -o out/beauty.####.exr                   all frames of the film
  render scenes/seed.json -o out/beauty.####.exr --resume          those still missing
  render scenes/seed.json -o out/f%04d.exr -f 0-299x30,7 --res 320x180
  render scenes/glass.json -o g.exr --precision double --supersample 4 --layers path,error,id,Z,N
  render scenes/infinity.json -o corner.exr --crop 64x64+128+96 --cutoff 0.001 --stats corner.json
  render scenes/benchmark.json -o b.exr --target-error 0.004       as many samples and bounces as that takes
  render scenes/seed.json -o out/beauty.####.exr --backend cuda --device all
  render scenes/glass.json --pixel 640,300 --supersample 1 | less  why this pixel is what it is
  render - < scenes/input.txt                                      the seed's input and frames
  render --print-template > input.txt

Without -o a scene is written to SCENE.exr in the working directory (SCENE.####.exr where -f names several frames), the
seed's text input to its own pattern. A name without a pattern holds one frame, -f's or the first.

Exit codes: 0 done, 1 the image cannot be trusted, 2 command line or scene, 3 file, 4 device,
5 target error not met (the image is written), 130 interrupted.)");
    return app.help();
}

ChosenPixel parse_pixel(std::string_view text) {
    const size_t comma = text.find(',');
    if (comma != text.npos) {
        const auto x = whole_number<int>(text.substr(0, comma)), y = whole_number<int>(text.substr(comma + 1));
        if (x && y && *x >= 0 && *y >= 0) return {*x, *y};
    }
    fail_usage(fmt::format("--pixel {}: must be X,Y in pixels from the top left, which is 0,0, as in 320,240", text));
}

SceneDescription read_scene(const RenderOptions& options) {
    SceneDescription scene = read_scene(options.scene);
    scene.texture_bytes = options.texture_bytes;
    return scene;
}

FrameSettings frame_settings(const RenderOptions& options, const SceneDescription& scene) {
    FrameSettings settings = frame_settings(scene);
    if (options.resolution) settings.set_size(options.resolution->width, options.resolution->height);
    settings.supersample = options.supersample.value_or(settings.supersample);
    settings.lanes = options.lanes;
    settings.depth = options.depth.value_or(settings.depth);
    settings.cutoff = options.cutoff.value_or(settings.cutoff);
    settings.target_error = options.target_error.value_or(0);
    settings.max_samples = options.max_samples.value_or(settings.max_samples);
    settings.layers = layers_for(options.channels);
    settings.parts = parts_for(options.channels);
    settings.effects = options.all_effects ? all_effects : 0;
    // With a target error the depth is unlimited by default: the budget of truncation ends the ray trees.
    if (settings.adaptive()) settings.depth = options.depth.value_or(largest_depth);
    settings.crop = options.crop.value_or(settings.crop);
    const PixelRect& crop = settings.crop;
    if (crop.x > settings.full_width - crop.width || crop.y > settings.full_height - crop.height)
        fail_usage(fmt::format("--crop {}x{}+{}+{}: leaves the frame, which is {}x{}", crop.width, crop.height, crop.x,
                               crop.y, settings.full_width, settings.full_height));
    if (options.tile) settings.crop = tile_rect(crop, options.tiles, *options.tile);
    const ChosenPixel& pixel = options.pixel;
    if (options.action == Action::pixel && (pixel.x >= settings.full_width || pixel.y >= settings.full_height))
        fail_usage(fmt::format("--pixel {},{}: is outside of the frame, which is {}x{}; its last pixel is {},{}",
                               pixel.x, pixel.y, settings.full_width, settings.full_height, settings.full_width - 1,
                               settings.full_height - 1));
    return settings;
}

}  // namespace cistula
