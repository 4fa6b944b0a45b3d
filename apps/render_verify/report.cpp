#include "apps/render_verify/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/machine.h"
#include "base/suggest.h"
#include "compare/page/page_parts.h"

namespace cistula::verify {
namespace {

using Json = nlohmann::ordered_json;

size_t widest_name(const std::vector<const Case*>& cases) {
    size_t width = 4;
    for (const Case* one : cases) width = std::max(width, one->name.size());
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

/// The measured value with its unit: "0 rays", "1.5 ulps".
std::string measured_text(const Outcome& outcome) {
    const std::string value = number_text(outcome.measured());
    return outcome.of->bound.measure == Measure::failures ? fmt::format("{} of {}", value, outcome.tally.tried) : value;
}

std::string bound_text(const Outcome& outcome) {
    return fmt::format("{}{} {}", outcome.of->bound.must_fail ? ">= " : "", number_text(outcome.limit()),
                       outcome.of->bound.unit);
}

/// The reason why an outcome fails; empty if it passes.
std::string complaint(const Outcome& outcome) {
    if (outcome.holds()) return "";
    if (!outcome.problem.empty()) return one_line(outcome.problem);
    if (outcome.must_warn() && outcome.warned == 0) return "float does not warn";
    if (outcome.tally.tried == 0) return "nothing was tried";
    if (outcome.of->is(needs_witness) && outcome.tally.witnesses == 0) return "no try met the hazard";
    if (outcome.of->bound.must_fail) return "what is broken on purpose is not caught";
    std::string text = outcome.tally.failures != 0
                           ? fmt::format("{} of {} failed", outcome.tally.failures, outcome.tally.tried)
                           : fmt::format("{} is over the bound", number_text(outcome.tally.worst));
    if (!outcome.worst_label.empty()) text += "; first: " + one_line(outcome.worst_label);
    return text;
}

const char* verdict_of(const Outcome& outcome, const char* failing) {
    return !outcome.holds() ? failing : outcome.warned > 0 ? "warns" : "holds";
}

}  // namespace

std::string table_head(const std::vector<const Case*>& cases) {
    return fmt::format("{:<{}}  {:<6}  {:<6}  {:>20}  {:>16}  {:>7}  {:<7}  {}\n", "case", widest_name(cases), "on",
                       "in", "worst", "bound", "seconds", "verdict", "what is exact");
}

std::string table_row(const Outcome& outcome, const std::vector<const Case*>& cases) {
    return fmt::format("{:<{}}  {:<6}  {:<6}  {:>20}  {:>16}  {:>7.2f}  {:<7}  {}\n", outcome.of->name,
                       widest_name(cases), intersector_name(outcome.intersector), precision_name(outcome),
                       measured_text(outcome), bound_text(outcome), outcome.seconds, verdict_of(outcome, "FAILS"),
                       outcome.of->exact);
}

std::string summary(const std::vector<Outcome>& outcomes) {
    std::string text;
    size_t failing = 0, warning = 0;
    for (const Outcome& outcome : outcomes) {
        warning += outcome.warned > 0 ? 1 : 0;
        if (outcome.holds()) continue;
        ++failing;
        text += fmt::format("{} on {} in {}: {}\n", outcome.of->name, intersector_name(outcome.intersector),
                            precision_name(outcome), complaint(outcome));
    }
    text += failing == 0 ? fmt::format("all {} hold", outcomes.size())
                         : fmt::format("{} of {} do not hold", failing, outcomes.size());
    if (warning > 0) text += fmt::format("; {} warn in float of parts too small for it", warning);
    return text + "\n";
}

std::string list_text(const std::vector<Case>& cases) {
    size_t width = 0;
    for (const Case& one : cases) width = std::max(width, one.name.size());
    std::string text;
    for (const Case& one : cases) text += fmt::format("{:<{}}  {}\n", one.name, width, one.exact);
    return text;
}

Json report_json(const std::vector<Outcome>& outcomes, const RunContext& run) {
    Json context = {{"executable", "render-verify"}, {"cistula_version", CISTULA_VERSION},
                    {"cpu", processor_name()},       {"num_cpus", std::thread::hardware_concurrency()},
                    {"compiler", __VERSION__},       {"flags", build_flags()},
                    {"commit", build_commit()},      {"quick", run.quick},
                    {"seconds", run.seconds}};
    if (!run.devices.empty()) {
        context["devices"] = run.devices;
        context["driver"] = run.driver;
        context["gpu_driver"] = gpu_driver_version();
    }
    Json cases = Json::array();
    for (const Outcome& outcome : outcomes) {
        Json one = {{"case", outcome.of->name},
                    {"intersector", intersector_name(outcome.intersector)},
                    {"precision", precision_name(outcome)},
                    {"worst", number(outcome.measured())},
                    {"bound", number(outcome.limit())},
                    {"unit", outcome.of->bound.unit},
                    {"holds", outcome.holds()},
                    {"exact", outcome.of->exact},
                    {"must_fail", outcome.of->bound.must_fail},
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

std::string report_html(const std::vector<Outcome>& outcomes, const RunContext& run) {
    const auto failing = std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& o) { return !o.holds(); });
    const std::string verdict = failing == 0 ? fmt::format("All {} hold", outcomes.size())
                                             : fmt::format("{} of {} do not hold", failing, outcomes.size());
    Table facts({"run", ""});
    facts.row({"version", CISTULA_VERSION});
    facts.row({"commit", escaped(build_commit())});
    facts.row({"processor", escaped(processor_name())});
    if (!run.devices.empty()) facts.row({"GPU", escaped(fmt::format("{}", fmt::join(run.devices, ", ")))});
    facts.row({"compiler", escaped(fmt::format("g++ {}, {}", __VERSION__, build_flags()))});
    facts.row({"run", fmt::format("{}, {:.0f} s", run.quick ? "quick" : "full", run.seconds)});
    std::string page = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width\"><title>render-verify: {0}</title><style>{1}</style></head><body>\n"
        "<header><h1>render-verify: <span class=\"{2}\">{0}</span></h1></header>\n",
        verdict, page_style, failing == 0 ? "good" : "bad");
    page += facts.html();
    for (auto first = outcomes.begin(); first != outcomes.end();) {
        const std::string group = first->of->name.substr(0, first->of->name.find('/') + 1);
        Table table({"case", "on", "in", ">worst", ">bound", "verdict", ">seconds"});
        const Case* named = nullptr;
        for (; first != outcomes.end() && first->of->name.rfind(group, 0) == 0; ++first) {
            const Case& of = *first->of;
            const char* broken = of.bound.must_fail ? "broken on purpose: " : "";
            const char* css = first->holds() ? "good" : "bad";
            table.row({named == &of ? ""
                                    : fmt::format("<code>{}</code><small>{}{}</small>", escaped(of.name), broken,
                                                  escaped(of.exact)),
                       intersector_name(first->intersector), precision_name(*first), escaped(measured_text(*first)),
                       escaped(bound_text(*first)),
                       fmt::format("<span class=\"{}\">{}</span><small>{}</small>", css, verdict_of(*first, "fails"),
                                   escaped(complaint(*first))),
                       fmt::format("{:.2f}", first->seconds)},
                      first->holds() ? "" : "bad");
            named = &of;
        }
        page += fmt::format("<section><h2>{}</h2>\n{}</section>\n", escaped(group.substr(0, group.size() - 1)),
                            table.html());
    }
    return page + "</body></html>\n";
}

}  // namespace cistula::verify
