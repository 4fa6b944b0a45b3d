#include "image/picture/picture_hash.h"

#include <Imath/half.h>

#include <algorithm>

#include "base/fnv128.h"

namespace cistula {

void round_to_stored(LayeredPicture& picture) {
    for (LayeredPicture::Channel& channel : picture.channels)
        if (channel.half)
            for (float& value : channel.values) value = half(value);
}

std::string picture_hash(const LayeredPicture& picture) {
    Fnv128 hash;
    const auto add_number = [&](int number) { hash.add(static_cast<uint32_t>(number)); };
    for (const int number :
         {picture.width, picture.height, picture.x, picture.y, picture.display_width, picture.display_height})
        add_number(number);
    std::vector<const LayeredPicture::Channel*> channels;
    for (const LayeredPicture::Channel& channel : picture.channels) channels.push_back(&channel);
    std::sort(channels.begin(), channels.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
    add_number(static_cast<int>(channels.size()));
    for (const LayeredPicture::Channel* channel : channels) {
        add_number(static_cast<int>(channel->name.size()));
        hash.add_bytes(channel->name.data(), channel->name.size());
        hash.add(static_cast<uint8_t>(channel->half ? 1 : 2));
        for (const float value : channel->values) {
            if (channel->half)
                hash.add(half(value).bits());
            else
                hash.add(value);
        }
    }
    return hash.hex();
}

}  // namespace cistula
