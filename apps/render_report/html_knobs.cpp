// Section 2: each knob alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "html.h"
#include "svg_chart.h"
#include "sweep_plan.h"

namespace cistula::report {
namespace {

struct Alone {
    std::vector<const Entry*> entries;  // by ascending value
    size_t unresolved = 0;              // entries whose error is too close to the error of its reference
    size_t exact = 0;                   // entries without any error
};

/// Whether the reference is accurate enough for this error: it must be sixteen times closer.
bool resolves(const Shown& shown, const std::string& knob, const Metrics& error) {
    if (knob != "depth" && knob != "cutoff") return true;  // other knobs' references differ in the knob only
    for (const ReferenceRecord& one : shown.scene->yardsticks)
        if (one.setting.depth == deepest && one.setting.cutoff == knob_reference_cutoff)
            return error.rmse >= 16 * one.remainder.rms;
    return true;
}

Alone alone_of(const Shown& shown, const Knob& knob) {
    Alone found;
    for (const Entry* entry : shown.entries) {
        const auto metrics = entry->alone.find(knob.name);
        if (metrics == entry->alone.end()) continue;
        if (metrics->second.rmse == 0)
            ++found.exact;
        else if (!resolves(shown, knob.name, metrics->second))
            ++found.unresolved;
        found.entries.push_back(entry);
    }
    std::sort(found.entries.begin(), found.entries.end(),
              [&](const Entry* a, const Entry* b) { return knob.value(a->setting) < knob.value(b->setting); });
    return found;
}

std::string slope_number(double value) {
    return (value < 0 ? "−" : "") + fmt::format("{:.3f}", std::abs(value));
}

/// A least-squares line ln(error) = a + b x.
struct Line {
    double a = 0, b = 0;
    size_t points = 0;
};
Line fit(const std::vector<ChartPoint>& points) {
    Line line;
    double x = 0, y = 0, xx = 0, xy = 0;
    line.points = points.size();
    for (const ChartPoint& p : points) x += p.x, y += std::log(p.y);
    const double n = static_cast<double>(points.size());
    x /= n, y /= n;
    for (const ChartPoint& p : points) xx += (p.x - x) * (p.x - x), xy += (p.x - x) * (std::log(p.y) - y);
    line.b = xx > 0 ? xy / xx : 0;
    line.a = y - line.b * x;
    return line;
}

/// A dashed guide line that falls by `share` per level, from the middle of the points on.
ChartSeries guide(const std::vector<ChartPoint>& points, const Share& share, int color) {
    ChartSeries series;
    series.label = fmt::format("{} {} a level, ln = {}", share.what == "reflection" ? "kr" : "kt",
                               number_text(share.value), slope_number(std::log(share.value)));
    series.color = color;
    series.dots = false;
    series.dashed = true;
    const ChartPoint& middle = points[points.size() / 2];
    for (const double x : {points.front().x, points.back().x}) {
        // Both ends stay inside the drawing: the line is cut where the data end.
        double y = middle.y * std::pow(share.value, x - middle.x), at = x;
        const double low = points.back().y, high = points.front().y;
        if (y > high || y < low) {
            y = std::clamp(y, std::min(low, high), std::max(low, high));
            at = middle.x + std::log(y / middle.y) / std::log(share.value);
        }
        series.points.push_back({at, y, 0, 0, "", false});
    }
    return series;
}

std::string slope_text(const Shown& shown, const Line& line) {
    const Share &mirror = shown.scene->mirror, &strongest = shown.scene->strongest;
    if (line.points < 3) return "";
    std::string text = fmt::format(
        " From depth 4 on, the error falls by a factor of {} a level: slope {} of its "
        "logarithm.",
        number_text(std::exp(-line.b)), slope_number(line.b));
    if (mirror.value > 0)
        text += fmt::format(" A path between mirrors ({}, kr {}) loses ln {} = {} a level.", escaped(mirror.material),
                            number_text(mirror.value), number_text(mirror.value), slope_number(std::log(mirror.value)));
    if (strongest.what == "transmission" && strongest.value > mirror.value)
        text += fmt::format(" Here more light goes through ({}, kt {}): ln {} = {}.", escaped(strongest.material),
                            number_text(strongest.value), number_text(strongest.value),
                            slope_number(std::log(strongest.value)));
    return text;
}

std::string pair_of_charts(const Shown& shown, const Knob& knob, const Alone& alone) {
    Chart errors, times;
    errors.x = times.x = {knob.axis, knob.log_axis};
    errors.y = {"error", true};
    times.y = {"time of a frame, ms", true};
    errors.description = fmt::format("{}: error against {}", shown.title, knob.axis);
    times.description = fmt::format("{}: time against {}", shown.title, knob.axis);
    ChartSeries rmse, largest, time;
    rmse.label = "RMSE";
    largest.label = "largest";
    largest.color = 5;
    time.color = 1;
    for (const Entry* entry : alone.entries) {
        const double x = knob.value(entry->setting);
        const Metrics& error = entry->alone.at(knob.name);
        if (error.rmse > 0 && resolves(shown, knob.name, error)) {
            rmse.points.push_back(
                {x, error.rmse, 0, 0, setting_text(entry->setting) + ": RMSE " + number_text(error.rmse), false});
            largest.points.push_back(
                {x, error.max, 0, 0, setting_text(entry->setting) + ": largest error " + number_text(error.max), true});
        }
        time.points.push_back({x, entry->wall.median(), entry->wall.least(), entry->wall.most(),
                               setting_text(entry->setting) + ": " + time_text(entry->wall.median()), false});
    }
    errors.series = {rmse, largest};
    times.series = {time};
    std::string note;
    if (knob.name == "depth" && rmse.points.size() >= 3) {
        std::vector<ChartPoint> tail;
        for (const ChartPoint& p : rmse.points)
            if (p.x >= 4) tail.push_back(p);
        note = slope_text(shown, fit(tail.empty() ? rmse.points : tail));
        const Share &mirror = shown.scene->mirror, &strongest = shown.scene->strongest;
        if (mirror.value > 0 && mirror.value < 1) errors.series.push_back(guide(rmse.points, mirror, 2));
        if (strongest.value > mirror.value && strongest.value < 1)
            errors.series.push_back(guide(rmse.points, strongest, 3));
    }
    if (alone.unresolved > 0)
        note += fmt::format(
            " {} settings are so close that the reference of this knob cannot tell their error; they are "
            "not drawn.",
            alone.unresolved);
    if (alone.exact > 0) note += fmt::format(" {} have no error at all.", alone.exact);
    const std::string caption = "<b>" + escaped(knob.title) + ".</b> ";
    return "<div class=\"pair\">" + figure(chart_legend(errors) + chart_svg(errors), caption + "Error." + note) +
           figure(chart_svg(times), caption + "Time; bars are the range of the runs.") + "</div>\n";
}

/// A knob with two positions: every entry beside the frame with the other position, which has no error of this knob.
struct Switch {
    std::string caption, error, here, there;  // headings of the error and both times
    void (*turn)(Setting&);
};

std::string switch_table(const Shown& shown, const Knob& knob, const Alone& alone, const Switch& words) {
    Table table({">depth", ">" + words.error, ">largest", ">worst pixel", ">pixels over 0.5/255", ">" + words.here,
                 ">" + words.there, fmt::format(">{} / {}", words.there, words.here)},
                words.caption);
    for (const Entry* here : alone.entries) {
        const Metrics& error = here->alone.at(knob.name);
        Setting setting = here->setting;
        words.turn(setting);
        for (const Entry* there : shown.entries) {
            if (!(there->setting == setting)) continue;
            table.row({std::to_string(setting.depth), number_text(error.rmse), number_text(error.max),
                       fmt::format("{}, {}", error.worst_x, error.worst_y), percent_text(error.over_half_code),
                       time_html(here->wall), time_html(there->wall),
                       fmt::format("{:.2f}", there->wall.median() / here->wall.median())});
        }
    }
    return table.empty() ? "" : table.html();
}

std::string knob_html(const Shown& shown, const Knob& knob, const Alone& alone) {
    if (knob.name == "precision")
        return switch_table(shown, knob, alone,
                            {"Precision: float against double, one sample, and what double costs", "RMSE of float",
                             "float", "double", [](Setting& setting) { setting.precision = Precision::double_; }});
    if (knob.name == "target") return target_html(shown);
    return pair_of_charts(shown, knob, alone);
}

}  // namespace

std::string knobs_section(const std::vector<Shown>& scenes) {
    std::string text;
    for (const Shown& shown : scenes) {
        std::string parts;
        for (const Knob& knob : knobs()) {
            const Alone alone = alone_of(shown, knob);
            if (alone.entries.empty()) continue;
            parts += knob_html(shown, knob, alone);
        }
        if (parts.empty()) continue;
        text += fmt::format("<h3 id=\"{}-knobs\">{}</h3>\n", shown.id, escaped(shown.title));
        text += fmt::format(
            "<p>The others stay at {}; only the cutoff is turned at depth {}, and "
            "a target error chooses samples and depth by itself.</p>\n",
            setting_text(shown.scene->base), deepest);
        text += parts;
    }
    return text.empty()
               ? ""
               : "<p>Each knob alone is measured against the same frame without that knob's error: depth and cutoff "
                 "against whole trees of one sample, samples against the full 16×16 lattice, float against "
                 "double; a target error, which is about all of them, against the reference.</p>\n" +
                     text;
}

}  // namespace cistula::report
