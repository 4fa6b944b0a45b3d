#include "render/header_attributes.h"

#include <array>

namespace cistula {

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
