#include "apps/common/header_attributes.h"

#include <array>

namespace cistula {
namespace {

constexpr const char* proven_truncation = "cistula:provenTruncation";
constexpr const char* checked_pixels = "cistula:checkedPixels";
constexpr const char* off_pixels = "cistula:offPixels";

}  // namespace

void add_target_attributes(const TargetReport& report, Attributes& attributes) {
    attributes[proven_truncation] = report.worst_truncation;
    attributes[checked_pixels] = static_cast<int>(report.checked);
    attributes[off_pixels] = static_cast<int>(report.off);
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
    Attributes settings = picture.attributes;
    for (const char* result : {proven_truncation, checked_pixels, off_pixels}) settings.erase(result);
    return windows(picture) == windows(expected) && picture.compression == expected.compression &&
           channels(picture) == channels(expected) && settings == expected.attributes;
}

}  // namespace cistula
