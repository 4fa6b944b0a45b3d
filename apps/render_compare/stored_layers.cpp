#include "stored_layers.h"

#include <fmt/format.h>

#include <iterator>

namespace cistula {
namespace {

using Attribute = decltype(LayeredPicture::attributes)::mapped_type;

/// The shortest text that reads back as the same number, so that equal texts are equal values, NaN and -0 included.
std::string to_text(const Attribute& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* whole = std::get_if<int>(&value)) return fmt::format("{}", *whole);
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
    if (const auto* ratio = std::get_if<Ratio>(&value))
        return fmt::format("{}/{}", ratio->numerator, ratio->denominator);
    return fmt::format("{}", fmt::join(std::get<std::vector<float>>(value), " "));
}

std::string type_of(const Attribute& value) {
    constexpr const char* types[] = {"string", "int", "double", "floats", "rational"};
    static_assert(std::size(types) == std::variant_size_v<Attribute>);
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
        const std::string text = to_text(value);
        stored.attributes[name] = {type_of(value), text, text};
    }
    return {"openexr", {std::move(stored)}};
}

}  // namespace cistula
