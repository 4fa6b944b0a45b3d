#include "apps/render_verify/program.h"

#include <chrono>

#include "apps/common/command_line.h"
#include "apps/common/step_progress.h"
#include "apps/render_verify/report.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "sequence/backends.h"

namespace cistula::verify {
namespace {

int run(const VerifyOptions& options) {
    RunContext context;
    if (options.cuda) {
        const ChosenDevices devices = choose_devices(Backend::cuda, {});
        context.devices = devices.names;
        context.driver = devices.driver;
    }
    // Checked before a long run rather than after it.
    for (const std::string& file : {options.json, options.html})
        if (!file.empty()) AtomicFile probe(file);
    const auto start = std::chrono::steady_clock::now();
    print(table_head(options.cases));
    const std::vector<Outcome> outcomes = [&] {
        StepProgress progress(ProgressStyle::automatic);
        return run_cases(options.cases, options.settings, progress, [&](const Outcome& outcome) {
            progress.aside([&] { print(table_row(outcome, options.cases)); });
        });
    }();
    context.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    print(summary(outcomes));
    if (!options.json.empty())
        write_file_atomically(
            options.json,
            report_json(outcomes, options, context).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                "\n");
    if (!options.html.empty()) write_file_atomically(options.html, report_html(outcomes, options, context));
    bool hold = !outcomes.empty();
    for (const Outcome& outcome : outcomes) hold = hold && outcome.holds();
    return static_cast<int>(hold ? ExitCode::done : ExitCode::failed);
}

}  // namespace

int verify_program(int argc, const char* const* argv, const std::vector<CaseEntry>& cases) {
    const VerifyOptions options = parse_verify_options(argc, argv, cases);
    switch (options.action) {
        case VerifyAction::print_help:
            print(verify_help_text());
            return 0;
        case VerifyAction::print_version:
            print("render-verify (Cistula) " CISTULA_VERSION "\n");
            return 0;
        case VerifyAction::list:
            print(list_text(cases));
            return 0;
        default:
            return run(options);
    }
}

}  // namespace cistula::verify
