#include "apps/common/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/common/command_line.h"
#include "apps/common/frame_list.h"
#include "apps/common/layer_list.h"
#include "apps/common/render_exclusions.h"
#include "cistula/model/effects.h"
#include "cistula/model/lattice_settings.h"
#include "cistula/transport/ray_tree.h"
#include "scene/base/suggest.h"
#include "scene/film/frame_settings.h"
#include "scene/readers/read_scene.h"

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
    const auto value = whole_number<double>(text);
    if (!value || !(static_cast<float>(*value) > 0) || !(*value <= double(std::numeric_limits<float>::max())))
        fail_usage(fmt::format("--z-far {}: must be a number above 0 in single precision, or inf", one_line(text)));
    return static_cast<float>(*value);
}

float parse_dwa_level(const std::string& text) {
    const auto value = whole_number<double>(text);
    if (!value || !(*value >= 0 && *value <= 1000))
        fail_usage(fmt::format("--dwa-level {}: must be a number from 0 to 1000", one_line(text)));
    return static_cast<float>(*value);
}

}  // namespace

void declare_render_options(CLI::App& app, OptionTexts& texts) {
    app.add_option("SCENE", texts.scene, "scene file: JSON or the seed's text; - reads standard input")->type_name("");
    app.add_option("-o,--output", texts.output,
                   "image: .exr, or .out/.data for the seed's raw frames; #### or %04d is the frame number")
        ->type_name("FILE");
    app.add_option("-f,--frames", texts.frames, "frames to render, e.g. 0-299x5,7")->type_name("LIST");
    app.add_option("--backend", texts.backend, "embree (CPU) or cuda (GPU)")->type_name("NAME");
    app.add_option("--device", texts.device, "with --backend cuda: GPUs that share every frame, e.g. 0,2, or all; 0")
        ->type_name("LIST");
    app.add_flag("--list-devices", texts.list_devices, "print the GPUs, or why there is none, and exit");
    app.add_option("--res", texts.resolution, "full frame in pixels")->type_name("WxH");
    app.add_option("--crop", texts.crop, "render these pixels only; the file's data window")->type_name("WxH+X+Y");
    app.add_option("--tiles", texts.tiles, "with --tile: the grid of tiles that the frame, or the crop, is cut into")
        ->type_name("CxR");
    app.add_option("--tile", texts.tile, "render this tile alone, counted from 0; render-merge joins them")
        ->type_name("N");
    app.add_option("--supersample", texts.supersample, "k: a k x k grid of samples per pixel")->type_name("K");
    app.add_option("--depth", texts.depth, "surfaces shaded along a path, 1 to 1024")->type_name("N");
    app.add_option("--cutoff", texts.cutoff, "radiance that dropping faint branches may cost a pixel; 0: none")
        ->type_name("E");
    app.add_option("--target-error", texts.target_error,
                   "radiance by which a pixel may be wrong: samples and branches as needed, whatever --supersample")
        ->type_name("E");
    app.add_option("--max-samples", texts.max_samples, "with --target-error: samples of a pixel, 5 to 256; 256")
        ->type_name("N");
    app.add_option("--effects", texts.effects,
                   "auto: compiled are those the scene calls for; all: every one, to compare")
        ->type_name("NAME");
    app.add_option("--precision", texts.precision,
                   "auto (float, or double where parts are too small for it), float or double")
        ->type_name("NAME");
    app.add_option("--threads", texts.threads, "threads; all by default")->type_name("N");
    app.add_option("--lanes", texts.lanes,
                   "rays that a CPU thread traces at once, at most; 1 to 16, all that it can by default")
        ->type_name("N");
    app.add_option("--max-texture-gb", texts.max_texture_gb,
                   "memory for all textures, in GB of 10^9 bytes; a quarter of the machine's")
        ->type_name("N");
    app.add_option("--bits", texts.bits, "float (32 bits a channel) or half (16)")->type_name("NAME");
    app.add_flag("--strict", texts.strict, "with --bits half: a value over 65504 is an error, and not clamped");
    app.add_option("--layers", texts.layers,
                   "more layers: path, light, data, cryptomatte, or single ones such as diffuse, Z, N")
        ->type_name("LIST");
    app.add_option("--aov", texts.layers, "as --layers")->group("");  // its name in earlier versions: not in --help
    app.add_option("--split", texts.split,
                   "layers go into: none, the beauty's part of the file; parts of their own; or files of their own")
        ->type_name("NAME");
    app.add_option("--z-far", texts.z_far, "with --layers Z: the depth of nothing, a number or inf; 1e10")
        ->type_name("Z");
    app.add_option("--background", texts.background, "opaque, or transparent: alpha is coverage, color premultiplied")
        ->type_name("NAME");
    app.add_option("--colorspace", texts.color_space,
                   "lin_rec709_scene, lin_ap1_scene (ACEScg), lin_ap0_scene (ACES2065-1), lin_rec2020_scene, "
                   "lin_p3d65_scene or lin_adobergb_scene")
        ->type_name("NAME");
    app.add_option("--compression", texts.compression, "none, rle, zips, zip, piz, or with losses dwaa, dwab")
        ->type_name("NAME");
    app.add_option("--dwa-level", texts.dwa_level, "with dwaa and dwab: 0 to 1000, more is smaller; 45")
        ->type_name("L");
    add_preview_options(app, texts.preview, texts.view);
    app.add_option("--stats", texts.stats, "times, rays, memory and the effects mask as JSON")->type_name("FILE");
    add_valued_flag(
        app, "--explain", texts.explain, "needs",
        "print the effects the scene calls for and why; renders nothing. --explain=measure: and what each costs");
    app.add_option("--pixel", texts.pixel, "print how this pixel comes about, ray by ray; renders nothing")
        ->type_name("X,Y");
    app.add_option("--json", texts.json, "with --pixel: the same as JSON; - is standard output")->type_name("FILE");
    app.add_flag("--resume", texts.resume, "skip frames whose file is complete and of the same scene and settings");
    app.add_option("--progress", texts.progress,
                   "auto, plain or none; or, for programs, on standard output: json, or openjd (Open Job Description)")
        ->type_name("STYLE");
    app.add_flag("-q,--quiet", texts.quiet, "errors only");
    app.add_flag("-v,--verbose", texts.verbose, "also times, hashes and effects");
    app.add_flag("--print-template", texts.print_template, "print the seed's text input and exit");
    app.add_flag("--version", texts.version, "print the version and exit");
    app.set_help_flag("-h,--help", "print this and exit");
}

RenderOptions checked_options(const OptionTexts& texts) {
    RenderOptions options;
    if (texts.version) options.action = Action::print_version;
    if (texts.print_template) options.action = Action::print_template;
    if (texts.list_devices) options.action = Action::list_devices;
    if (options.action != Action::render) return options;
    if (!texts.explain.empty())
        options.action =
            chosen<Action>("--explain", texts.explain, {{"needs", Action::explain}, {"measure", Action::measure}});

    options.scene = texts.scene;
    options.layers = texts.layers;
    options.output = texts.output;
    options.preview = texts.preview;
    options.view = parse_view(texts.view);
    options.stats = texts.stats;
    options.resume = texts.resume;
    options.strict = texts.strict;
    options.quiet = texts.quiet;
    options.verbose = texts.verbose;
    options.json = texts.json;
    options.backend = parse_backend(texts.backend);
    options.devices = parse_devices(texts.device, options.backend);
    options.wanted_precision = chosen<std::optional<Precision>>(
        "--precision", texts.precision,
        {{"auto", std::nullopt}, {"float", Precision::single_}, {"double", Precision::double_}});
    options.precision = options.wanted_precision.value_or(Precision::single_);
    options.all_effects = chosen<bool>("--effects", texts.effects, {{"auto", false}, {"all", true}});
    options.progress = chosen<ProgressStyle>("--progress", texts.progress,
                                             {{"auto", ProgressStyle::automatic},
                                              {"plain", ProgressStyle::plain},
                                              {"none", ProgressStyle::none},
                                              {"json", ProgressStyle::json},
                                              {"openjd", ProgressStyle::openjd}});
    if (!texts.frames.empty()) options.frames = parse_frames(texts.frames);
    if (!texts.resolution.empty()) options.resolution = parse_size(texts.resolution);
    if (!texts.crop.empty()) options.crop = parse_crop(texts.crop);
    if (!texts.tiles.empty()) options.tiles = parse_tiles(texts.tiles);
    if (!texts.tile.empty() && !texts.tiles.empty())
        options.tile = integer_option("--tile", texts.tile, 0, options.tiles.count() - 1);
    if (!texts.pixel.empty()) {
        options.pixel = parse_pixel(texts.pixel);
        options.action = Action::pixel;
    }
    if (!texts.layers.empty()) options.channels = parse_layers(texts.layers);
    options.channels.half = chosen<bool>("--bits", texts.bits, {{"float", false}, {"half", true}});
    options.channels.transparent =
        chosen<bool>("--background", texts.background, {{"opaque", false}, {"transparent", true}});
    options.channels.space = parse_color_space(texts.color_space);
    options.channels.compression = chosen<Compression>("--compression", texts.compression,
                                                       {{"none", Compression::none},
                                                        {"rle", Compression::rle},
                                                        {"zips", Compression::zips},
                                                        {"zip", Compression::zip},
                                                        {"piz", Compression::piz},
                                                        {"dwaa", Compression::dwaa},
                                                        {"dwab", Compression::dwab}});
    options.split = chosen<Split>("--split", texts.split,
                                  {{"none", Split::none}, {"parts", Split::parts}, {"files", Split::files}});
    if (!texts.z_far.empty()) options.channels.z_far = parse_z_far(texts.z_far);
    if (!texts.dwa_level.empty()) options.channels.dwa_level = parse_dwa_level(texts.dwa_level);
    if (!texts.supersample.empty())
        options.supersample = integer_option("--supersample", texts.supersample, 1, largest_supersample);
    if (!texts.depth.empty()) options.depth = integer_option("--depth", texts.depth, 1, largest_depth);
    if (!texts.lanes.empty()) options.lanes = integer_option("--lanes", texts.lanes, 1, 16);
    if (!texts.threads.empty()) options.threads = integer_option("--threads", texts.threads, 1, 1024);
    if (!texts.cutoff.empty()) {
        options.cutoff = whole_number<double>(texts.cutoff);
        if (!options.cutoff || !std::isfinite(*options.cutoff) || *options.cutoff < 0)
            fail_usage(fmt::format("--cutoff {}: must be a number, 0 or above, in the scene's units of radiance",
                                   texts.cutoff));
    }
    if (!texts.target_error.empty()) {
        options.target_error = whole_number<double>(texts.target_error);
        if (!options.target_error || !std::isfinite(*options.target_error) || !(*options.target_error > 0))
            fail_usage(fmt::format("--target-error {}: must be a number above 0, in the scene's units of radiance",
                                   texts.target_error));
    }
    if (!texts.max_texture_gb.empty()) {
        const std::optional<double> gigabytes = whole_number<double>(texts.max_texture_gb);
        if (!gigabytes || !(*gigabytes > 0) || !(*gigabytes <= 1e6))
            fail_usage(fmt::format("--max-texture-gb {}: must be a number above 0, to 1000000",
                                   one_line(texts.max_texture_gb)));
        options.texture_bytes = static_cast<uint64_t>(*gigabytes * 1e9);
    }
    if (!texts.max_samples.empty())
        options.max_samples =
            integer_option("--max-samples", texts.max_samples, least_lattice_samples, lattice_samples);
    refuse_exclusions(texts);
    if (options.action == Action::pixel && options.frames.size() > 1)
        fail_usage(fmt::format("--frames names {} frames, and --pixel {} is of one; name that one",
                               options.frames.size(), texts.pixel));
    if (options.scene.empty())
        fail_usage("no scene is given: render SCENE -o FILE.exr, or - for standard input; --help tells more");
    return options;
}

RenderOptions parse_options(int argc, const char* const* argv) {
    CLI::App app;
    OptionTexts texts;
    declare_render_options(app, texts);
    const bool whole = parse_command_line(app, argc, argv, [&](const std::string& extra) {
        return fmt::format("{}: one scene at a time, and {} is it already", extra, texts.scene);
    });
    if (!whole) {
        RenderOptions options;
        options.action = Action::print_help;
        return options;
    }
    return checked_options(texts);
}

std::string help_text() {
    CLI::App app("Renders a scene to OpenEXR: the same bits on every machine and with any number of threads.",
                 "render");
    OptionTexts texts;
    declare_render_options(app, texts);
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
