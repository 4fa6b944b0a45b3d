// Sections 4 (the seed's algorithm), 5 (parity), 6 (hard cases), 7 (machine), and scaling.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "html.h"
#include "svg_chart.h"

namespace cistula::report {
namespace {

std::string list_text(const Json& list) {
    return list.is_array() ? fmt::format("{}", fmt::join(list.get<std::vector<std::string>>(), ", ")) : "";
}

/// A number from render-verify's record, or the text for one that JSON lacks.
std::string loose_number(const Json& value) {
    return value.is_number() ? number_text(value.get<double>()) : value.is_string() ? value.get<std::string>() : "–";
}

std::string seed_table(const SeedTable& table) {
    std::map<int, std::map<int, const SeedRow*>> by_depth;
    std::set<int> grids;
    for (const SeedRow& row : table.seed) by_depth[row.depth][row.grid] = &row, grids.insert(row.grid);
    std::vector<std::string> heads = {">depth"};
    for (const int grid : grids)
        heads.push_back(grid == 0 ? ">seed, a loop on one core" : fmt::format(">seed, {}×{} blocks", grid, grid));
    heads.insert(heads.end(), {">ours, float", ">ours, double", ">times quicker, float", ">double"});
    Table rows(heads,
               fmt::format("{}, {}×{} pixels, one sample, no cutoff", escaped(table.scene), table.width, table.height));
    for (const auto& [depth, row] : by_depth) {
        std::vector<std::string> cells = {std::to_string(depth)};
        double best = 0;
        for (const int grid : grids) {
            const auto found = row.find(grid);
            cells.push_back(found == row.end() ? "–" : time_html(found->second->time));
            if (found != row.end()) {
                const double time = found->second->time.median();
                best = best == 0 ? time : std::min(best, time);
            }
        }
        std::string times[2] = {"–", "–"}, ratios[2] = {"–", "–"};
        for (const OwnRow& own : table.ours) {
            const size_t at = own.precision == "double" ? 1 : 0;
            if (own.depth != depth) continue;
            times[at] = time_html(own.time);
            if (table.same_machine && own.time.median() > 0)
                ratios[at] = fmt::format("{:.1f}", best / own.time.median());
        }
        cells.insert(cells.end(), {times[0], times[1], ratios[0], ratios[1]});
        rows.row(cells);
    }
    const std::string where = text_of(table.context, table.context.contains("gpu") ? "gpu" : "cpu");
    std::string text =
        rows.html() +
        fmt::format("<p class=\"note\">The seed's algorithm ran on {}, in double precision; ", escaped(where));
    if (table.same_machine)
        text +=
            "ours on the same machine. Speed-ups are against its best grid; kernel times where there is a GPU.</p>\n";
    else
        text += "these are figures of another machine than ours, so no speed-up is given.</p>\n";
    return text;
}

std::string verdict_table(const Json& verify) {
    struct Case {
        std::string exact, worst, bound;
        size_t held = 0, run = 0;
        bool must_fail = false;
        std::vector<std::string> fails;
    };
    std::vector<std::string> order;
    std::map<std::string, Case> cases;
    size_t held = 0, run = 0;
    for (const Json& one : verify.at("cases")) {
        const std::string name = one.at("case");
        if (!cases.count(name)) order.push_back(name);
        Case& c = cases[name];
        const bool holds = one.at("holds");
        c.exact = one.at("exact");
        c.must_fail = one.value("must_fail", false);
        ++c.run, ++run;
        c.held += holds, held += holds;
        if (!holds)
            c.fails.push_back(fmt::format("{}, {}: {}", one.at("intersector").get<std::string>(),
                                          one.at("precision").get<std::string>(), one.value("complaint", "")));
        if (c.worst.empty() || !holds) {
            c.worst = loose_number(one.at("worst"));
            c.bound = loose_number(one.at("bound")) + " " + one.at("unit").get<std::string>();
        }
    }
    std::string text = fmt::format(
        "<p><b class=\"{}\">{} of {} hold</b>: {} cases, each on every intersector in both precisions.</p>\n",
        held == run ? "good" : "bad", held, run, order.size());
    const auto table_of = [&](bool failing, const std::string& group) {
        Table table({"case", ">holds", ">worst", ">bound", "what is exact"}, group);
        for (const std::string& name : order) {
            const Case& c = cases[name];
            if ((c.held < c.run) != failing) continue;
            if (!failing && name.substr(0, name.find('/')) != group) continue;
            std::string exact = escaped((c.must_fail ? "broken on purpose, and caught: " : "") + c.exact);
            for (const std::string& fail : c.fails) exact += "<small>" + escaped(fail) + "</small>";
            table.row({"<code>" + escaped(name) + "</code>", fmt::format("{}/{}", c.held, c.run), escaped(c.worst),
                       escaped((c.must_fail ? "≥ " : "") + c.bound), exact},
                      failing ? "bad" : "");
        }
        return table.empty() ? std::string() : table.html();
    };
    const std::string failing = table_of(true, "Do not hold");
    text += failing;
    std::vector<std::string> groups;
    for (const std::string& name : order) {
        const std::string group = name.substr(0, name.find('/'));
        if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
    }
    for (const std::string& group : groups) {
        const std::string table = table_of(false, group);
        if (!table.empty())
            text += fmt::format("<details><summary>{}: what holds</summary>{}</details>\n", escaped(group), table);
    }
    const Json& context = verify.at("context");
    const auto devices = context.find("devices");
    text += fmt::format("<p class=\"note\">render-verify{} on {}{}, commit {}.</p>\n",
                        context.value("quick", false) ? " --quick" : "", escaped(text_of(context, "cpu")),
                        devices == context.end() ? "" : " and " + escaped(list_text(*devices)),
                        escaped(text_of(context, "commit")));
    return text;
}

}  // namespace

std::string seed_section(const std::vector<Record>& records) {
    std::string text;
    for (const Record& record : records)
        if (record.seed) text += seed_table(*record.seed);
    return text;
}

std::string parity_section(const std::vector<Shown>& scenes) {
    std::string text;
    for (const Shown& shown : scenes) {
        const SceneRecord& scene = *shown.scene;
        if (scene.parity.empty()) continue;
        text += fmt::format("<h3 id=\"{}-parity\">{}</h3>\n", shown.id, escaped(shown.title));
        Table table({"renderers", "precision", ">integers compared", ">differing"},
                    fmt::format("{}×{} pixels, depth {}", scene.first_image.width, scene.first_image.height,
                                scene.parity_depth));
        for (const ParityCase& one : scene.parity)
            table.row(
                {escaped(one.first + " and " + one.second), one.precision, count_text(one.compared),
                 fmt::format("<b class=\"{}\">{}</b>", one.differing == 0 ? "good" : "bad", count_text(one.differing))},
                one.differing == 0 ? "" : "bad");
        const std::string pictures = fmt::format(
            "<div class=\"flip\" tabindex=\"0\">{}<span class=\"over\">{}</span><span class=\"badge "
            "one\">{}</span><span class=\"badge two\">{}</span></div>",
            image_tag(scene.first_image, shown.title + " by " + scene.first_renderer),
            image_tag(scene.second_image, shown.title + " by " + scene.second_renderer), escaped(scene.first_renderer),
            escaped(scene.second_renderer));
        text += "<div class=\"pair\">" +
                figure(pictures, fmt::format("Rendered by {}; hover, or tap, to see {}.", escaped(scene.first_renderer),
                                             escaped(scene.second_renderer))) +
                "<div>" + table.html() + "</div></div>\n";
    }
    return text;
}

std::string verify_section(const std::vector<Record>& records) {
    std::string text;
    for (const Record& record : records)
        if (record.verify) text += verdict_table(*record.verify);
    return text;
}

std::string scaling_section(const std::vector<Record>& records) {
    std::string text;
    for (const Record& record : records) {
        for (const ScalingSeries& one : record.scaling) {
            if (one.points.empty()) continue;
            Chart chart;
            chart.x = {one.name, one.name != "GPUs"};
            chart.y = {"time of a frame, ms", true};
            chart.description = "time against " + one.name;
            ChartSeries series;
            series.color = 0;
            for (const ScalingPoint& point : one.points)
                series.points.push_back({point.value, point.time.median(), point.time.least(), point.time.most(),
                                         fmt::format("{} {}: {}, {} rays", number_text(point.value), one.name,
                                                     time_text(point.time.median()), count_text(point.rays)),
                                         false});
            chart.series.push_back(series);
            text +=
                figure(chart_svg(chart), "<b>Time against " + escaped(one.name) + "</b>: " + escaped(one.what) + ".");
        }
    }
    return text.empty() ? "" : "<div class=\"pair\">" + text + "</div>\n";
}

std::string machine_section(const std::vector<Record>& records) {
    static const std::pair<const char*, const char*> facts[] = {{"cpu", "Processor"},
                                                                {"num_cpus", "Hardware threads"},
                                                                {"threads", "Threads used"},
                                                                {"backend", "Backend"},
                                                                {"devices", "GPU"},
                                                                {"gpu_driver", "Driver"},
                                                                {"driver", "CUDA of the driver"},
                                                                {"compiler", "Compiler"},
                                                                {"cuda_compiler", "CUDA compiler"},
                                                                {"cuda_flags", "CUDA flags"},
                                                                {"flags", "Flags"},
                                                                {"cistula_version", "Version"},
                                                                {"commit", "Commit"},
                                                                {"date", "Date"},
                                                                {"repetitions", "Timed runs"},
                                                                {"warm_ups", "Runs before them"},
                                                                {"limit_seconds", "Limit of a frame, s"}};
    std::string text;
    for (const Record& record : records) {
        text += "<dl>";
        for (const auto& [key, words] : facts) {
            std::string value = text_of(record.context, key);
            const auto list = record.context.find(key);
            if (list != record.context.end() && list->is_array()) value = list_text(*list);
            if (!value.empty()) text += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", words, escaped(value));
        }
        text += "</dl>\n";
        for (const SceneRecord& scene : record.scenes)
            text += fmt::format("<p class=\"note\">{}: {}, hash <code>{}</code></p>\n", escaped(scene.name),
                                escaped(scene.file), escaped(scene.hash));
    }
    return text;
}

}  // namespace cistula::report
