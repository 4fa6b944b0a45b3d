#include "scene/film/split_picture.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

namespace cistula {
namespace {

using LayerAttributes = decltype(LayeredPicture::attributes);

/// Attributes of a Cryptomatte: cryptomatte/KEY/name and others.
constexpr std::string_view cryptomatte = "cryptomatte/";

/// The attributes of each Cryptomatte by its name, taken from those of the picture.
std::map<std::string, LayerAttributes> take_cryptomattes(LayerAttributes& attributes) {
    std::map<std::string, LayerAttributes> by_name;
    for (auto first = attributes.lower_bound(std::string(cryptomatte));
         first != attributes.end() && first->first.starts_with(cryptomatte);) {
        const std::string place = first->first.substr(0, first->first.find('/', cryptomatte.size()) + 1);
        LayerAttributes own;
        while (first != attributes.end() && first->first.starts_with(place)) own.insert(attributes.extract(first++));
        const auto name = own.find(place + "name");
        if (name != own.end()) by_name[std::get<std::string>(name->second)] = std::move(own);
    }
    return by_name;
}

}  // namespace

std::vector<PicturePart> split_by_layer(LayeredPicture picture) {
    const std::map<std::string, LayerAttributes> cryptomattes = take_cryptomattes(picture.attributes);
    const auto layer_of = [&](const std::string& channel) {
        const size_t dot = channel.rfind('.');
        if (dot == std::string::npos) return std::string(main_part);
        const std::string layer = channel.substr(0, dot);
        const std::string unnumbered = layer.substr(0, layer.find_last_not_of("0123456789") + 1);
        return cryptomattes.count(unnumbered) != 0 ? unnumbered : layer;
    };
    std::vector<LayeredPicture::Channel> channels = std::move(picture.channels);
    picture.channels.clear();
    std::vector<PicturePart> parts = {{main_part, picture}};
    for (LayeredPicture::Channel& channel : channels) {
        const std::string layer = layer_of(channel.name);
        auto part =
            std::find_if(parts.begin(), parts.end(), [&](const PicturePart& known) { return known.name == layer; });
        if (part == parts.end()) {
            part = parts.insert(part, {layer, picture});
            if (const auto own = cryptomattes.find(layer); own != cryptomattes.end())
                part->picture.attributes.insert(own->second.begin(), own->second.end());
        }
        part->picture.channels.push_back(std::move(channel));
    }
    return parts;
}

void name_colors_plainly(PicturePart& part) {
    for (LayeredPicture::Channel& channel : part.picture.channels)
        for (const char* color : {"R", "G", "B"})
            if (channel.name == part.name + '.' + color) channel.name = color;
}

}  // namespace cistula
