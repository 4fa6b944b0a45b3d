#include "apps/common/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iterator>

#include "apps/common/command_line.h"
#include "base/suggest.h"
#include "cistula/model/effects.h"
#include "cistula/model/lattice_settings.h"
#include "cistula/transport/ray_tree.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "scene/readers/read_scene.h"
#include "sequence/frame_list.h"

namespace cistula {
namespace {

ChosenPixel parse_pixel(std::string_view text) {
    const size_t comma = text.find(',');
    if (comma != text.npos) {
        const auto x = whole_number<int>(text.substr(0, comma));
        const auto y = whole_number<int>(text.substr(comma + 1));
        if (x && y && *x >= 0 && *y >= 0) return {*x, *y};
    }
    fail_usage("must be X,Y in pixels from the top left, which is 0,0, as in 320,240");
}

/// Throws Error (usage) for `other`, which has no place beside an option that was given with `text`.
[[noreturn]] void refuse(const char* option, const std::string& text, std::string_view other, const char* why) {
    fail_usage(fmt::format("{} {}: {} has no place here: {}; leave it out", option, text, other, why));
}

/// Refuses keys beside --pixel or --explore.
void check_pixel(const char* option, const std::string& text, const RenderCommand& command) {
    const std::pair<const char*, std::vector<const char*>> senseless[] = {
        {"no image is written",
         {"output", "preview", "layers", "bits", "strict", "background", "colorspace", "compression", "resume"}},
        {"nothing is timed", {"stats"}},
        {"pixels count from the top left of the full frame", {"crop", "tile"}},
        {"there are no frames to tell of", {"progress"}},
        {"it shows the samples of a grid; --supersample chooses one", {"target_error"}},
        {"the CPU follows the rays, and every backend gives the same bits", {"backend"}},
    };
    for (const auto& [why, keys] : senseless)
        for (const char* key : keys)
            if (request_key(key).given(command)) refuse(option, text, option_name(key), why);
    if (command.frames.size() > 1)
        fail_usage(fmt::format("--frames names {} frames, and {} {} is of one; name that one", command.frames.size(),
                               option, text));
}

}  // namespace

CLI::Option* add_key(CLI::App& app, RenderRequest& request, std::string_view name, const char* description) {
    const RequestKey& key = request_key(name);
    const std::string option = option_names(name);
    const std::string help = with_options(description ? description : key.help);
    if (key.type == KeyType::boolean)
        return app.add_flag_callback(
            option, [&request, &key] { key.set(request, "true"); }, help);
    return add_option(app, option, std::string(key.shape), help,
                      [&request, &key](const std::string& text) { key.set(request, text); });
}

namespace {

/// Adds render's options to a command line; `command` must outlive it.
void declare_render_options(CLI::App& app, RenderCommand& command) {
    for (const RequestKey& key : request_keys()) add_key(app, command, key.name);
    const auto add_action = [&](const char* name, const char* description, Action action) {
        app.add_flag_callback(
            name, [&command, action] { command.action = action; }, description);
    };
    // Its name in earlier versions: not in --help.
    add_option(app, "--aov", "LIST", "as --layers", [&command](const std::string& text) {
        if (!command.layers.empty()) fail_usage("is another name of --layers; give one of them");
        request_key("layers").set(command, text);
    })->group("");
    add_valued_flag(
        app, "--explain", "needs",
        "print the effects the scene calls for and why; renders nothing. --explain=measure: and what each costs",
        read_choice(command.action, {{"needs", Action::explain}, {"measure", Action::measure}}));
    CLI::Option* const pixel =
        add_option(app, "--pixel", "X,Y", "print how this pixel comes about, ray by ray; renders nothing",
                   [&command](const std::string& text) {
                       command.pixel = parse_pixel(text);
                       command.action = Action::pixel;
                   });
    add_option(app, "--json", "FILE", "with --pixel: the same as JSON; - is standard output",
               [&command](const std::string& text) { command.json = text; })
        ->needs(pixel);
    CLI::Option* const explore = add_option(app, "--explore", "FILE", "write a page that explains pixels; no image",
                                            [&command](const std::string& text) {
                                                command.page = text;
                                                command.action = Action::explore;
                                            });
    add_option(app, "--explore-mb", "N", "with --explore: megabytes of it, which the grid of its pixels fills (5)",
               read_number(command.page_mb, 0.01, 1000, "a number from 0.01 to 1000"))
        ->needs(explore);
    explore->excludes(pixel);
    add_action("--list-devices", "print the GPUs, or why there is none, and exit", Action::list_devices);
    add_action("--print-template", "print the seed's text input and exit", Action::print_template);
    add_action("--version", "print the version and exit", Action::print_version);
    app.set_help_flag("-h,--help", "print this and exit");
}

/// Checks how the options that were given fit together. Throws Error (usage).
void check_render_options(const CLI::App& app, const RenderCommand& command) {
    const std::string pixel = given_text(app, "--pixel");
    if (!pixel.empty()) check_pixel("--pixel", pixel, command);
    if (!command.page.empty()) check_pixel("--explore", command.page, command);
    if (app.count("--explain") > 0) {
        if (!pixel.empty()) refuse("--pixel", pixel, "--explain", "each prints a report of its own");
        if (!command.page.empty()) refuse("--explore", command.page, "--explain", "it prints a report of its own");
        if (command.tile) refuse("--tile", given_text(app, "--tile"), "--explain", "it tells of whole frames");
        if (is_for_programs(command.progress))
            refuse("--progress", given_text(app, "--progress"), "--explain", "it tells of frames that are written");
        if (command.action == Action::measure && command.frame.adaptive())
            refuse("--explain", "measure", "--target-error",
                   "it times the samples of a grid; --supersample chooses one");
    }
    check_request(command);
    if (request_key("z_far").given(command) && command.layers.empty())
        fail_usage(fmt::format("--z-far {}: is for --layers Z", given_text(app, "--z-far")));
    if (command.quiet && command.verbose) fail_usage("-q and -v exclude each other; give one");
    if (command.scene.empty())
        fail_usage("no scene is given: render SCENE -o FILE.exr, or - for standard input; --help tells more");
}

}  // namespace

RenderCommand parse_options(int argc, const char* const* argv) {
    CLI::App app;
    RenderCommand command;
    declare_render_options(app, command);
    const bool whole = parse_command_line(app, argc, argv, [&](const std::string& extra) {
        return fmt::format("{}: one scene at a time, and {} is it already", extra, command.scene);
    });
    if (app.count("--list-devices") > 0) command.action = Action::list_devices;  // whatever report is asked for, too
    if (!whole) command.action = Action::print_help;
    constexpr Action prints[] = {Action::print_help, Action::print_version, Action::print_template,
                                 Action::list_devices};
    if (std::find(std::begin(prints), std::end(prints), command.action) != std::end(prints)) return command;
    check_render_options(app, command);
    if (command.tiles && !command.tile)
        fail_usage(fmt::format("--tiles {}: is for --tile N, the one of them to render", given_text(app, "--tiles")));
    return command;
}

std::string help_text() {
    CLI::App app("Renders a scene to OpenEXR: the same bits on every machine and with any number of threads.",
                 "render");
    RenderCommand command;
    declare_render_options(app, command);
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
  render scenes/glass.json --explore glass.html                    a page in which a click on a pixel shows that
  render - < scenes/input.txt                                      the seed's input and frames
  render --print-template > input.txt

Without -o a scene is written to SCENE.exr in the working directory (SCENE.####.exr where -f names several frames), the
seed's text input to its own pattern. A name without a pattern holds one frame, -f's or the first.

Exit codes: 0 done, 1 the image cannot be trusted, 2 command line or scene, 3 file, 4 device,
5 target error not met (the image is written), 130 interrupted.)");
    return app.help();
}

}  // namespace cistula
