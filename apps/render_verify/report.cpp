#include "apps/render_verify/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/machine.h"
#include "compare/page/page_parts.h"

namespace cistula::verify {
namespace {

using Json = nlohmann::ordered_json;

/// A number as JSON, which has no infinities.
Json number(double value) {
    if (std::isfinite(value)) return value;
    return value > 0 ? "inf" : value < 0 ? "-inf" : "nan";
}

/// The measured value with its unit: "0 rays", "1.5 ulps".
std::string measured_text(const Row& row) {
    const std::string value = number_text(row.measured);
    return row.counts ? fmt::format("{} of {}", value, row.tried) : value;
}

std::string bound_text(const Row& row) {
    return fmt::format("{}{} {}", row.must_fail ? ">= " : "", number_text(row.bound), row.unit);
}

const char* verdict_of(const Row& row, const char* failing) {
    return !row.holds() ? failing : row.warned > 0 ? "warns" : "holds";
}

}  // namespace

std::string table_head(size_t width) {
    return fmt::format("{:<{}}  {:<6}  {:<6}  {:>20}  {:>16}  {:>7}  {:<7}  {}\n", "case", width, "on", "in", "worst",
                       "bound", "seconds", "verdict", "what is exact");
}

std::string table_row(const Row& row, size_t width) {
    return fmt::format("{:<{}}  {:<6}  {:<6}  {:>20}  {:>16}  {:>7.2f}  {:<7}  {}\n", row.name, width,
                       intersector_name(row.intersector), precision_name(row.precision), measured_text(row),
                       bound_text(row), row.seconds, verdict_of(row, "FAILS"), row.exact);
}

std::string summary(const std::vector<Row>& rows) {
    std::string text;
    size_t failing = 0;
    size_t warning = 0;
    for (const Row& row : rows) {
        warning += row.warned > 0 ? 1 : 0;
        if (row.holds()) continue;
        ++failing;
        text += fmt::format("{} on {} in {}: {}\n", row.name, intersector_name(row.intersector),
                            precision_name(row.precision), row.complaint);
    }
    text += failing == 0 ? fmt::format("all {} hold", rows.size())
                         : fmt::format("{} of {} do not hold", failing, rows.size());
    if (warning > 0) text += fmt::format("; {} warn in float of parts too small for it", warning);
    return text + "\n";
}

Json report_json(const std::vector<Row>& rows, const RunContext& run) {
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
    for (const Row& row : rows) {
        Json one = {{"case", row.name},
                    {"intersector", intersector_name(row.intersector)},
                    {"precision", precision_name(row.precision)},
                    {"worst", number(row.measured)},
                    {"bound", number(row.bound)},
                    {"unit", row.unit},
                    {"holds", row.holds()},
                    {"exact", row.exact},
                    {"must_fail", row.must_fail},
                    {"tried", row.tried},
                    {"failures", row.failures},
                    {"witnesses", row.witnesses},
                    {"seconds", row.seconds}};
        if (!row.worst_at.empty()) one["worst_at"] = row.worst_at;
        if (row.warned > 0) one["scenes_warned_of"] = row.warned;
        if (!row.holds()) one["complaint"] = row.complaint;
        cases.push_back(std::move(one));
    }
    return {{"context", context}, {"cases", cases}};
}

std::string report_html(const std::vector<Row>& rows, const RunContext& run) {
    const auto failing = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.holds(); });
    const std::string verdict = failing == 0 ? fmt::format("All {} hold", rows.size())
                                             : fmt::format("{} of {} do not hold", failing, rows.size());
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
    for (auto row = rows.begin(); row != rows.end();) {
        const std::string group = row->group;
        Table table({"case", "on", "in", ">worst", ">bound", "verdict", ">seconds"});
        std::string named;
        for (; row != rows.end() && row->group == group; ++row) {
            const std::string verdict_html =
                fmt::format("<span class=\"{}\">{}</span><small>{}</small>", row->holds() ? "good" : "bad",
                            verdict_of(*row, "fails"), escaped(row->complaint));
            table.row(
                {named == row->name ? ""
                                    : fmt::format("<code>{}</code><small>{}{}</small>", escaped(row->name),
                                                  row->must_fail ? "broken on purpose: " : "", escaped(row->exact)),
                 intersector_name(row->intersector), precision_name(row->precision), escaped(measured_text(*row)),
                 escaped(bound_text(*row)), verdict_html, fmt::format("{:.2f}", row->seconds)},
                row->holds() ? "" : "bad");
            named = row->name;
        }
        page += fmt::format("<section><h2>{}</h2>\n{}</section>\n", escaped(group), table.html());
    }
    return page + "</body></html>\n";
}

}  // namespace cistula::verify
