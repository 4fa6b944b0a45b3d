#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string_view>

#include "apps/common/command_line.h"

namespace cistula {
namespace {

/// Options of render that are of one run and not of a job.
constexpr const char* refused[] = {"--tile",   "--stats",    "--explain",      "--pixel",         "--json",
                                   "--resume", "--progress", "--list-devices", "--print-template"};

/// Keys that tasks do not pass on as they are.
constexpr std::string_view own[] = {"scene", "output", "frames", "tiles", "quiet", "verbose"};

/// Keys of previews: of tiles, render-merge makes them.
constexpr std::string_view of_previews[] = {"preview", "exposure", "view", "bloom"};

void declare_farm_options(CLI::App& app, FarmOptions& options) {
    declare_render_options(app, options.render);
    for (const char* name : refused) app.get_option(name)->group("");
    app.get_option("--tiles")->description("cut every frame into a grid of tiles, which render-merge puts together");
    app.add_option("--to", options.folder, "the folder of the job's files; NAME.farm in the working directory")
        ->type_name("DIR");
    add_option(app, "--task-seconds", "S", "about how long a task takes on a machine as this; 300",
               read_number(options.task_seconds, 1e-3, 1e7, "a number from 0.001 to 10000000"));
    add_option(app, "--most-tasks", "N", "longer tasks where there would be more than these; 1000",
               read_whole(options.most_tasks, 1, 1'000'000));
}

}  // namespace

FarmOptions parse_farm_options(int argc, const char* const* argv) {
    CLI::App app;
    FarmOptions options;
    RenderCommand& render = options.render;
    declare_farm_options(app, options);
    const bool whole = parse_command_line(app, argc, argv, [&](const std::string& extra) {
        return fmt::format("{}: one scene at a time, and {} is it already", extra, render.scene);
    });
    if (!whole || render.action == Action::print_version) {
        options.action = whole ? FarmAction::print_version : FarmAction::print_help;
        return options;
    }
    for (const char* name : refused)
        if (app.count(name) > 0)
            fail_usage(fmt::format("{}: is of a run of render, not of a job of many; leave it out", name));
    if (render.tiles && render.tiles->count() == 1) render.tiles.reset();
    check_render_options(app, render);
    for (const RequestKey& key : request_keys()) {
        if (std::ranges::count(own, key.name) > 0 || !key.given(render)) continue;
        const bool of_preview = std::ranges::count(of_previews, key.name) > 0;
        std::vector<std::string>& to = render.tiles && of_preview ? options.merged : options.passed;
        const std::string name = option_name(key.name);
        to.push_back(key.type == KeyType::boolean ? name : name + '=' + key.text(render));
    }
    if (render.scene == "-") fail_usage("-: every task reads the scene; give a file");
    return options;
}

std::string farm_help_text() {
    CLI::App app("Writes a film as tasks for many machines: for Open Job Description, for Slurm, for make.",
                 "render-farm");
    FarmOptions options;
    declare_farm_options(app, options);
    app.footer(R"(
Examples:
  render-farm scenes/seed.json -o out/beauty.####.exr --to farm
  render-farm scenes/seed.json -o out/beauty.####.exr --to farm --tiles 4x3 --bits half --task-seconds 600
  make -j 2 -f farm/Makefile                  on this machine
  sh farm/submit.sh                           by Slurm
  openjd run farm/job.openjd.json             by Open Job Description

Tasks may be killed and repeated; what is complete stays. The last one writes farm/manifest.sha256.

Exit codes: as of render.)");
    return app.help();
}

}  // namespace cistula
