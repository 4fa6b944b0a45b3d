#include "stored_layers.h"

#include <iterator>

#include "apps/common/header_attributes.h"

namespace cistula {
namespace {

std::string type_of(const Attributes::mapped_type& value) {
    constexpr const char* types[] = {"string", "int", "double", "floats", "rational"};
    static_assert(std::size(types) == std::variant_size_v<Attributes::mapped_type>);
    return types[value.index()];
}

}  // namespace

StoredFile stored_layers(const LayeredPicture& picture) {
    StoredPicture stored;
    stored.data = {picture.x, picture.y, picture.width, picture.height};
    stored.display = {0, 0, picture.display_width, picture.display_height};
    for (const LayeredPicture::Channel& channel : picture.channels)
        stored.channels.push_back(
            {channel.name, channel.half ? StoredType::half : StoredType::float_, 1, 1, channel.values});
    for (const auto& [name, value] : picture.attributes) {
        const std::string text = attribute_text(value);
        stored.attributes[name] = {type_of(value), text, text};
    }
    return {"openexr", {std::move(stored)}};
}

}  // namespace cistula
