// Section 1: time against error over all settings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "html.h"
#include "pareto.h"
#include "svg_chart.h"

namespace cistula::report {
namespace {

struct Front {
    std::vector<CostPoint> points;  // one for each entry, in their order
    std::vector<size_t> front;
    std::optional<size_t> knee;
    std::optional<double> digit;
};

Front front_of(const Shown& shown) {
    Front found;
    for (const Entry* entry : shown.entries) {
        const double error = shown.rmse(*entry);
        found.points.push_back({entry->wall.median(), error > 0 ? error : 1e-300});
    }
    found.front = pareto_front(found.points);
    found.knee = knee_of(found.points, found.front);
    found.digit = time_per_digit(found.points, found.front);
    return found;
}

std::string command_of(const Shown& shown, const Entry& entry) {
    return command_line(shown.scene->file, shown.scene->width, shown.scene->height, entry.setting,
                        shown.record->text("backend")) +
           " -o " + shown.scene->name + ".exr";
}

Chart chart_of(const Shown& shown, const Front& front, int width, int height) {
    Chart chart;
    chart.width = width;
    chart.height = height;
    chart.description = fmt::format("{}: error against time, {} settings, {} of them on the Pareto front", shown.title,
                                    shown.entries.size(), front.front.size());
    chart.x = {"time of a frame, ms", true};
    chart.y = {"error (RMSE)", true};
    ChartSeries line;
    line.color = 5;
    line.dots = false;
    for (const size_t i : front.front)
        line.points.push_back({front.points[i].time, front.points[i].error, 0, 0, "", false});
    chart.series.push_back(line);
    std::map<std::tuple<bool, int, Precision>, ChartSeries> groups;
    std::map<int, int> colors;
    for (const Entry* entry : shown.entries)
        if (!entry->setting.adaptive()) colors[entry->setting.supersample] = 0;
    int next = 0;
    for (auto& [samples, color] : colors) color = std::min(next++, 4);
    for (size_t i = 0; i < shown.entries.size(); ++i) {
        const Setting& setting = shown.entries[i]->setting;
        ChartSeries& group = groups[{setting.adaptive(), setting.supersample, setting.precision}];
        const bool twice = setting.precision == Precision::double_;
        group.color = setting.adaptive() ? 6 : colors.at(setting.supersample);
        group.line = false;
        group.shape = setting.adaptive() ? DotShape::diamond : twice ? DotShape::square : DotShape::circle;
        group.label =
            (setting.adaptive() ? "target error" : fmt::format("{}×{}", setting.supersample, setting.supersample)) +
            (twice ? ", double" : "");
        const bool on_front = std::find(front.front.begin(), front.front.end(), i) != front.front.end();
        group.points.push_back({front.points[i].time, front.points[i].error, 0, 0,
                                fmt::format("{}: {}, RMSE {}", setting_text(setting), time_text(front.points[i].time),
                                            number_text(front.points[i].error)),
                                !on_front});
    }
    for (auto& [key, group] : groups) chart.series.push_back(std::move(group));
    if (front.knee) chart.marks.push_back({front.points[*front.knee].time, front.points[*front.knee].error, "knee"});
    return chart;
}

std::string front_table(const Shown& shown, const Front& front) {
    Table table(
        {"setting", ">time", ">RMSE", ">PSNR", ">relative MSE", ">largest error", ">worst pixel",
         ">pixels over 0.5/255"},
        fmt::format("The Pareto front: nothing else that was measured is both quicker and closer, by {} at least",
                    percent_text(least_gain)));
    for (const size_t i : front.front) {
        const Entry& entry = *shown.entries[i];
        const Metrics& e = entry.error;
        table.row({escaped(setting_text(entry.setting)) + (front.knee == i ? " <b class=\"tag\">knee</b>" : ""),
                   time_html(entry.wall), number_text(shown.rmse(entry)), fmt::format("{:.1f} dB", e.psnr()),
                   number_text(e.relative_mse), number_text(shown.max(entry)),
                   fmt::format("{}, {}", e.worst_x, e.worst_y), percent_text(e.over_half_code)},
                  front.knee == i ? "chosen" : "");
    }
    return table.html();
}

std::string reference_text(const Shown& shown) {
    const ReferenceRecord& reference = shown.scene->reference;
    const Remainder& left = reference.remainder;
    std::string text = fmt::format(
        "Reference: {}, whose ledger proves that its own truncation hides at most {} in the mean, {} (RMS) and {} in "
        "the worst pixel",
        setting_text(reference.setting), number_text(left.mean), number_text(left.rms), number_text(left.max));
    if (shown.tight)
        text += fmt::format(": under a sixteenth of the smallest RMSE shown ({}).", number_text(shown.smallest_error));
    else
        text += fmt::format(
            ". As that is more than a sixteenth of the smallest RMSE ({}), it is added to every RMSE and largest error "
            "here.",
            number_text(shown.smallest_error));
    return text + fmt::format(" Relative MSE is the mean of (a − b)² / (b² + {}).", relative_epsilon);
}

}  // namespace

std::string summary_html(const std::vector<Shown>& scenes) {
    std::string cards;
    for (const Shown& shown : scenes) {
        const Front front = front_of(shown);
        if (!front.knee) continue;
        const Entry& knee = *shown.entries[*front.knee];
        cards += fmt::format(
            "<a class=\"card\" href=\"#{}-pareto\"><h2>{}</h2><p class=\"big\">{}</p><p>{}</p><p>Knee: {} for an RMSE "
            "of {}</p></a>\n",
            shown.id, escaped(shown.title), front.digit ? "×" + number_text(*front.digit) : "–",
            front.digit ? "the time for one more digit" : "too few settings for a price of a digit",
            time_text(knee.wall.median()), number_text(shown.rmse(knee)));
    }
    return cards.empty() ? "" : "<div class=\"cards\">" + cards + "</div>\n";
}

std::string pareto_section(const std::vector<Shown>& scenes) {
    std::string text;
    for (const Shown& shown : scenes) {
        if (shown.entries.empty()) continue;
        const Front front = front_of(shown);
        text += fmt::format("<h3 id=\"{}-pareto\">{}</h3>\n", shown.id, escaped(shown.title));
        const Chart wide = chart_of(shown, front, 860, 440), narrow = chart_of(shown, front, 400, 400);
        std::string caption = fmt::format(
            "{}×{} pixels, {} settings; the {} on the front are joined, what they dominate is faint. Color: samples "
            "per pixel; diamonds choose their own, for a target error.",
            shown.scene->width, shown.scene->height, shown.entries.size(), front.front.size());
        if (front.digit)
            caption += fmt::format(" Along the front, one more digit of RMSE costs {} times the time.",
                                   number_text(*front.digit));
        text += figure(chart_legend(wide) + "<div class=\"wide\">" + chart_svg(wide) + "</div><div class=\"narrow\">" +
                           chart_svg(narrow) + "</div>",
                       caption);
        if (front.knee) {
            const Entry& knee = *shown.entries[*front.knee];
            text += fmt::format(
                "<p><b>The knee:</b> {}. {} a frame, RMSE {}; {} of the pixels are more than 0.5/255 off, the worst at "
                "{}, {} by {}.</p>\n",
                escaped(setting_text(knee.setting)), time_text(knee.wall.median()), number_text(shown.rmse(knee)),
                percent_text(knee.error.over_half_code), knee.error.worst_x, knee.error.worst_y,
                number_text(shown.max(knee)));
            text += command_html(command_of(shown, knee));
        }
        text += front_table(shown, front);
        text += "<p class=\"note\">" + reference_text(shown) + "</p>\n";
        if (!shown.scene->left_out.empty()) {
            text += fmt::format("<details><summary>Left out, as a frame takes too long: {}</summary><p class=\"note\">",
                                shown.scene->left_out.size());
            for (const std::string& name : shown.scene->left_out) text += escaped(name) + "<br>";
            text += "</p></details>\n";
        }
        std::string commands;
        for (const size_t i : front.front) commands += command_of(shown, *shown.entries[i]) + "\n";
        text +=
            "<details><summary>Command lines of the whole front</summary>" + command_html(commands) + "</details>\n";
    }
    return text;
}

}  // namespace cistula::report
