// Section 3: where the time goes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "html.h"
#include "image.h"
#include "svg_chart.h"

namespace cistula::report {
namespace {

const std::vector<std::string> kinds = {"primary", "reflected", "transmitted", "shadow"};

std::vector<double> parts_of(const Rays& rays) {
    return {static_cast<double>(rays.primary), static_cast<double>(rays.reflected),
            static_cast<double>(rays.transmitted), static_cast<double>(rays.shadow)};
}

std::string ray_figure(const Shown& shown) {
    Stacks stacks;
    stacks.description = shown.title + ": rays by kind at each depth";
    stacks.x_label = "depth";
    stacks.y_label = "rays a pixel";
    stacks.names = kinds;
    const double pixels = static_cast<double>(shown.scene->width) * shown.scene->height;
    std::vector<double> totals(kinds.size());
    double sum = 0;
    for (const Level& level : shown.scene->levels) {
        std::vector<double> parts = parts_of(level.rays);
        for (size_t i = 0; i < parts.size(); ++i) totals[i] += parts[i], sum += parts[i], parts[i] /= pixels;
        stacks.columns.push_back({std::to_string(level.depth), parts});
    }
    if (sum <= 0) return "";
    std::string legend = "<ul class=\"legend\">";
    for (size_t i = 0; i < kinds.size(); ++i)
        legend += fmt::format("<li><span class=\"key block s{}\"></span>{} {}</li>", i, kinds[i],
                              percent_text(totals[i] / sum));
    return figure(
        legend + "</ul>\n" + stacks_svg(stacks),
        fmt::format("<b>Rays by kind and depth</b>, one sample a pixel: what a frame of depth n traces beyond "
                    "one of depth n − 1. {} rays in all, {} a pixel.",
                    float_count_text(sum), number_text(sum / pixels)));
}

std::string heat_figure(const Shown& shown) {
    const SceneRecord& scene = *shown.scene;
    if (scene.heat.png.empty()) return "";
    std::string stops;
    for (int i = 0; i <= 8; ++i) {
        const auto c = heat_color(i / 8.0);
        stops += fmt::format("{}rgb({},{},{})", i ? "," : "", c[0], c[1], c[2]);
    }
    return figure(
        image_tag(scene.heat, shown.title + ": the rays of every pixel as colors, dark is few, bright is many") +
            fmt::format("<div class=\"scale\" style=\"background:linear-gradient(90deg,{})\"></div>"
                        "<div class=\"ends\"><span>few</span><span>{} rays</span></div>",
                        stops, float_count_text(scene.heat_most)),
        fmt::format("<b>Cost of a pixel</b>, logarithmic: {} rays in the mean, {} at most, at depth {}.",
                    number_text(scene.heat_mean), float_count_text(scene.heat_most), scene.base.depth));
}

const Entry* entry_with(const Shown& shown, const Setting& setting) {
    for (const Entry* entry : shown.entries)
        if (entry->setting == setting) return entry;
    return nullptr;
}

std::string stage_table(const Shown& shown) {
    Setting single = shown.scene->base, twice = single;
    twice.precision = Precision::double_;
    const Entry *in_float = entry_with(shown, single), *in_double = entry_with(shown, twice);
    const bool gpu = in_float && !in_float->kernel.empty();
    Table table({"stage", ">float", ">double"},
                fmt::format("Before, in and after a frame of {}×{}, {}", shown.scene->width, shown.scene->height,
                            setting_text(single)));
    const auto stage = [&](const char* name, const char* words) {
        std::string cells[2] = {"–", "–"};
        for (const Stage& one : shown.scene->stages)
            if (one.name == name) cells[one.precision == "double" ? 1 : 0] = time_html(one.time);
        table.row({words, cells[0], cells[1]});
    };
    const auto entry = [&](const char* words, Timing Entry::*member) {
        table.row(
            {words, in_float ? time_html(in_float->*member) : "–", in_double ? time_html(in_double->*member) : "–"});
    };
    stage("compile", "compile the scene");
    stage("prepare", gpu ? "build the tree, upload" : "build the tree");
    stage("first frame", "first frame");
    if (gpu) {
        entry("kernels", &Entry::kernel);
        entry("read back", &Entry::transfer);
    }
    entry(gpu ? "a frame, all in all" : "a frame", &Entry::wall);
    for (const Stage& one : shown.scene->stages)  // the file has floats in either precision
        if (one.name == "encode") table.row({"encode and write an EXR", time_html(one.time), time_html(one.time)});
    return table.html();
}

std::string change_text(double change) {
    return fmt::format("{}{:.1f} %", change < 0 ? "−" : "+", 100 * std::abs(change));
}

std::string effect_table(const Shown& shown) {
    const auto& costs = shown.scene->effect_costs;
    if (costs.empty()) return "";
    const double least = costs.front().time.median();
    double most = 0;
    for (const MaskCost& cost : costs) most = std::max(most, cost.time.median());
    Table table(
        {"code compiled for", ">time", ">against the least", ""},
        "What effects that this scene does not use would cost if they were not left out (same bits, base setting)");
    for (const MaskCost& cost : costs) {
        const double time = cost.time.median();
        table.row(
            {cost.added.empty() ? "what the scene needs"
                                : "also " + escaped(fmt::format("{}", fmt::join(cost.added, ", "))),
             time_html(cost.time), cost.added.empty() ? "–" : change_text(time / least - 1),
             fmt::format("<span class=\"meter\"><span style=\"width:{:.1f}%\"></span></span>", 100 * time / most)});
    }
    return table.html();
}

}  // namespace

std::string where_section(const std::vector<Shown>& scenes) {
    std::string text;
    for (const Shown& shown : scenes) {
        text += fmt::format("<h3 id=\"{}-where\">{}</h3>\n", shown.id, escaped(shown.title));
        if (!shown.scene->effects.empty())
            text += fmt::format("<p>The scene calls for {}.</p>\n",
                                escaped(fmt::format("{}", fmt::join(shown.scene->effects, ", "))));
        text += "<div class=\"pair\">" + ray_figure(shown) + heat_figure(shown) + "</div>\n";
        text += stage_table(shown) + effect_table(shown);
    }
    return text;
}

}  // namespace cistula::report
