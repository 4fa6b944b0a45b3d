#include "html_page.h"

#include <fmt/format.h>

#include "html.h"

namespace cistula::report {
namespace {

struct Section {
    const char *id, *title;
    std::string body;
    const char* missing;  // text in place of an empty section
};

std::string runs_text(const Record& record) {
    const int runs = record.context.value("repetitions", 0), warm_ups = record.context.value("warm_ups", 0);
    std::string text =
        fmt::format("medians and ranges of {} runs after {} of warm-up, in rounds of random order", runs, warm_ups);
    if (record.context.value("quick", false)) text += ", a quick run with fewer settings";
    return text;
}

}  // namespace

std::string report_page(const std::vector<Record>& records) {
    const std::vector<Shown> scenes = all_shown(records);
    const Section sections[] = {
        {"pareto", "1. Time against error", pareto_section(scenes), "No scene was measured."},
        {"knobs", "2. Each knob alone", knobs_section(scenes), "No scene was measured."},
        {"where", "3. Where the time goes", where_section(scenes), "No scene was measured."},
        {"seed", "4. Beside the seed’s algorithm", seed_section(records),
         "Not measured here; --seed-baseline shows what bench/seed_baseline recorded."},
        {"parity", "5. One image from every backend", parity_section(scenes), "Not compared."},
        {"verify", "6. Hard cases", verify_section(records),
         "Not run here; --verify shows what render-verify recorded."},
        {"machine", "7. Machine", machine_section(records), ""},
        {"scaling", "8. Scaling", scaling_section(records), "Not measured here; --scaling does."},
    };
    std::string names;
    for (const Shown& shown : scenes) names += (names.empty() ? "" : ", ") + shown.title;
    std::string where;
    for (const Record& record : records) {
        const auto devices = record.context.find("devices");
        const std::string on = devices != record.context.end() && devices->is_array()
                                   ? fmt::format("{}", fmt::join(devices->get<std::vector<std::string>>(), ", "))
                                   : record.text("cpu");
        const std::string line = on + ": " + runs_text(record);
        if (where.find(line) == where.npos) where += (where.empty() ? "" : "; ") + line;
    }
    std::string page = fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>What accuracy costs: "
        "{}</title>\n"
        "<style>{}</style>\n</head>\n<body>\n<header>\n<p class=\"brand\">Cistula</p>\n<h1>What accuracy costs in "
        "time</h1>\n<p>{}. {}.</p>\n{}</header>\n",
        escaped(names), page_style, escaped(names), escaped(where), summary_html(scenes));
    page += "<nav aria-label=\"Sections\"><ul>\n";
    for (const Section& section : sections)
        page += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id, section.title);
    page += "</ul></nav>\n<main>\n";
    for (const Section& section : sections)
        page += fmt::format(
            "<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", section.id, section.title,
            section.body.empty() ? fmt::format("<p class=\"note\">{}</p>\n", section.missing) : section.body);
    return page + "</main>\n</body>\n</html>\n";
}

}  // namespace cistula::report
