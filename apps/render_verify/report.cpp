#include "apps/render_verify/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/machine.h"
#include "base/suggest.h"

namespace cistula::verify {
namespace {

using Json = nlohmann::ordered_json;

size_t widest_name(const std::vector<const CaseEntry*>& cases) {
    size_t width = 4;
    for (const CaseEntry* entry : cases) width = std::max(width, entry->info.name.size());
    return width;
}

std::string number_text(double value) {
    return value == std::floor(value) && std::fabs(value) < 1e15 ? fmt::format("{:.0f}", value)
                                                                 : fmt::format("{:.4g}", value);
}

const char* precision_name(const Outcome& outcome) {
    return cistula::precision_name(outcome.precision);
}

/// A number as JSON, which has no infinities.
Json number(double value) {
    if (std::isfinite(value)) return value;
    return value > 0 ? "inf" : value < 0 ? "-inf" : "nan";
}

}  // namespace

std::string measured_text(const Outcome& outcome) {
    const std::string value = number_text(outcome.measured());
    return outcome.info->bound.measure == Measure::failures ? fmt::format("{} of {}", value, outcome.tally.tried)
                                                            : value;
}

std::string bound_text(const Outcome& outcome) {
    return fmt::format("{}{} {}", outcome.info->bound.must_fail ? ">= " : "", number_text(outcome.limit()),
                       outcome.info->bound.unit);
}

std::string complaint(const Outcome& outcome) {
    if (outcome.holds()) return "";
    if (!outcome.problem.empty()) return one_line(outcome.problem);
    if (outcome.must_warn() && outcome.warned == 0) return "float does not warn";
    if (outcome.tally.tried == 0) return "nothing was tried";
    if (outcome.info->needs_witness && outcome.tally.witnesses == 0) return "no try met the hazard";
    if (outcome.info->bound.must_fail) return "what is broken on purpose is not caught";
    std::string text = outcome.tally.failures != 0
                           ? fmt::format("{} of {} failed", outcome.tally.failures, outcome.tally.tried)
                           : fmt::format("{} is over the bound", number_text(outcome.tally.worst));
    if (!outcome.worst_label.empty()) text += "; first: " + one_line(outcome.worst_label);
    return text;
}

std::string table_head(const std::vector<const CaseEntry*>& cases) {
    return fmt::format("{:<{}}  {:<6}  {:<6}  {:>20}  {:>16}  {:>7}  {:<7}  {}\n", "case", widest_name(cases), "on",
                       "in", "worst", "bound", "seconds", "verdict", "what is exact");
}

std::string table_row(const Outcome& outcome, const std::vector<const CaseEntry*>& cases) {
    return fmt::format("{:<{}}  {:<6}  {:<6}  {:>20}  {:>16}  {:>7.2f}  {:<7}  {}\n", outcome.info->name,
                       widest_name(cases), intersector_name(outcome.intersector), precision_name(outcome),
                       measured_text(outcome), bound_text(outcome), outcome.seconds,
                       !outcome.holds()     ? "FAILS"
                       : outcome.warned > 0 ? "warns"
                                            : "holds",
                       outcome.info->exact);
}

std::string summary(const std::vector<Outcome>& outcomes) {
    std::string text;
    size_t failing = 0, warning = 0;
    for (const Outcome& outcome : outcomes) {
        warning += outcome.warned > 0 ? 1 : 0;
        if (outcome.holds()) continue;
        ++failing;
        text += fmt::format("{} on {} in {}: {}\n", outcome.info->name, intersector_name(outcome.intersector),
                            precision_name(outcome), complaint(outcome));
    }
    text += failing == 0 ? fmt::format("all {} hold", outcomes.size())
                         : fmt::format("{} of {} do not hold", failing, outcomes.size());
    if (warning > 0) text += fmt::format("; {} warn in float of parts too small for it", warning);
    return text + "\n";
}

std::string list_text(const std::vector<CaseEntry>& cases) {
    size_t width = 0;
    for (const CaseEntry& entry : cases) width = std::max(width, entry.info.name.size());
    std::string text;
    for (const CaseEntry& entry : cases) text += fmt::format("{:<{}}  {}\n", entry.info.name, width, entry.info.exact);
    return text;
}

Json report_json(const std::vector<Outcome>& outcomes, const VerifyOptions& options, const RunContext& run) {
    Json context = {{"executable", "render-verify"}, {"cistula_version", CISTULA_VERSION},
                    {"cpu", processor_name()},       {"num_cpus", std::thread::hardware_concurrency()},
                    {"compiler", __VERSION__},       {"flags", build_flags()},
                    {"commit", build_commit()},      {"quick", options.settings.quick},
                    {"seconds", run.seconds}};
    if (!run.devices.empty()) {
        context["devices"] = run.devices;
        context["driver"] = run.driver;
        context["gpu_driver"] = gpu_driver_version();
    }
    Json cases = Json::array();
    for (const Outcome& outcome : outcomes) {
        Json one = {{"case", outcome.info->name},
                    {"intersector", intersector_name(outcome.intersector)},
                    {"precision", precision_name(outcome)},
                    {"worst", number(outcome.measured())},
                    {"bound", number(outcome.limit())},
                    {"unit", outcome.info->bound.unit},
                    {"holds", outcome.holds()},
                    {"exact", outcome.info->exact},
                    {"must_fail", outcome.info->bound.must_fail},
                    {"tried", outcome.tally.tried},
                    {"failures", outcome.tally.failures},
                    {"witnesses", outcome.tally.witnesses},
                    {"seconds", outcome.seconds}};
        if (!outcome.worst_label.empty()) one["worst_at"] = outcome.worst_label;
        if (outcome.warned > 0) one["scenes_warned_of"] = outcome.warned;
        if (!outcome.holds()) one["complaint"] = complaint(outcome);
        cases.push_back(std::move(one));
    }
    return {{"context", context}, {"cases", cases}};
}

}  // namespace cistula::verify
