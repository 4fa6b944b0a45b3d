#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string_view>

#include "apps/common/command_line.h"

namespace cistula {
namespace {

/// The texts of the options that render does not have.
struct FarmTexts {
    std::string folder, task_seconds, most_tasks;
};

/// Options of render that are of one run and not of a job.
constexpr std::string_view refused[] = {"--tile",   "--stats",    "--explain",      "--pixel",         "--json",
                                        "--resume", "--progress", "--list-devices", "--print-template"};

/// Options that tasks do not pass on as they are.
constexpr std::string_view own[] = {"--output",     "--frames", "--tiles",   "--to",      "--task-seconds",
                                    "--most-tasks", "--quiet",  "--verbose", "--version", "--help"};

/// Options of previews: of tiles, render-merge makes them.
constexpr std::string_view of_previews[] = {"--preview", "--exposure", "--view", "--bloom"};

template <size_t count>
bool is_in(const std::string_view (&names)[count], const std::string& name) {
    return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

void declare_farm_options(CLI::App& app, OptionTexts& render, FarmTexts& texts) {
    declare_render_options(app, render);
    for (const std::string_view name : refused) app.get_option(std::string(name))->group("");
    app.get_option("--tiles")->description("cut every frame into a grid of tiles, which render-merge puts together");
    app.add_option("--to", texts.folder, "the folder of the job's files; NAME.farm in the working directory")
        ->type_name("DIR");
    app.add_option("--task-seconds", texts.task_seconds, "about how long a task takes on a machine as this; 300")
        ->type_name("S");
    app.add_option("--most-tasks", texts.most_tasks, "longer tasks where there would be more than these; 1000")
        ->type_name("N");
}

/// The argument by which an option was given.
std::string given(const CLI::Option& option, const std::string& name) {
    const bool is_flag = option.get_type_size_max() == 0 || option.get_items_expected_max() == 0;
    return is_flag ? name : name + '=' + option.results().back();
}

}  // namespace

FarmOptions parse_farm_options(int argc, const char* const* argv) {
    CLI::App app;
    OptionTexts render;
    FarmTexts texts;
    declare_farm_options(app, render, texts);
    FarmOptions options;
    const bool whole = parse_command_line(app, argc, argv, [&](const std::string& extra) {
        return fmt::format("{}: one scene at a time, and {} is it already", extra, render.scene);
    });
    if (!whole || render.version) {
        options.action = whole ? FarmAction::print_version : FarmAction::print_help;
        return options;
    }
    if (!render.tiles.empty()) {
        const TileGrid grid = parse_tiles(render.tiles);
        if (grid.count() > 1) options.tiles = grid;
    }
    for (const CLI::Option* option : app.get_options()) {
        if (option->count() == 0 || option->get_lnames().empty()) continue;
        const std::string name = "--" + option->get_lnames().front();
        if (is_in(refused, name))
            fail_usage(fmt::format("{}: is of a run of render, not of a job of many; leave it out", name));
        if (is_in(own, name)) continue;
        std::vector<std::string>& to = options.tiles && is_in(of_previews, name) ? options.merged : options.passed;
        to.push_back(given(*option, name));
    }
    render.tiles = "";
    options.render = checked_options(render);
    if (options.tiles) {  // what a tile cannot be
        OptionTexts tile = render;
        tile.tiles = fmt::format("{}x{}", options.tiles->columns, options.tiles->rows);
        tile.tile = "0";
        tile.preview = "";
        tile.view = {};
        (void)checked_options(tile);
    }
    if (options.render.scene == "-") fail_usage("-: every task reads the scene; give a file");
    options.folder = texts.folder;
    if (!texts.task_seconds.empty())
        options.task_seconds =
            number_option("--task-seconds", texts.task_seconds, 1e-3, 1e7, "a number from 0.001 to 10000000");
    if (!texts.most_tasks.empty()) options.most_tasks = integer_option("--most-tasks", texts.most_tasks, 1, 1'000'000);
    options.quiet = render.quiet;
    return options;
}

std::string farm_help_text() {
    CLI::App app("Writes a film as tasks for many machines: for Open Job Description, for Slurm, for make.",
                 "render-farm");
    OptionTexts render;
    FarmTexts texts;
    declare_farm_options(app, render, texts);
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
