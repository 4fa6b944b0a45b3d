#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "scene/base/suggest.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

std::string counted(size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string over_fail_text(const Comparison& comparison, const Thresholds& thresholds) {
    const double percent = 100.0 * static_cast<double>(comparison.over_fail) / static_cast<double>(comparison.pixels);
    return fmt::format("{} of {} ({:.4g} %) over --fail {}, {} % allowed", comparison.over_fail,
                       counted(comparison.pixels, "pixel"), percent, *thresholds.fail, thresholds.failpercent);
}

std::string over_hardfail_text(const Comparison& comparison, const Thresholds& thresholds) {
    return fmt::format("{} over --hardfail {}", counted(comparison.over_hardfail, "pixel"), *thresholds.hardfail);
}

Json number(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    return value;
}

template <class T>
Json optional_number(const std::optional<T>& value) {
    return value ? number(*value) : Json();
}

}  // namespace

std::string worst_text(const ChannelStatistics& channel) {
    const auto value = [&](float v) {
        return channel.max > 0 ? fmt::format("{:.9g}", v)
                               : fmt::format("{:.9g} (bits {:08x})", v, std::bit_cast<uint32_t>(v));
    };
    return fmt::format("({}, {}): {} / {}", channel.x, channel.y, value(channel.a), value(channel.b));
}

std::string verdict(const Comparison& comparison, const Thresholds& thresholds) {
    std::vector<std::string> parts;
    if (!comparison.structure.empty()) parts.push_back("the windows or channels differ");
    const size_t floats = comparison.channels.size() * comparison.pixels;
    if (!thresholds.any()) {
        if (passes(comparison, thresholds))
            return fmt::format("equal: every bit of {} and of the header", counted(floats, "float"));
        if (comparison.differing() > 0)
            parts.push_back(fmt::format("{} of {} differ", comparison.differing(), counted(floats, "float")));
        else if (!comparison.channels.empty())
            parts.push_back(fmt::format("all {} compared are equal", counted(floats, "float")));
        if (!comparison.header.empty()) parts.push_back("the header differs");
        return fmt::format("differ: {}", fmt::join(parts, "; "));
    }
    if (comparison.pixels > 0) {
        if (thresholds.fail) parts.push_back(over_fail_text(comparison, thresholds));
        if (thresholds.hardfail) parts.push_back(over_hardfail_text(comparison, thresholds));
    }
    return fmt::format("{}: {}", passes(comparison, thresholds) ? "within the thresholds" : "differ",
                       fmt::join(parts, "; "));
}

std::string report_text(const Comparison& comparison, const Thresholds& thresholds) {
    std::string text;
    for (const std::string& line : comparison.structure) text += one_line(line) + "\n";
    for (const std::string& line : comparison.header) text += "header: " + one_line(line) + "\n";
    if (!comparison.channels.empty()) {
        size_t width = 7;
        for (const ChannelStatistics& channel : comparison.channels) width = std::max(width, channel.name.size());
        text += fmt::format("{:<{}} {:>10} {:>10} {:>10} {:>8} {:>10}  {}\n", "channel", width, "max", "mean", "rmse",
                            "psnr dB", "differing", "worst pixel (x, y): first / second");
        for (const ChannelStatistics& c : comparison.channels)
            text += fmt::format("{:<{}} {:>10.4g} {:>10.4g} {:>10.4g} {:>8.2f} {:>10}  {}\n", one_line(c.name), width,
                                c.max, c.mean, c.rmse, c.psnr, c.differing, c.differing > 0 ? worst_text(c) : "-");
    }
    return text + verdict(comparison, thresholds) + "\n";
}

Json report_json(const Comparison& comparison, const CompareOptions& options) {
    const Thresholds& t = options.thresholds;
    Json channels = Json::array();
    for (const ChannelStatistics& c : comparison.channels) {
        Json worst;
        if (c.differing > 0) worst = {{"x", c.x}, {"y", c.y}, {"first", number(c.a)}, {"second", number(c.b)}};
        channels.push_back({{"name", c.name},
                            {"max", number(c.max)},
                            {"mean", c.mean},
                            {"rmse", c.rmse},
                            {"psnr", number(c.psnr)},
                            {"differing", c.differing},
                            {"infinite", c.infinite},
                            {"worst", worst}});
    }
    return {{"first", options.a},
            {"second", options.b},
            {"holds", passes(comparison, t)},
            {"verdict", verdict(comparison, t)},
            {"thresholds",
             {{"fail", optional_number(t.fail)},
              {"failpercent", t.fail ? Json(t.failpercent) : Json()},
              {"hardfail", optional_number(t.hardfail)}}},
            {"structure", comparison.structure},
            {"header", comparison.header},
            {"pixels", comparison.pixels},
            {"over_fail", comparison.over_fail},
            {"over_hardfail", comparison.over_hardfail},
            {"max", number(comparison.max)},
            {"channels", channels}};
}

}  // namespace cistula
