// Target errors: their cost, their sample counts, and whether they are met.
#include <fmt/format.h>

#include "html.h"
#include "svg_chart.h"
#include "target_table.h"

namespace cistula::report {
namespace {

std::string samples_text(double samples) {
    return fmt::format("{:.3g}", samples);
}

/// A chart without series. `what` is for the text alternative, `axis` labels the y axis.
Chart chart_against_target(const Shown& shown, const std::string& what, const std::string& axis) {
    Chart chart;
    chart.description = shown.title + ": " + what + " against target error";
    chart.x = {"target error", true};
    chart.y = {axis, true};
    return chart;
}

/// Chart of largest error, 99.9th percentile and RMSE, with the line where the error equals the target.
Chart error_chart(const Shown& shown, const TargetTable& table) {
    Chart chart = chart_against_target(shown, "error", "error");
    ChartSeries rmse, most, largest, target;
    rmse.label = "RMSE";
    most.label = "99.9 % of the pixels";
    most.color = 2;
    largest.label = "largest";
    largest.color = 5;
    target.label = "error = target";
    target.color = 6;
    target.dots = false;
    for (const TargetRow& row : table.rows) {
        const Entry& entry = *row.entry;
        const double x = entry.setting.target_error;
        const auto add = [&](ChartSeries& series, double y, const char* what) {
            series.points.push_back(
                {x, y, 0, 0, fmt::format("target {}: {} {}", number_text(x), what, number_text(y)), false});
        };
        add(rmse, shown.rmse(entry), "RMSE");
        add(most, shown.p999(entry), "99.9 % of the pixels within");
        add(largest, shown.max(entry), "largest error");
        target.points.push_back({x, x, 0, 0, "", false});
    }
    chart.series = {rmse, most, largest, target};
    return chart;
}

Chart samples_chart(const Shown& shown, const TargetTable& table) {
    Chart chart = chart_against_target(shown, "samples per pixel", "samples per pixel");
    ChartSeries samples;
    samples.color = 3;
    for (const TargetRow& row : table.rows) {
        const double x = row.entry->setting.target_error, y = row.entry->samples;
        samples.points.push_back(
            {x, y, 0, 0, fmt::format("target {}: {} samples per pixel", number_text(x), samples_text(y)), false});
    }
    chart.series = {samples};
    return chart;
}

Chart time_chart(const Shown& shown, const TargetTable& table) {
    Chart chart = chart_against_target(shown, "time", "time of a frame, ms");
    ChartSeries time;
    time.color = 1;
    for (const TargetRow& row : table.rows) {
        const Timing& wall = row.entry->wall;
        time.points.push_back({row.entry->setting.target_error, wall.median(), wall.least(), wall.most(),
                               setting_text(row.entry->setting) + ": " + time_text(wall.median()), false});
    }
    chart.series = {time};
    return chart;
}

std::vector<TargetRow> all_rows(const TargetTable& table) {
    std::vector<TargetRow> all = table.rows;
    all.insert(all.end(), table.in_double.begin(), table.in_double.end());
    return all;
}

std::string errors_html(const Shown& shown, const TargetTable& table) {
    Table rows({">target", "precision", ">RMSE", ">99.9 % within", ">largest error", ">worst pixel", ">over the target",
                ">say they missed", ">samples", ">time"},
               "What targets come to: pixels over the target, pixels that said so themselves, samples per pixel");
    for (const TargetRow& row : all_rows(table)) {
        const Entry& entry = *row.entry;
        rows.row({number_text(entry.setting.target_error), precision_name(entry.setting.precision),
                  number_text(shown.rmse(entry)), number_text(shown.p999(entry)), number_text(shown.max(entry)),
                  fmt::format("{}, {}", entry.error.worst_x, entry.error.worst_y), percent_text(entry.target->over),
                  count_text(entry.target->missed), samples_text(entry.samples), time_html(entry.wall)});
    }
    return rows.html();
}

std::string fixed_html(const Shown& shown, const TargetTable& table) {
    Table rows({">target", "precision", ">99.9 % within", ">time", "quickest fixed setting as close", ">99.9 % within",
                ">time", ">target / fixed"},
               "Beside the quickest fixed setting of the sweep that keeps 99.9 % of the pixels as close");
    for (const TargetRow& row : all_rows(table)) {
        std::vector<std::string> cells = {number_text(row.entry->setting.target_error),
                                          precision_name(row.entry->setting.precision),
                                          number_text(shown.p999(*row.entry)), time_html(row.entry->wall)};
        if (row.fixed)
            cells.insert(cells.end(), {escaped(setting_text(row.fixed->setting)), number_text(shown.p999(*row.fixed)),
                                       time_html(row.fixed->wall), fmt::format("{:.2f}", row.ratio())});
        else
            cells.insert(cells.end(), {"none", "–", "–", "–"});
        rows.row(cells);
    }
    return rows.html();
}

std::string uniform_html(const Shown& shown, const UniformRow& row) {
    std::string text = fmt::format("<p><b>Beside a uniform grid:</b> {} has an RMSE of {} with {} samples per pixel. ",
                                   escaped(setting_text(row.uniform->setting)), number_text(shown.rmse(*row.uniform)),
                                   samples_text(row.uniform->samples));
    if (row.closer == nullptr) return text + "No target that was measured comes as close.</p>\n";
    const auto target = [](const Entry* entry) { return number_text(entry->setting.target_error); };
    text += fmt::format("Adaptive sampling takes {} for that, {:.2f} times fewer: ", samples_text(row.samples),
                        row.uniform->samples / row.samples);
    if (row.farther)
        text += fmt::format("between the targets {} and {}, in log-log.", target(row.farther), target(row.closer));
    else
        text += fmt::format("at the target {}, the largest that was measured, which is closer already.",
                            target(row.closer));
    return text + "</p>\n";
}

}  // namespace

std::string target_html(const Shown& shown) {
    const TargetTable table = target_table(shown.entries);
    if (table.rows.empty()) return "";
    const Chart errors = error_chart(shown, table);
    const std::string caption = "<b>Target error.</b> ";
    std::string text = "<div class=\"pair\">";
    text += figure(chart_legend(errors) + chart_svg(errors),
                   caption +
                       "Error against the reference. A target speaks of every pixel: of truncation, a quarter of "
                       "it, that is proven; of sampling it is not.");
    text += figure(chart_svg(samples_chart(shown, table)), caption + "Samples that a pixel took, in the mean.");
    text += figure(chart_svg(time_chart(shown, table)), caption + "Time; bars are the range of the runs.");
    text += "</div>\n" + errors_html(shown, table) + fixed_html(shown, table);
    if (table.uniform) text += uniform_html(shown, *table.uniform);
    return text;
}

}  // namespace cistula::report
