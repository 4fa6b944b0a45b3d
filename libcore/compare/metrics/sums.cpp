#include "compare/metrics/sums.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "image/picture/picture.h"
#include "render/record/film_picture.h"
#include "scene/description/light_group.h"

namespace cistula {
namespace {

using Channels = std::map<std::string, const LayeredPicture::Channel*>;

/// Half the distance from a value to the next larger one of its type.
double half_unit(float value, bool half) {
    const double magnitude = std::abs(static_cast<double>(value));
    const int digits = half ? 11 : 24;
    const int least = half ? -14 : -126;
    const int exponent = std::max(magnitude > 0 ? std::ilogb(magnitude) : least, least);
    return std::ldexp(1.0, exponent - digits);
}

/// What colors of other spaces add: their values are rounded in double before they are in the file.
constexpr double slack = 0x1p-45;

DivisionSums sums_of(const std::string& name, const std::vector<std::string>& layers, const Channels& channels,
                     const LayeredPicture& picture) {
    DivisionSums sums;
    sums.name = name;
    sums.layers = layers.size();
    const size_t pixels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
        bool is_off = false;
        for (const char* channel : {"R", "G", "B"}) {
            const LayeredPicture::Channel& whole = *channels.at(channel);
            double sum = 0, size = 0, allowed = half_unit(whole.values[pixel], whole.half);
            for (const std::string& layer : layers) {
                const LayeredPicture::Channel& part = *channels.at(layer + '.' + channel);
                sum += static_cast<double>(part.values[pixel]);
                size += std::abs(static_cast<double>(part.values[pixel]));
                allowed += half_unit(part.values[pixel], part.half);
            }
            const double off = std::abs(sum - static_cast<double>(whole.values[pixel]));
            if (std::isfinite(sum) && off <= allowed + slack * size) continue;  // what is not finite is off
            is_off = true;
            if (off <= sums.most) continue;
            sums.most = off;
            sums.x = picture.x + static_cast<int>(pixel % static_cast<size_t>(picture.width));
            sums.y = picture.y + static_cast<int>(pixel / static_cast<size_t>(picture.width));
            sums.channel = channel;
        }
        sums.pixels_off += is_off;
    }
    return sums;
}

bool has_all(const Channels& channels, const std::string& layer) {
    const std::string before = layer.empty() ? "" : layer + '.';
    return channels.count(before + "R") + channels.count(before + "G") + channels.count(before + "B") == 3;
}

}  // namespace

std::vector<DivisionSums> division_sums(const LayeredPicture& picture) {
    Channels channels;
    for (const LayeredPicture::Channel& channel : picture.channels) channels[channel.name] = &channel;
    std::vector<DivisionSums> divisions;
    if (!has_all(channels, "")) return divisions;
    const auto add = [&](const std::string& name, const std::vector<std::string>& layers) {
        for (const std::string& layer : layers)
            if (!has_all(channels, layer)) return;
        divisions.push_back(sums_of(name, layers, channels, picture));
    };
    add("path", {path_layer_names, path_layer_names + path_layer_count});
    constexpr std::string_view light = light_layer_prefix;
    constexpr std::string_view red = ".R";
    std::vector<std::string> lights;
    for (const std::string_view layer : common_light_layer_names) lights.push_back(std::string(light).append(layer));
    for (const auto& [name, channel] : channels) {
        if (name.substr(0, light.size()) != light || name.size() < red.size()) continue;
        if (name.substr(name.size() - red.size()) != red) continue;
        const std::string layer = name.substr(0, name.size() - red.size());
        if (std::find(lights.begin(), lights.end(), layer) == lights.end()) lights.push_back(layer);
    }
    const int* const count = attribute_of<int>(picture, light_layer_count);
    if (!count || static_cast<size_t>(*count) == lights.size()) add("light", lights);
    return divisions;
}

std::string sums_text(const std::vector<DivisionSums>& divisions, size_t pixels) {
    std::string text;
    for (const DivisionSums& sums : divisions) {
        text += fmt::format("{}: {} layers ", sums.name, sums.layers);
        if (sums.pixels_off == 0)
            text += fmt::format("add up to R G B in all {} pixels\n", pixels);
        else
            text += fmt::format("do not add up to R G B in {} of {} pixels, by up to {:.4g} ({} at {},{})\n",
                                sums.pixels_off, pixels, sums.most, sums.channel, sums.x, sums.y);
    }
    return text;
}

}  // namespace cistula
