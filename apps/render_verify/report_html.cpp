// The HTML page: a line per case, with its outcomes on every intersector.
#include <fmt/format.h>

#include <map>

#include "apps/render_verify/report.h"
#include "base/machine.h"

namespace cistula::verify {
namespace {

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

constexpr const char* style = R"(
:root { color-scheme: light dark; --ink: #1b1f24; --paper: #fff; --line: #d6dae0; --good: #116329; --bad: #b3261e; --badpaper: #fdecea; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #d8dee6; --paper: #15181c; --line: #343a42; --good: #6fd08c; --bad: #ff8a80; --badpaper: #3a1d1b; }
}
body { font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper); margin: 2rem auto; max-width: 76rem; padding: 0 1rem; }
h1 { font-size: 1.4rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
dl { display: grid; grid-template-columns: max-content auto; gap: .2rem 1rem; } dt { opacity: .7; } dd { margin: 0; }
table { border-collapse: collapse; width: 100%; } th, td { text-align: left; padding: .3rem .6rem; border-bottom: 1px solid var(--line); vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.holds { color: var(--good); } .fails { color: var(--bad); font-weight: 600; } tr.bad { background: var(--badpaper); }
.small { opacity: .75; font-size: .88em; } .scroll { overflow-x: auto; }
)";

std::string fact(const std::string& name, const std::string& value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(value));
}

std::string row(const Outcome& outcome, bool first, size_t of_case) {
    std::string text = outcome.holds() ? "<tr>" : "<tr class=\"bad\">";
    if (first)
        text += fmt::format("<td rowspan=\"{}\"><code>{}</code><br><span class=\"small\">{}{}</span></td>", of_case,
                            escaped(outcome.info->name), outcome.info->bound.must_fail ? "broken on purpose: " : "",
                            escaped(outcome.info->exact));
    text += fmt::format("<td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>",
                        intersector_name(outcome.intersector), cistula::precision_name(outcome.precision),
                        escaped(measured_text(outcome)), escaped(bound_text(outcome)));
    const std::string why = complaint(outcome);
    text += outcome.holds() ? fmt::format("<td class=\"holds\">{}", outcome.warned > 0 ? "warns" : "holds")
                            : fmt::format("<td class=\"fails\">fails<br><span class=\"small\">{}</span>", escaped(why));
    return text + fmt::format("</td><td class=\"n\">{:.2f}</td></tr>\n", outcome.seconds);
}

}  // namespace

std::string report_html(const std::vector<Outcome>& outcomes, const VerifyOptions& options, const RunContext& context) {
    size_t failing = 0;
    std::map<std::string, size_t> of_case;
    for (const Outcome& outcome : outcomes) {
        failing += outcome.holds() ? 0 : 1;
        ++of_case[outcome.info->name];
    }
    const std::string verdict = failing == 0 ? fmt::format("All {} hold", outcomes.size())
                                             : fmt::format("{} of {} do not hold", failing, outcomes.size());
    std::string page = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width\">"
        "<title>render-verify: {}</title><style>{}</style></head><body>\n<h1>render-verify: <span "
        "class=\"{}\">{}</span></h1>\n<dl>\n",
        verdict, style, failing == 0 ? "holds" : "fails", verdict);
    page += fact("version", CISTULA_VERSION);
    page += fact("commit", build_commit());
    page += fact("processor", processor_name());
    if (!context.devices.empty()) page += fact("GPU", fmt::format("{}", fmt::join(context.devices, ", ")));
    page += fact("compiler", std::string("g++ ") + __VERSION__ + ", " + build_flags());
    page += fact("run", fmt::format("{}, {:.0f} s", options.settings.quick ? "quick" : "full", context.seconds));
    page += "</dl>\n";
    std::string group, name;
    for (const Outcome& outcome : outcomes) {
        const std::string own = outcome.info->name.substr(0, outcome.info->name.find('/'));
        if (own != group) {
            if (!group.empty()) page += "</tbody></table></div>\n";
            group = own;
            page += fmt::format(
                "<h2>{}</h2>\n<div class=\"scroll\"><table><thead><tr><th>case</th><th>on</th><th>in</th><th>worst"
                "</th><th>bound</th><th>verdict</th><th>seconds</th></tr></thead><tbody>\n",
                escaped(group));
        }
        page += row(outcome, outcome.info->name != name, of_case[outcome.info->name]);
        name = outcome.info->name;
    }
    if (!group.empty()) page += "</tbody></table></div>\n";
    return page + "</body></html>\n";
}

}  // namespace cistula::verify
