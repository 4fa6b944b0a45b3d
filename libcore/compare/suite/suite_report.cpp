#include "compare/suite/suite_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/shown_text.h"
#include "compare/metrics/report.h"
#include "sequence/run_context.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

std::string size_text(const SuiteResult& result) {
    return result.width > 0 ? fmt::format("{}x{}", result.width, result.height) : "-";
}

const char* precision_text(const SuiteResult& result) {
    return result.precision ? precision_name(*result.precision) : "-";
}

/// Text within XML: nothing in it is markup, and no character is one that XML lacks.
std::string xml(const std::string& text) {
    std::string out;
    for (const char c : one_line(text)) {
        constexpr std::string_view marks = "&<>\"";
        constexpr const char* entities[] = {"&amp;", "&lt;", "&gt;", "&quot;"};
        if (const size_t at = marks.find(c); at != marks.npos)
            out += entities[at];
        else
            out += c;
    }
    return out;
}

std::string junit_case(const Suite& suite, const SuiteResult& result) {
    std::string text = fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">\n", xml(suite.name),
                                   xml(result.of->name + variant_text(result)), result.seconds);
    const std::string verdict = xml(result.verdict);
    if (result.outcome == Outcome::skipped)
        text += fmt::format("      <skipped message=\"{}\"/>\n", verdict);
    else if (result.failed())
        text +=
            fmt::format("      <{} type=\"{}\" message=\"{}\"/>\n",
                        result.outcome == Outcome::broken ? "error" : "failure", outcome_name(result.outcome), verdict);
    std::string notes;
    for (const std::string& note : result.notes) notes += xml(note) + "\n";
    if (!notes.empty()) text += fmt::format("      <system-out>{}</system-out>\n", notes);
    return text + "    </testcase>\n";
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json() : Json(text);
}

Json result_json(const SuiteResult& result) {
    Json json = {{"name", result.of->name},
                 {"scene", result.of->scene},
                 {"frame", result.frame},
                 {"backend", result.of->source_name(result.backend)},
                 {"precision", result.precision ? Json(precision_name(*result.precision)) : Json()},
                 {"tags", result.of->tags},
                 {"outcome", outcome_name(result.outcome)},
                 {"verdict", result.verdict},
                 {"notes", result.notes},
                 {"width", result.width},
                 {"height", result.height},
                 {"render_seconds", result.seconds},
                 {"golden", text_or_null(result.golden)},
                 {"hash", text_or_null(result.hash)},
                 {"hash_golden", text_or_null(result.expected_hash)},
                 {"film_hash", text_or_null(result.film_hash)},
                 {"film_hash_golden", text_or_null(result.expected_film_hash)}};
    if (result.comparison)
        json["comparison"] = report_json(*result.comparison, result.of->thresholds, result.golden, "rendered");
    return json;
}

}  // namespace

std::string variant_text(const SuiteResult& result) {
    std::string text;
    if (result.of->backends.size() > 1) text = backend_name(result.backend);
    if (result.of->frames.size() > 1) text += fmt::format("{}frame {}", text.empty() ? "" : ", ", result.frame);
    return text.empty() ? "" : fmt::format(" [{}]", text);
}

std::string result_text(const SuiteResult& result) {
    switch (result.outcome) {
        case Outcome::skipped:
            return "skipped: " + result.verdict;
        case Outcome::broken:
            return "failed: " + result.verdict;
        default:
            return result.verdict;
    }
}

SuiteCounts count_results(const std::vector<SuiteResult>& results, size_t chosen) {
    SuiteCounts counts;
    const SuiteCase* last = nullptr;
    for (const SuiteResult& result : results) {
        counts.held += result.outcome == Outcome::holds;
        counts.skipped += result.outcome == Outcome::skipped;
        counts.failed += result.failed();
        chosen -= result.of != last;
        last = result.of;
    }
    counts.not_begun = chosen;
    return counts;
}

std::string table_head(const Suite& suite, const std::vector<SuiteBackend>& backends, size_t name_width) {
    std::string text;
    for (const SuiteBackend& one : backends)
        if (one.obstacle.empty())
            text +=
                fmt::format("{}{}{}", text.empty() ? "" : ", ", backend_name(one.backend),
                            one.devices.names.empty() ? "" : fmt::format(" on {}", fmt::join(one.devices.names, ", ")));
    return fmt::format("{}: {}\n{:<{}} {:>7} {:<7} {:<9} {:>11} {:>8}  {}\n", one_line(suite.path),
                       text.empty() ? "no backend" : one_line(text), "case", name_width, "frame", "backend",
                       "precision", "size", "seconds", "result (golden / rendered)");
}

std::string table_rows(const std::vector<SuiteResult>& results, size_t name_width) {
    std::string text;
    for (const SuiteResult& result : results) {
        text += fmt::format("{:<{}} {:>7} {:<7} {:<9} {:>11} {:>8.3f}  {}\n", result.of->name, name_width, result.frame,
                            result.of->source_name(result.backend), precision_text(result), size_text(result),
                            result.seconds, message_line(result_text(result)));
        if (result.failed())
            for (const std::string& note : result.notes) text += "    " + message_line(note) + "\n";
    }
    return text;
}

std::string summary_text(const SuiteCounts& counts) {
    const size_t all = counts.held + counts.failed;
    std::string text;
    if (counts.failed > 0)
        text = fmt::format("differ: {} of {} pictures", counts.failed, all);
    else
        text = all > 0 ? fmt::format("hold: all {} pictures", all) : "nothing was compared";
    if (counts.skipped > 0) text += fmt::format("; {} skipped", counts.skipped);
    if (counts.not_begun > 0) text += fmt::format("; {} cases not rendered", counts.not_begun);
    return text + "\n";
}

std::string junit_xml(const Suite& suite, const std::vector<SuiteResult>& results) {
    size_t failures = 0;
    size_t errors = 0;
    size_t skipped = 0;
    double seconds = 0;
    std::string cases;
    for (const SuiteResult& result : results) {
        errors += result.outcome == Outcome::broken;
        failures += result.failed() && result.outcome != Outcome::broken;
        skipped += result.outcome == Outcome::skipped;
        seconds += result.seconds;
        cases += junit_case(suite, result);
    }
    const std::string counts = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"",
                                           results.size(), failures, errors, skipped, seconds);
    const Json context = run_context("render-compare");
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n  <testsuite name=\"{}\" {} timestamp=\"{}\" "
        "hostname=\"{}\">\n{}  </testsuite>\n</testsuites>\n",
        counts, xml(suite.name), counts, xml(context["date"].get<std::string>()),
        xml(context["host_name"].get<std::string>()), cases);
}

Json suite_json(const Suite& suite, const std::vector<SuiteResult>& results, const std::vector<SuiteBackend>& backends,
                const SuiteCounts& counts) {
    Json context = run_context("render-compare");
    context["suite"] = suite.path;
    for (const SuiteBackend& one : backends)
        if (!one.devices.names.empty()) {
            context["devices"] = one.devices.names;
            context["driver"] = one.devices.driver;
        }
    Json cases = Json::array();
    for (const SuiteResult& result : results) cases.push_back(result_json(result));
    return {{"context", context},
            {"holds", counts.failed == 0 && counts.held > 0 && counts.not_begun == 0},
            {"parity", {{"compared", counts.held + counts.failed}, {"differing", counts.failed}}},
            {"skipped", counts.skipped},
            {"not_begun", counts.not_begun},
            {"cases", cases}};
}

}  // namespace cistula
