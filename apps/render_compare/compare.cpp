#include "compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <set>

namespace cistula {
namespace {

using Channel = LayeredPicture::Channel;
using Attribute = decltype(LayeredPicture::attributes)::mapped_type;

const Channel* find(const LayeredPicture& picture, const std::string& name) {
    for (const Channel& channel : picture.channels)
        if (channel.name == name) return &channel;
    return nullptr;
}

bool same_data_window(const LayeredPicture& a, const LayeredPicture& b) {
    return a.width == b.width && a.height == b.height && a.x == b.x && a.y == b.y;
}

/// The shortest text that reads back as the same number, so that equal texts are equal values, NaN and -0 included.
std::string to_text(const Attribute& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* whole = std::get_if<int>(&value)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    if (const auto* ratio = std::get_if<Ratio>(&value))
        return fmt::format("{}/{}", ratio->numerator, ratio->denominator);
    return fmt::format("{}", fmt::join(std::get<std::vector<float>>(value), " "));
}

std::vector<std::string> differing_structure(const LayeredPicture& a, const LayeredPicture& b) {
    std::vector<std::string> lines;
    const auto data = [](const LayeredPicture& p) { return fmt::format("{}x{}+{}+{}", p.width, p.height, p.x, p.y); };
    const auto display = [](const LayeredPicture& p) {
        return fmt::format("{}x{}", p.display_width, p.display_height);
    };
    if (data(a) != data(b)) lines.push_back(fmt::format("data window: {} / {}", data(a), data(b)));
    if (display(a) != display(b)) lines.push_back(fmt::format("display window: {} / {}", display(a), display(b)));
    for (const Channel& channel : a.channels)
        if (!find(b, channel.name)) lines.push_back(fmt::format("channel {}: only in the first", channel.name));
    for (const Channel& channel : b.channels)
        if (!find(a, channel.name)) lines.push_back(fmt::format("channel {}: only in the second", channel.name));
    return lines;
}

std::vector<std::string> differing_header(const LayeredPicture& a, const LayeredPicture& b) {
    std::vector<std::string> lines;
    for (const Channel& channel : a.channels) {
        const Channel* other = find(b, channel.name);
        if (other && other->half != channel.half)
            lines.push_back(fmt::format("channel {}: {} / {}", channel.name, channel.half ? "half" : "float",
                                        other->half ? "half" : "float"));
    }
    std::set<std::string> names;
    for (const auto& picture : {&a, &b})
        for (const auto& entry : picture->attributes) names.insert(entry.first);
    for (const std::string& name : names) {
        const auto first = a.attributes.find(name), second = b.attributes.find(name);
        const bool in_first = first != a.attributes.end(), in_second = second != b.attributes.end();
        if (in_first && in_second && first->second.index() == second->second.index() &&
            to_text(first->second) == to_text(second->second))
            continue;
        lines.push_back(fmt::format("{}: {} / {}", name, in_first ? to_text(first->second) : "(none)",
                                    in_second ? to_text(second->second) : "(none)"));
    }
    return lines;
}

/// Statistics of two channels; `window`: the picture whose data window both have.
ChannelStatistics statistics_of(const Channel& a, const Channel& b, const LayeredPicture& window,
                                std::vector<double>& worst_of_pixels) {
    ChannelStatistics result;
    result.name = a.name;
    double sum = 0, squares = 0, peak = 1;
    size_t worst = 0;
    for (size_t i = 0; i < a.values.size(); ++i) {
        for (const float value : {a.values[i], b.values[i]})
            if (std::isfinite(value)) peak = std::max(peak, std::abs(static_cast<double>(value)));
        if (std::bit_cast<uint32_t>(a.values[i]) == std::bit_cast<uint32_t>(b.values[i])) continue;
        const double d = difference(a.values[i], b.values[i]);
        if (result.differing++ == 0 || d > result.max) worst = i;
        result.max = std::max(result.max, d);
        worst_of_pixels[i] = std::max(worst_of_pixels[i], d);
        if (std::isinf(d)) {
            ++result.infinite;
            continue;
        }
        sum += d;
        squares += d * d;
    }
    if (const auto counted = static_cast<double>(a.values.size() - result.infinite); counted > 0) {
        result.mean = sum / counted;
        result.rmse = std::sqrt(squares / counted);
    }
    if (result.rmse > 0) result.psnr = 20 * std::log10(peak / result.rmse);
    const auto width = static_cast<size_t>(window.width);
    result.x = window.x + static_cast<int>(worst % width);
    result.y = window.y + static_cast<int>(worst / width);
    result.a = a.values[worst];
    result.b = b.values[worst];
    return result;
}

}  // namespace

double difference(float a, float b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b) ? 0 : INFINITY;
    return a == b ? 0 : std::abs(static_cast<double>(a) - static_cast<double>(b));
}

size_t Comparison::differing() const {
    size_t sum = 0;
    for (const ChannelStatistics& channel : channels) sum += channel.differing;
    return sum;
}

Comparison compare_pictures(const LayeredPicture& a, const LayeredPicture& b, const Thresholds& thresholds) {
    Comparison result;
    result.structure = differing_structure(a, b);
    result.header = differing_header(a, b);
    if (!same_data_window(a, b)) return result;
    result.pixels = static_cast<size_t>(a.width) * static_cast<size_t>(a.height);
    std::vector<double> worst_of_pixels(result.pixels);
    for (const Channel& channel : a.channels) {
        const Channel* other = find(b, channel.name);
        if (!other) continue;
        result.channels.push_back(statistics_of(channel, *other, a, worst_of_pixels));
        result.max = std::max(result.max, result.channels.back().max);
    }
    for (const double worst : worst_of_pixels) {
        if (thresholds.fail && worst > *thresholds.fail) ++result.over_fail;
        if (thresholds.hardfail && worst > *thresholds.hardfail) ++result.over_hardfail;
    }
    return result;
}

bool passes(const Comparison& comparison, const Thresholds& thresholds) {
    if (!comparison.structure.empty()) return false;
    if (!thresholds.any()) return comparison.differing() == 0 && comparison.header.empty();
    return static_cast<double>(comparison.over_fail) * 100 <=
               thresholds.failpercent * static_cast<double>(comparison.pixels) &&
           comparison.over_hardfail == 0;
}

LayeredPicture difference_picture(const LayeredPicture& a, const LayeredPicture& b) {
    LayeredPicture picture;
    picture.width = a.width;
    picture.height = a.height;
    picture.x = a.x;
    picture.y = a.y;
    picture.display_width = a.display_width;
    picture.display_height = a.display_height;
    for (const Channel& channel : a.channels) {
        const Channel* other = find(b, channel.name);
        if (!other) continue;
        Channel differences{channel.name, false, {}};
        for (size_t i = 0; i < channel.values.size(); ++i)
            differences.values.push_back(static_cast<float>(difference(channel.values[i], other->values[i])));
        picture.channels.push_back(std::move(differences));
    }
    return picture;
}

}  // namespace cistula
