#include "svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "html.h"

namespace cistula::report {
namespace {

constexpr double left = 72, right = 14, top = 12, bottom = 52;

/// An axis' mapping from values to units of the drawing.
class Scale {
  public:
    Scale(bool log, double from, double to) : log_(log), from_(from), to_(to) {}

    void take(double value) {
        if (!drawable(value)) return;
        low_ = any_ ? std::min(low_, value) : value;
        high_ = any_ ? std::max(high_, value) : value;
        any_ = true;
    }
    /// Adds a margin around the values taken.
    void add_margins() {
        if (!any_) low_ = 1, high_ = 10;
        if (log_) {
            const double room = std::max(0.04 * std::log(high_ / low_), 0.12);
            low_ *= std::exp(-room), high_ *= std::exp(room);
        } else {
            low_ = std::min(low_, 0.0);
            high_ += high_ > low_ ? 0.04 * (high_ - low_) : 1;
        }
    }
    bool drawable(double value) const { return std::isfinite(value) && (!log_ || value > 0); }
    bool inside(double value) const { return drawable(value) && value >= low_ && value <= high_; }
    double operator()(double value) const {
        const double at = log_ ? std::log(value / low_) / std::log(high_ / low_) : (value - low_) / (high_ - low_);
        return from_ + at * (to_ - from_);
    }
    std::vector<double> marks() const { return ticks(low_, high_, log_); }
    double clamped(double value) const { return std::clamp(value, low_, high_); }

  private:
    bool log_, any_ = false;
    double from_, to_, low_ = 0, high_ = 0;
};

std::string tip_of(const std::string& text) {
    return text.empty() ? "" : "<title>" + escaped(text) + "</title>";
}

std::string axis_labels(double width, double height, const std::string& x, const std::string& y) {
    return fmt::format(
        "<text class=\"axis\" x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>"
        "<text class=\"axis\" transform=\"translate(15 {:.0f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
        (left + width - right) / 2, height - 8, escaped(x), (top + height - bottom) / 2, escaped(y));
}

std::string x_tick(double at, double height, const std::string& text) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", at, height - bottom + 19,
                       escaped(text));
}

std::string y_tick(double at, double width, const std::string& text) {
    return fmt::format(
        "<path class=\"grid\" d=\"M{} {:.1f}H{}\"/><text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", left, at,
        width - right, left - 7, at + 4.5, escaped(text));
}

std::string open_svg(int width, int height, const std::string& description) {
    return fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", width, height,
                       escaped(description));
}

const char* key_shape(DotShape shape) {
    return shape == DotShape::square ? " square" : shape == DotShape::diamond ? " diamond" : "";
}

std::string dot(const ChartSeries& series, const ChartPoint& point, double x, double y) {
    const char* faint = point.faint ? " faint" : "";
    if (series.shape == DotShape::diamond)
        return fmt::format("<path class=\"dot s{}{}\" d=\"M{:.1f} {:.1f}l6 6l-6 6l-6 -6z\">{}</path>", series.color,
                           faint, x, y - 6, tip_of(point.tip));
    if (series.shape == DotShape::square)
        return fmt::format("<rect class=\"dot s{}{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\">{}</rect>",
                           series.color, faint, x - 4, y - 4, tip_of(point.tip));
    return fmt::format("<circle class=\"dot s{}{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.4\">{}</circle>", series.color,
                       faint, x, y, tip_of(point.tip));
}

}  // namespace

std::string tick_text(double value) {
    if (value > 0 && (value < 0.9e-2 || value >= 1e4)) return number_text(value);
    return fmt::format("{:g}", value);
}

std::vector<double> ticks(double low, double high, bool log) {
    std::vector<double> all;
    if (!std::isfinite(high - low) || (log && !(low > 0))) return all;
    if (log) {
        const double decades = std::log10(high / low);
        const int step = std::max(1, static_cast<int>(std::ceil(decades / 7)));
        const std::vector<double> within = decades < 1.2   ? std::vector<double>{1, 2, 3, 5}
                                           : decades < 2.2 ? std::vector<double>{1, 3}
                                                           : std::vector<double>{1};
        for (int power = static_cast<int>(std::floor(std::log10(low))); power <= std::log10(high); ++power) {
            if (power % step != 0) continue;
            for (const double digit : within) {
                const double value = power < 0 ? digit / std::pow(10.0, -power) : digit * std::pow(10.0, power);
                if (value >= low && value <= high) all.push_back(value);
            }
        }
        return all;
    }
    double step = std::pow(10.0, std::floor(std::log10((high - low) / 4)));
    for (const double factor : {2.0, 2.5, 2.0})
        if ((high - low) / step > 7) step *= factor;
    if (low >= 0 && high <= 20 && step < 1) step = 1;  // small counts have integer ticks
    constexpr int most = 32;                           // where rounding makes steps of nothing
    const double first = std::ceil(low / step) * step;
    for (int i = 0; i < most && first + i * step <= high; ++i) all.push_back(first + i * step);
    return all;
}

std::string chart_svg(const Chart& chart) {
    Scale x(chart.x.log, left, chart.width - right), y(chart.y.log, chart.height - bottom, top);
    for (const ChartSeries& series : chart.series) {
        if (!series.dots && series.dashed) continue;  // guide lines do not extend the axes
        for (const ChartPoint& point : series.points) {
            x.take(point.x);
            for (const double value : {point.y, point.low, point.high})
                if (value != 0) y.take(value);
        }
    }
    x.add_margins();
    y.add_margins();
    std::string svg = open_svg(chart.width, chart.height, chart.description);
    for (const double value : y.marks()) svg += y_tick(y(value), chart.width, tick_text(value));
    for (const double value : x.marks()) svg += x_tick(x(value), chart.height, tick_text(value));
    svg += fmt::format("\n<path class=\"frame\" d=\"M{} {}H{}\"/>", left, chart.height - bottom, chart.width - right);
    svg += axis_labels(chart.width, chart.height, chart.x.label, chart.y.label);
    std::string dots;
    for (const ChartSeries& series : chart.series) {
        std::string path;
        for (const ChartPoint& point : series.points) {
            if (!x.inside(point.x) || !y.inside(point.y)) continue;
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(point.x), y(point.y));
            if (point.high > point.low && y.drawable(point.low))
                dots += fmt::format("<path class=\"range s{}{}\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>", series.color,
                                    point.faint ? " faint" : "", x(point.x), y(y.clamped(point.low)),
                                    y(y.clamped(point.high)));
            if (series.dots) dots += dot(series, point, x(point.x), y(point.y));
        }
        if (series.line && !path.empty())
            svg += fmt::format("<path class=\"line s{}{}\" d=\"{}\"/>\n", series.color, series.dashed ? " dashed" : "",
                               path);
    }
    svg += dots;
    for (const ChartMark& mark : chart.marks) {
        const bool leftward = x(mark.x) > 0.7 * chart.width;
        svg += fmt::format(
            "\n<circle class=\"ring\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"10\"/><text class=\"word\" x=\"{:.1f}\" "
            "y=\"{:.1f}\" text-anchor=\"{}\">{}</text>",
            x(mark.x), y(mark.y), x(mark.x) + (leftward ? -14 : 14), y(mark.y) - 9, leftward ? "end" : "start",
            escaped(mark.word));
    }
    return svg + "\n</svg>\n";
}

std::string chart_legend(const Chart& chart) {
    std::string items;
    size_t count = 0;
    for (const ChartSeries& series : chart.series) {
        if (series.label.empty()) continue;
        ++count;
        items += fmt::format("<li><span class=\"key s{}{}{}\"></span>{}</li>", series.color,
                             series.dashed ? " dashed" : "", key_shape(series.shape), escaped(series.label));
    }
    return count < 2 ? "" : "<ul class=\"legend\">" + items + "</ul>\n";
}

std::string stacks_svg(const Stacks& stacks) {
    Scale y(false, stacks.height - bottom, top);
    y.take(0);
    for (const Stack& column : stacks.columns) {
        double sum = 0;
        for (const double part : column.parts) sum += part;
        y.take(sum);
    }
    y.add_margins();
    std::string svg = open_svg(stacks.width, stacks.height, stacks.description);
    for (const double value : y.marks()) svg += y_tick(y(value), stacks.width, tick_text(value));
    svg += axis_labels(stacks.width, stacks.height, stacks.x_label, stacks.y_label);
    const double room = (stacks.width - left - right) / static_cast<double>(std::max<size_t>(1, stacks.columns.size()));
    const size_t every = stacks.columns.size() > 12 ? 4 : 1;
    for (size_t i = 0; i < stacks.columns.size(); ++i) {
        const Stack& column = stacks.columns[i];
        const double at = left + room * static_cast<double>(i);
        double below = 0;
        for (size_t part = 0; part < column.parts.size(); ++part) {
            if (column.parts[part] <= 0) continue;
            const double from = y(below), to = y(below + column.parts[part]);
            svg += fmt::format(
                "<rect class=\"bar s{}\" x=\"{:.1f}\" y=\"{:.2f}\" width=\"{:.1f}\" height=\"{:.2f}\"><title>{}</title>"
                "</rect>",
                part, at + 0.12 * room, to, 0.76 * room, from - to,
                escaped(fmt::format("{} {}: {} {}", stacks.x_label, column.label, number_text(column.parts[part]),
                                    stacks.names.at(part))));
            below += column.parts[part];
        }
        if (i % every == every - 1 || every == 1 || i == 0) svg += x_tick(at + room / 2, stacks.height, column.label);
    }
    svg += fmt::format("<path class=\"frame\" d=\"M{} {}H{}\"/>", left, stacks.height - bottom, stacks.width - right);
    return svg + "\n</svg>\n";
}

}  // namespace cistula::report
