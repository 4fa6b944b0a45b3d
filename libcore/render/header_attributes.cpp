#include "render/header_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace cistula {
namespace {

constexpr const char* proven_truncation = "cistula:provenTruncation";
constexpr const char* checked_pixels = "cistula:checkedPixels";
constexpr const char* off_pixels = "cistula:offPixels";

}  // namespace

std::string attribute_text(const Attributes::mapped_type& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* whole = std::get_if<int>(&value)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    if (const auto* ratio = std::get_if<Ratio>(&value))
        return fmt::format("{}/{}", ratio->numerator, ratio->denominator);
    return fmt::format("{}", fmt::join(std::get<std::vector<float>>(value), " "));
}

void add_target_attributes(const TargetReport& report, Attributes& attributes) {
    attributes[proven_truncation] = report.worst_truncation;
    attributes[checked_pixels] = static_cast<int>(report.checked);
    attributes[off_pixels] = static_cast<int>(report.off);
}

Attributes without_target_attributes(Attributes attributes) {
    for (const char* result : {proven_truncation, checked_pixels, off_pixels}) attributes.erase(result);
    return attributes;
}

void join_target_attributes(const Attributes& more, Attributes& attributes) {
    for (auto& [name, value] : attributes) {
        const auto other = more.find(name);
        if (other == more.end() || other->second.index() != value.index()) continue;
        if (name == proven_truncation)
            value = std::max(std::get<double>(value), std::get<double>(other->second));
        else if (name == checked_pixels || name == off_pixels)
            value = std::get<int>(value) + std::get<int>(other->second);
    }
}

bool is_same_image(const LayeredPicture& picture, const LayeredPicture& expected) {
    const auto windows = [](const LayeredPicture& p) {
        return std::array{p.width, p.height, p.x, p.y, p.display_width, p.display_height};
    };
    const auto channels = [](const LayeredPicture& p) {
        std::map<std::string, bool> names;
        for (const LayeredPicture::Channel& channel : p.channels) names[channel.name] = channel.half;
        return names;
    };
    return windows(picture) == windows(expected) && picture.compression == expected.compression &&
           channels(picture) == channels(expected) &&
           without_target_attributes(picture.attributes) == expected.attributes;
}

}  // namespace cistula
