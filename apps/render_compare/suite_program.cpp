#include "apps/common/interrupt.h"
#include "suite_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/common/command_line.h"
#include "base/atomic_file.h"
#include "compare/suite/suite_report.h"
#include "compare/suite/suite_update.h"
#include "sequence/output_name.h"

namespace cistula {
namespace {

std::string list_text(const std::vector<const SuiteCase*>& chosen) {
    std::string text;
    for (const SuiteCase* one : chosen) text += fmt::format("{}\t{}\n", one->name, fmt::join(one->tags, ","));
    return text;
}

/// Makes the folders of the files to be written, and finds out before the first picture if they cannot be written.
void probe(const std::string& path) {
    if (path.empty() || path == "-") return;
    make_directory_of(path);
    const AtomicFile file(path);
}

void write_reports(const Suite& suite, const std::vector<SuiteResult>& results,
                   const std::vector<SuiteBackend>& backends, const SuiteCounts& counts, const SuiteOptions& options) {
    if (!options.junit.empty()) write_output(options.junit, junit_xml(suite, results));
    if (!options.html.empty()) write_output(options.html, suite_page(suite, results, counts));
    if (!options.json.empty())
        write_output(
            options.json,
            suite_json(suite, results, backends, counts).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                "\n");
}

ExitCode exit_code(const SuiteCounts& counts) {
    if (counts.failed > 0) return ExitCode::failed;
    return counts.held == 0 ? ExitCode::device : ExitCode::done;
}

}  // namespace

int run_suite(int argc, const char* const* argv) {
    const SuiteOptions options = parse_suite_options(argc, argv);
    if (options.help) {
        print(suite_help_text());
        return static_cast<int>(ExitCode::done);
    }
    const Suite suite = read_suite(options.folder);
    const std::vector<const SuiteCase*> chosen = chosen_cases(suite, options);
    if (options.list) {
        print(list_text(chosen));
        return static_cast<int>(ExitCode::done);
    }
    require_other_files(suite, options, chosen);
    std::vector<SuiteBackend> backends = find_backends(chosen, options);
    for (SuiteBackend& backend : backends) backend.obstacle = with_options(backend.obstacle);
    for (const std::string& path : {options.junit, options.json, options.html}) probe(path);

    size_t name_width = 8;
    for (const SuiteCase* one : chosen) name_width = std::max(name_width, one->name.size());
    const auto say = [&](const std::string& text) {
        if (!options.quiet) print(text);
    };
    say(table_head(suite, backends, name_width));
    SuiteUpdate update(suite);
    RenderProgress progress;
    const StopOnInterrupt watch(progress.stop);
    SuiteWork work;
    work.judged = [&](const SuiteFrame& frame, const LayeredPicture* golden, SuiteResult& result) {
        if (!options.html.empty() && result.failed())
            result.page = failure_html(result, suite.folder, golden, frame.picture, progress.stop);
        if (options.update) update.record(frame, golden, result);
    };
    work.finished = [&](std::vector<SuiteResult>& results) {
        for (SuiteResult& result : results) {
            result.verdict = with_options(result.verdict);
            for (std::string& note : result.notes) note = with_options(note);
        }
        say(table_rows(results, name_width));
        if (options.update) update.finish(results);
    };
    std::vector<SuiteResult> results;
    try {
        results = run_cases(suite, chosen, backends, options, work, progress);
    } catch (const Error&) {
        update.write();  // what was recorded by then
        throw;
    }
    update.write();
    const SuiteCounts counts = count_results(results, chosen.size());
    write_reports(suite, results, backends, counts, options);
    if (progress.stop && counts.not_begun > 0)
        throw Error(ErrorKind::interrupted, fmt::format("interrupted; {} of {} cases are judged",
                                                        chosen.size() - counts.not_begun, chosen.size()));
    if (options.update)
        say(fmt::format("recorded: {} of {} pictures{}\n", update.changed(), results.size(),
                        counts.failed > 0 ? fmt::format("; {} failed", counts.failed) : ""));
    else
        say(summary_text(counts));
    return static_cast<int>(exit_code(counts));
}

}  // namespace cistula
