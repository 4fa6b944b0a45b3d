#include "suite_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/common/command_line.h"
#include "apps/common/render_options.h"
#include "base/suggest.h"
#include "scene/compile/scene_source.h"
#include "scene/readers/read_scene.h"
#include "sequence/run_files.h"

namespace cistula {
namespace {

void declare(CLI::App& app, SuiteOptions& options) {
    app.add_option("DIR", options.folder, "the folder of a suite.json")->type_name("");
    app.add_option("CASE", options.cases, "these cases only")->type_name("");
    app.add_option("--filter", options.filters,
                   "cases with a name or a tag that this is, or that a pattern with * and ? fits; may be given several "
                   "times")
        ->type_name("PATTERN")
        ->expected(1)
        ->take_all();
    add_key(app, options.request, "backend", "embree (CPU) or cuda (GPU); those that each case names");
    add_key(app, options.request, "device");
    app.add_flag("--update", options.update,
                 "write golden images and hashes anew where they differ, and say what changed");
    add_option(app, "--jobs", "N", "cases that are rendered at once; 1", read_whole(options.jobs, 1, 1024));
    app.add_flag("--fail-fast", options.fail_fast, "begin no further case after one that failed");
    app.add_option("--junit", options.junit, "write the results as JUnit XML")->type_name("FILE");
    app.add_option("--json", options.json, "write the results as JSON")->type_name("FILE");
    add_option(app, "--html", "DIR",
               "write the results, with what differs, as a page that needs nothing else: DIR/index.html",
               [&](const std::string& text) { options.html = (std::filesystem::path(text) / "index.html").string(); });
    app.add_flag("--list", options.list, "print the cases, each with a tab and its tags, and exit");
    app.add_flag("-q,--quiet", options.quiet, "errors only; the exit code tells");
    app.set_help_flag("-h,--help", "print this and exit");
}

/// Adds a scene, and the files that it names if they are asked for. What is wrong with a scene is said by its cases.
void add_scene(const std::string& path, bool with_files, RunFiles& files) {
    files.reads(path, "a scene");
    if (!with_files) return;
    try {
        files.reads_scene(path, gather_scene(read_scene(path)).files);
    } catch (const Error&) {
    }
}

}  // namespace

SuiteOptions parse_suite_options(int argc, const char* const* argv) {
    CLI::App app;
    SuiteOptions options;
    declare(app, options);
    options.help =
        !parse_command_line(app, argc, argv, [](const std::string& extra) { return extra + ": no such word"; });
    if (app.count("--backend") > 0) options.backend = options.request.backend;
    options.devices = options.request.devices;
    if (!options.help && options.folder.empty())
        fail_usage("no suite is given: render-compare suite DIR, the folder of a suite.json");
    return options;
}

std::string suite_help_text() {
    CLI::App app("Renders the cases of a suite of golden images, DIR/suite.json, and compares.",
                 "render-compare suite");
    SuiteOptions options;
    declare(app, options);
    app.footer(R"(
Examples:
  render-compare suite golden                              every case, on the backends that it names
  render-compare suite golden glass --backend cuda         one of them, on a GPU
  render-compare suite golden --filter 'hard/*' --filter smoke --junit results.xml
  render-compare suite golden --update                     what differs becomes the golden image

Exit codes: 0 all cases hold, 1 some do not, 2 command line or suite.json, 3 file, 4 device, 130 interrupted.)");
    return app.help();
}

void require_other_files(const Suite& suite, const SuiteOptions& options, const std::vector<const SuiteCase*>& chosen) {
    namespace fs = std::filesystem;
    RunFiles files;
    files.reads(suite.path, "the suite");
    std::error_code ignored;
    // A file that is not there yet is none that a scene names.
    const bool replaces = options.update || fs::exists(options.junit, ignored) || fs::exists(options.json, ignored) ||
                          fs::exists(options.html, ignored);
    std::set<std::string> scenes;
    for (const SuiteCase& one : suite.cases)
        if (scenes.insert(one.scene_path(suite.folder)).second)
            add_scene(one.scene_path(suite.folder), replaces, files);
    for (const bool updated : {false, true})
        for (const SuiteCase& one : suite.cases) {
            const bool is_chosen = std::find(chosen.begin(), chosen.end(), &one) != chosen.end();
            if ((options.update && is_chosen) != updated || one.golden.empty()) continue;
            for (const int frame : one.frames) {
                const std::string path = one.golden_path(suite.folder, frame);
                if (updated)
                    files.writes(path, "the golden image of " + one.name);
                else
                    files.reads(path, "the golden image of " + one.name);
            }
        }
    files.writes(options.junit, "--junit");
    files.writes(options.json, "--json");
    files.writes(options.html, "--html");
}

}  // namespace cistula
