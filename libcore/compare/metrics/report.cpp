#include "compare/metrics/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/suggest.h"

namespace cistula {
namespace {

using Json = nlohmann::ordered_json;

std::string counted(size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string over_fail_text(const Comparison& comparison, const Thresholds& thresholds) {
    const double percent = 100.0 * static_cast<double>(comparison.over_fail) / static_cast<double>(comparison.pixels);
    return fmt::format("{} of {} ({:.4g} %) over `fail` {}, {} % allowed", comparison.over_fail,
                       counted(comparison.pixels, "pixel"), percent, *thresholds.fail, thresholds.failpercent);
}

std::string over_hardfail_text(const Comparison& comparison, const Thresholds& thresholds) {
    return fmt::format("{} over `hardfail` {}", counted(comparison.over_hardfail, "pixel"), *thresholds.hardfail);
}

/// "2 values are not finite in both; the first: R at (12, 34): nan / nan"; empty: there are none.
std::string nonfinite_text(const Comparison& comparison, NonfiniteValues ChannelStatistics::*kind, const char* where) {
    const size_t count = comparison.nonfinite(kind);
    if (count == 0) return "";
    const auto first = std::find_if(comparison.channels.begin(), comparison.channels.end(),
                                    [&](const ChannelStatistics& channel) { return (channel.*kind).count > 0; });
    const NonfiniteValues& values = (*first).*kind;
    return fmt::format("{} {} not finite {}; the first: {} at ({}, {}): {:.9g} / {:.9g}", counted(count, "value"),
                       count == 1 ? "is" : "are", where, first->name, values.x, values.y, values.a, values.b);
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

std::string channel_table(const Comparison& comparison) {
    if (comparison.channels.empty()) return "";
    size_t width = 7;
    bool has_ssim = false;
    for (const ChannelStatistics& channel : comparison.channels) {
        width = std::max(width, channel.name.size());
        has_ssim |= channel.ssim.has_value();
    }
    const auto ssim = [&](const std::string& text) { return has_ssim ? fmt::format(" {:>8}", text) : std::string(); };
    std::string text =
        fmt::format("{:<{}} {:>10} {:>10} {:>10} {:>8} {:>10}{} {:>10}  {}\n", "channel", width, "max", "mean", "rmse",
                    "psnr dB", "rel. mse", ssim("ssim"), "differing", "worst pixel (x, y): first / second");
    for (const ChannelStatistics& c : comparison.channels)
        text += fmt::format("{:<{}} {:>10.4g} {:>10.4g} {:>10.4g} {:>8.2f} {:>10.4g}{} {:>10}  {}\n", one_line(c.name),
                            width, c.max, c.mean, c.rmse, c.psnr, c.relative_mse,
                            ssim(c.ssim ? fmt::format("{:.6f}", *c.ssim) : "-"), c.differing,
                            c.differing > 0 ? worst_text(c) : "-");
    return text;
}

Json channel_json(const ChannelStatistics& c) {
    constexpr const char* units[] = {"value", "integer", "fraction"};
    Json worst;
    if (c.differing > 0) worst = {{"x", c.x}, {"y", c.y}, {"first", number(c.a)}, {"second", number(c.b)}};
    return {{"name", c.name},
            {"types", {type_name(c.first_type), type_name(c.second_type)}},
            {"unit", units[static_cast<size_t>(c.unit())]},
            {"values", c.values},
            {"max", number(c.max)},
            {"mean", number(c.mean)},
            {"rmse", number(c.rmse)},
            {"psnr", number(c.psnr)},
            {"relative_mse", number(c.relative_mse)},
            {"ssim", optional_number(c.ssim)},
            {"differing", c.differing},
            {"infinite", c.infinite},
            {"nonfinite_alike", c.nonfinite_alike.count},
            {"nonfinite_other", c.nonfinite_other.count},
            {"worst", worst}};
}

std::string flip_text(const FlipResult& flip) {
    if (!flip.absent.empty()) return fmt::format("flip: absent: {}", flip.absent);
    return fmt::format("{} ({}): mean {:.6f}, weighted median {:.6f}, min {:.6f}, max {:.6f}", flip.kind, flip.version,
                       flip.mean, flip.median, flip.min, flip.max);
}

Json flip_json(const FlipResult& flip) {
    if (!flip.absent.empty()) return {{"absent", flip.absent}};
    return {{"kind", flip.kind},     {"version", flip.version}, {"mean", flip.mean},
            {"median", flip.median}, {"min", flip.min},         {"max", flip.max}};
}

}  // namespace

std::string worst_text(const ChannelStatistics& channel) {
    const auto value = [&](double v, uint64_t bits, StoredType type) {
        if (channel.unit() == DifferenceUnit::integer) return fmt::format("{:.0f}", v);
        if (channel.max > 0) return fmt::format("{:.9g}", v);
        return fmt::format("{:.9g} (bits {:0{}x})", v, bits, type == StoredType::double_ ? 16 : 8);
    };
    return fmt::format("({}, {}): {} / {}", channel.x, channel.y, value(channel.a, channel.a_bits, channel.first_type),
                       value(channel.b, channel.b_bits, channel.second_type));
}

std::string verdict(const Comparison& comparison, const Thresholds& thresholds) {
    std::vector<std::string> parts;
    if (!comparison.structure.empty()) parts.push_back("the parts, windows or channels differ");
    const std::string values = counted(comparison.values(), comparison.has_only_floats() ? "float" : "value");
    if (!thresholds.any()) {
        if (passes(comparison, thresholds))
            return fmt::format("equal: every bit of {}{}", values,
                               comparison.compares_headers ? " and of the header" : "");
        if (comparison.differing() > 0)
            parts.push_back(fmt::format("{} of {} differ", comparison.differing(), values));
        else if (!comparison.channels.empty())
            parts.push_back(fmt::format("all {} compared are equal", values));
        if (!comparison.header.empty()) parts.push_back("the header differs");
        return fmt::format("differ: {}", fmt::join(parts, "; "));
    }
    const auto say_nonfinite = [&](NonfiniteValues ChannelStatistics::*kind, const char* where, const char* hint) {
        if (const std::string text = nonfinite_text(comparison, kind, where); !text.empty())
            parts.push_back(text + hint);
    };
    say_nonfinite(&ChannelStatistics::nonfinite_other, "in one, or differently in both", "");
    say_nonfinite(&ChannelStatistics::nonfinite_alike, "in both",
                  thresholds.allow_nonfinite ? "" : "; `allow_nonfinite` lets these pass");
    if (comparison.pixels > 0) {
        if (thresholds.fail) parts.push_back(over_fail_text(comparison, thresholds));
        if (thresholds.hardfail) parts.push_back(over_hardfail_text(comparison, thresholds));
    }
    if (thresholds.flip && comparison.flip)
        parts.push_back(comparison.flip->absent.empty()
                            ? fmt::format("FLIP {:.6f}, `failflip` {}", comparison.flip->mean, *thresholds.flip)
                            : fmt::format("FLIP is not known: {}", comparison.flip->absent));
    if (thresholds.ssim) {
        const std::optional<double> least = comparison.least_ssim();
        parts.push_back(least ? fmt::format("least SSIM {:.6f}, `failssim` {}", *least, *thresholds.ssim)
                              : std::string("no channel has an SSIM"));
    }
    return fmt::format("{}: {}", passes(comparison, thresholds) ? "within the thresholds" : "differ",
                       fmt::join(parts, "; "));
}

std::string report_text(const Comparison& comparison, const Thresholds& thresholds) {
    std::string text;
    const auto say = [&](const char* before, const std::vector<std::string>& lines) {
        for (const std::string& line : lines) text += before + one_line(line) + "\n";
    };
    say("", comparison.structure);
    say("header: ", comparison.header);
    say("not compared: ", comparison.not_compared);
    say("", comparison.units);
    text += channel_table(comparison);
    if (comparison.flip) text += one_line(flip_text(*comparison.flip)) + "\n";
    return text + verdict(comparison, thresholds) + "\n";
}

Json report_json(const Comparison& comparison, const Thresholds& t, const std::string& first,
                 const std::string& second) {
    Json channels = Json::array();
    for (const ChannelStatistics& channel : comparison.channels) channels.push_back(channel_json(channel));
    return {{"first", first},
            {"second", second},
            {"holds", passes(comparison, t)},
            {"verdict", verdict(comparison, t)},
            {"thresholds",
             {{"fail", optional_number(t.fail)},
              {"failpercent", t.fail ? Json(t.failpercent) : Json()},
              {"hardfail", optional_number(t.hardfail)},
              {"failflip", optional_number(t.flip)},
              {"failssim", optional_number(t.ssim)},
              {"allow_nonfinite", t.allow_nonfinite}}},
            {"structure", comparison.structure},
            {"header", comparison.header},
            {"not_compared", comparison.not_compared},
            {"pixels", comparison.pixels},
            {"over_fail", comparison.over_fail},
            {"over_hardfail", comparison.over_hardfail},
            {"max", number(comparison.max)},
            {"channels", channels},
            {"flip", comparison.flip ? flip_json(*comparison.flip) : Json()}};
}

}  // namespace cistula
