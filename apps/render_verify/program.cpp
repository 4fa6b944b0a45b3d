#include "apps/render_verify/program.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <CLI/CLI.hpp>
#include <chrono>

#include "apps/common/command_line.h"
#include "apps/common/step_progress.h"
#include "apps/render_verify/report.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/suggest.h"
#include "sequence/backends.h"
#include "sequence/run_files.h"

namespace cistula::verify {
namespace {

enum class Action { run, list, print_version };

struct VerifyOptions {
    Action action = Action::run;
    RunSettings settings;
    std::vector<std::string> cases;  // as --case gives them; none: all
    std::string json, html;          // files; empty: none
};

void declare(CLI::App& app, VerifyOptions& options) {
    RunSettings& settings = options.settings;
    using Kinds = std::vector<IntersectorKind>;
    const Kinds host{IntersectorKind::embree, IntersectorKind::lanes, IntersectorKind::bvh, IntersectorKind::brute};
    Kinds all = host;
    all.push_back(IntersectorKind::cuda);
    settings.intersectors = host;
    settings.precisions = {Precision::single_, Precision::double_};
    add_option(app, "--backend", "NAME", "embree (the CPU: embree, lanes, bvh, brute), cuda (a GPU) or all; embree",
               read_choice(settings.intersectors, {{"embree", host}, {"cuda", {IntersectorKind::cuda}}, {"all", all}}));
    add_option(app, "--precision", "NAME", "float, double or both; both",
               read_choice(
                   settings.precisions,
                   {{"float", {Precision::single_}}, {"double", {Precision::double_}}, {"both", settings.precisions}}));
    app.add_option(
           "--case", options.cases,
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

bool fits(const std::string& wanted, const std::string& name) {
    if (wanted.find_first_of("*?") != std::string::npos) return fnmatch(wanted.c_str(), name.c_str(), 0) == 0;
    return name.compare(0, wanted.size(), wanted) == 0;
}

std::vector<const Case*> chosen_cases(const std::vector<std::string>& wanted, const std::vector<Case>& cases) {
    std::vector<bool> taken(cases.size(), wanted.empty());
    for (const std::string& text : wanted) {
        bool any = false;
        for (size_t i = 0; i < cases.size() && !any; ++i)
            if (cases[i].name == text)
                any = taken[i] = true;  // an exact name is chosen even if it is a prefix of others
        for (size_t i = 0; i < cases.size() && !any; ++i)
            if (fits(text, cases[i].name)) taken[i] = true;
        for (size_t i = 0; i < cases.size(); ++i) any = any || fits(text, cases[i].name);
        if (any) continue;
        std::vector<std::string_view> names;
        for (const Case& one : cases) names.push_back(one.name);
        const std::string near = suggestion(text, names, "cases");
        fail_usage(fmt::format("--case {}: there is no such case; {}--list names them all", text,
                               near.rfind("did you", 0) == 0 ? near + "; " : ""));
    }
    std::vector<const Case*> chosen;
    for (size_t i = 0; i < cases.size(); ++i)
        if (taken[i]) chosen.push_back(&cases[i]);
    return chosen;
}

int run(const VerifyOptions& options, const std::vector<const Case*>& cases) {
    RunContext context{options.settings.quick};
    if (options.settings.intersectors.back() == IntersectorKind::cuda) {
        const ChosenDevices devices = choose_devices(Backend::cuda, {});
        context.devices = devices.names;
        context.driver = devices.driver;
    }
    // Checked before a long run rather than after it.
    for (const std::string& file : {options.json, options.html})
        if (!file.empty()) AtomicFile probe(file);
    const auto start = std::chrono::steady_clock::now();
    print(table_head(cases));
    const std::vector<Outcome> outcomes = [&] {
        StepProgress progress(ProgressStyle::automatic);
        return run_cases(cases, options.settings, progress,
                         [&](const Outcome& outcome) { progress.aside([&] { print(table_row(outcome, cases)); }); });
    }();
    context.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    print(summary(outcomes));
    if (!options.json.empty())
        write_file_atomically(
            options.json,
            report_json(outcomes, context).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!options.html.empty()) write_file_atomically(options.html, report_html(outcomes, context));
    bool hold = !outcomes.empty();
    for (const Outcome& outcome : outcomes) hold = hold && outcome.holds();
    return static_cast<int>(hold ? ExitCode::done : ExitCode::failed);
}

}  // namespace

int verify_program(int argc, const char* const* argv, const std::vector<Case>& cases) {
    CLI::App app("Checks hard cases against closed forms, on every intersector of this machine.", "render-verify");
    VerifyOptions options;
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
        const std::vector<const Case*> chosen = chosen_cases(options.cases, cases);
        RunFiles files;
        files.writes(options.json, "--json");
        files.writes(options.html, "--html");
        if (options.action == Action::run) return run(options, chosen);
        print(list_text(cases));
    }
    return 0;
}

}  // namespace cistula::verify
