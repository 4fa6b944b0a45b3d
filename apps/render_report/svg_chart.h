// Small charts as inline SVG. Colors are CSS classes (s0 to s6, see page_style.cpp), so that the page chooses them for
// light and dark.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cistula::report {

struct ChartPoint {
    double x = 0, y = 0;
    double low = 0, high = 0;  // range of y; not drawn if equal
    std::string tip;           // tooltip
    bool faint = false;
};

enum class DotShape { circle, square, diamond };

struct ChartSeries {
    std::string label;  // for the legend; empty: not in it
    int color = 0;      // the class, s0 ...
    std::vector<ChartPoint> points;
    bool line = true, dots = true;
    bool dashed = false;
    DotShape shape = DotShape::circle;
};

struct ChartAxis {
    std::string label;
    bool log = true;
};

/// A ring around a point, with a label.
struct ChartMark {
    double x = 0, y = 0;
    std::string word;
};

struct Chart {
    std::string description;  // text alternative for screen readers
    ChartAxis x, y;
    std::vector<ChartSeries> series;
    std::vector<ChartMark> marks;
    int width = 480, height = 330;  // in units of the drawing; text is 14 high
};

/// The chart as SVG, without its legend. Points that are not finite, and those <= 0 on a logarithmic axis, are not
/// drawn.
std::string chart_svg(const Chart& chart);

/// The legend: a list of the series that have a label; empty for fewer than two.
std::string chart_legend(const Chart& chart);

/// A column of stacked parts.
struct Stack {
    std::string label;
    std::vector<double> parts;  // in the order of the names and colors
};
struct Stacks {
    std::string description, x_label, y_label;
    std::vector<std::string> names;  // of the parts
    std::vector<Stack> columns;
    int width = 480, height = 300;
};
std::string stacks_svg(const Stacks& stacks);

/// The label of a tick: "10³", "0.01", "500".
std::string tick_text(double value);

/// Round values from `low` to `high` for ticks.
std::vector<double> ticks(double low, double high, bool log);

}  // namespace cistula::report
