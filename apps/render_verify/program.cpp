#include "apps/render_verify/program.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <utility>

#include "apps/common/command_line.h"
#include "apps/common/interrupt.h"
#include "apps/common/programs.h"
#include "apps/common/step_progress.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "sequence/backends.h"
#include "sequence/run_files.h"

namespace cistula::verify {
namespace {

enum class Action { run, list, print_version };

struct VerifyOptions {
    Action action = Action::run;
    Options settings;
    std::string json, html;  // files; empty: none
};

void declare(CLI::App& app, VerifyOptions& options) {
    Options& settings = options.settings;
    add_option(app, "--backend", "NAME", "embree (the CPU: embree, lanes, bvh, brute), cuda (a GPU) or all; embree",
               read_by(settings.intersectors, intersectors_of));
    add_option(app, "--precision", "NAME", "float, double or both; both",
               read_choice(
                   settings.precisions,
                   {{"float", {Precision::single_}}, {"double", {Precision::double_}}, {"both", settings.precisions}}));
    app.add_option(
           "--case", settings.cases,
           "only this case, those whose names begin so, or those that a pattern with * and ? fits; may be given "
           "several times")
        ->type_name("NAME")
        ->expected(1)
        ->take_all();
    add_option(app, "--lanes", "N", "the most rays that `lanes` traces at once, 1 to 16; all that the processor can",
               read_whole(settings.lanes, 1, 16));
    app.add_flag("--quick", settings.quick, "every case with fewer rays and smaller images");
    const auto add_action = [&](const char* name, const char* description, Action action) {
        app.add_flag_callback(
            name, [&options, action] { options.action = action; }, description);
    };
    add_action("--list", "print the cases and exit", Action::list);
    app.add_option("--json", options.json, "write the result as JSON")->type_name("FILE");
    app.add_option("--html", options.html, "write the result as a page that needs nothing else")->type_name("FILE");
    add_action("--version", "print the version and exit", Action::print_version);
    app.set_help_flag("-h,--help", "print this and exit");
}

size_t widest(const std::vector<CaseName>& cases) {
    size_t width = 4;
    for (const CaseName& one : cases) width = std::max(width, one.name.size());
    return width;
}

int run(const VerifyOptions& options, const std::vector<CaseName>& cases) {
    const Options& settings = options.settings;
    RunContext context{settings.quick};
    if (settings.intersectors.back() == IntersectorKind::cuda) {
        const ChosenDevices devices = choose_devices(Backend::cuda, {});
        context.devices = devices.names;
        context.driver = devices.driver;
    }
    // Checked before a long run rather than after it.
    for (const std::string& file : {options.json, options.html})
        if (!file.empty()) AtomicFile probe(file);
    const auto start = std::chrono::steady_clock::now();
    const size_t width = widest(cases);
    const std::vector<Row> rows = [&] {
        StepProgress progress(ProgressStyle::automatic);
        const StopOnInterrupt watch(progress.render.stop);
        print(table_head(width));
        progress.begin("cases", static_cast<double>(cases.size() * settings.precisions.size()));
        Options with_events = settings;
        bool first = true;
        with_events.begun = [&](const std::string& name) {
            if (!std::exchange(first, false)) progress.advance();
            progress.name_part(name);
        };
        with_events.finished = [&](const Row& row) { progress.aside([&] { print(table_row(row, width)); }); };
        return verify::run(with_events, progress.render);
    }();
    context.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    print(summary(rows));
    if (!options.json.empty())
        write_file_atomically(
            options.json,
            report_json(rows, context).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!options.html.empty()) write_file_atomically(options.html, report_html(rows, context));
    const bool hold =
        !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.holds(); });
    return static_cast<int>(hold ? ExitCode::done : ExitCode::failed);
}

}  // namespace

int verify_program(int argc, const char* const* argv, const std::vector<Case>* table) {
    CLI::App app("Checks hard cases against closed forms, on every intersector of this machine.", "render-verify");
    VerifyOptions options;
    options.settings.table = table;
    declare(app, options);
    app.footer(R"(
Examples:
  render-verify --quick                           a few minutes on a laptop
  render-verify --backend all --html verify.html  everything, on the GPU too
  render-verify --case geometry/ --precision float

Exit codes: 0 all cases hold, 1 some do not, 2 command line, 3 file, 4 device.)");
    const bool whole = parse_command_line(app, argc, argv, [](const std::string& extra) {
        return fmt::format("{}: unexpected; a case is chosen by --case", extra);
    });
    if (!whole) {
        print(app.help());
    } else if (options.action == Action::print_version) {
        print("render-verify (Cistula) " CISTULA_VERSION "\n");
    } else {
        const std::vector<CaseName> cases = chosen_cases(options.settings);
        RunFiles files;
        files.writes(options.json, "--json");
        files.writes(options.html, "--html");
        if (options.action == Action::run) return run(options, cases);
        std::string list;
        for (const CaseName& one : cases) list += fmt::format("{:<{}}  {}\n", one.name, widest(cases), one.exact);
        print(list);
    }
    return 0;
}

}  // namespace cistula::verify

int cistula::render_verify_program(int argc, const char* const* argv) {
    return run_program("render-verify", "--quick and fewer cases need less",
                       [&] { return verify::verify_program(argc, argv); });
}
