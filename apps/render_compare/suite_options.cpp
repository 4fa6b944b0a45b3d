#include "suite_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <set>

#include "apps/common/command_line.h"
#include "apps/common/render_options.h"
#include "base/suggest.h"
#include "compare/suite/suite_render.h"
#include "scene/compile/scene_source.h"
#include "sequence/output_name.h"
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
    app.add_flag("--run-commands", options.run_commands,
                 "run the commands by which cases have other programs render; without it such cases fail");
    app.add_flag("--fail-fast", options.fail_fast, "begin no further case after one that failed");
    app.add_option("--junit", options.junit, "write the results as JUnit XML; - is standard output")->type_name("FILE");
    app.add_option("--json", options.json, "write the results as JSON; - is standard output")->type_name("FILE");
    add_option(app, "--html", "DIR",
               "write the results, with what differs, as a page that needs nothing else: DIR/index.html",
               [&](const std::string& text) { options.html = (std::filesystem::path(text) / "index.html").string(); });
    app.add_flag("--list", options.list, "print the cases, each with a tab and its tags, and exit");
    app.add_flag("-q,--quiet", options.quiet, "errors only; the exit code tells");
    app.set_help_flag("-h,--help", "print this and exit");
}

/// Adds the files that a scene names. What is wrong with a scene is said by its cases.
void add_files_of_scene(const SuiteCase& one, const std::string& folder, RunFiles& files) {
    try {
        files.reads_scene(one.scene_path(folder), gather_scene(read_scene_of(one, folder)).files);
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
    if (options.junit == "-" && options.json == "-") fail_usage("--junit - and --json -: give one of them a file");
    options.quiet |= options.junit == "-" || options.json == "-";
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
    const std::set<const SuiteCase*> rendered(chosen.begin(), chosen.end());
    std::vector<std::string> written = {options.junit, options.json, options.html};
    std::error_code ignored;
    // A file that is not there yet is none that a scene names.
    const bool replaces = options.update || std::any_of(written.begin(), written.end(), [&](const std::string& path) {
                              return fs::exists(path, ignored);
                          });
    std::set<std::string> scenes;  // of which the files are known
    for (const SuiteCase& one : suite.cases) {
        if (one.is_foreign()) continue;
        files.reads(one.scene_path(suite.folder), "a scene");
        if (replaces && rendered.contains(&one) && scenes.insert(one.scene_path(suite.folder)).second)
            add_files_of_scene(one, suite.folder, files);
    }
    for (const SuiteCase* one : chosen)
        for (size_t i = 0; options.update && !one->golden.empty() && i < one->frames.size(); ++i)
            written.push_back(one->golden_path(suite.folder, one->frames[i]));
    for (const SuiteCase& one : suite.cases) {
        const bool many = one.frames.size() > 1;
        for (const int frame : many ? frames_named_in(written, one.frames) : one.frames) {
            if (!one.rendered.empty())
                files.reads(one.rendered_path(suite.folder, frame), "the picture of " + one.name);
            if (!one.golden.empty() && !(options.update && rendered.contains(&one)))
                files.reads(one.golden_path(suite.folder, frame), "the golden image of " + one.name);
        }
    }
    for (const SuiteCase* one : chosen)
        for (size_t i = 0; options.update && !one->golden.empty() && i < one->frames.size(); ++i)
            files.writes(one->golden_path(suite.folder, one->frames[i]), "the golden image of " + one->name);
    if (options.junit != "-") files.writes(options.junit, "--junit");
    if (options.json != "-") files.writes(options.json, "--json");
    files.writes(options.html, "--html");
}

}  // namespace cistula
