#include "image/picture/stored_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace cistula {
namespace {

std::string type_of(const Attributes::mapped_type& value) {
    constexpr const char* types[] = {"string", "int", "double", "floats", "rational"};
    static_assert(std::size(types) == std::variant_size_v<Attributes::mapped_type>);
    return types[value.index()];
}

}  // namespace

std::string attribute_text(const Attributes::mapped_type& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* whole = std::get_if<int>(&value)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    if (const auto* ratio = std::get_if<Ratio>(&value))
        return fmt::format("{}/{}", ratio->numerator, ratio->denominator);
    return fmt::format("{}", fmt::join(std::get<std::vector<float>>(value), " "));
}

StoredFile stored_file(const LayeredPicture& picture) {
    StoredPicture stored;
    stored.data = {picture.x, picture.y, picture.width, picture.height};
    stored.display = {0, 0, picture.display_width, picture.display_height};
    for (const LayeredPicture::Channel& channel : picture.channels) {
        std::vector<float> values(static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height));
        channel.put(0, values.size(), values.data());
        stored.channels.push_back(
            {channel.name, channel.half ? StoredType::half : StoredType::float_, 1, 1, std::move(values)});
    }
    for (const auto& [name, value] : picture.attributes) {
        const std::string text = attribute_text(value);
        stored.attributes[name] = {type_of(value), text, text};
    }
    return {"openexr", {std::move(stored)}};
}

}  // namespace cistula
