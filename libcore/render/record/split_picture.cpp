#include "render/record/split_picture.h"

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

/// The name of a Cryptomatte, of one of its layers: without the digits at its end.
std::string unnumbered(const std::string& layer) {
    return layer.substr(0, layer.find_last_not_of("0123456789") + 1);
}

bool is_main_channel(const std::string& channel) {
    return channel == "R" || channel == "G" || channel == "B" || channel == "A";
}

/// Whether a channel of a layer is part of a color, whose numbers have a color space.
bool is_color(const std::string& channel) {
    return channel.ends_with(".R") || channel.ends_with(".G") || channel.ends_with(".B");
}

}  // namespace

std::vector<PicturePart> split_by_layer(LayeredPicture picture, Split split) {
    const bool parts_of_one = split == Split::parts;
    const std::map<std::string, LayerAttributes> cryptomattes = take_cryptomattes(picture.attributes);
    const auto layer_of = [&](const std::string& channel) {
        const size_t dot = channel.rfind('.');
        if (dot != std::string::npos) {
            const std::string layer = channel.substr(0, dot);
            return !parts_of_one && cryptomattes.count(unnumbered(layer)) != 0 ? unnumbered(layer) : layer;
        }
        return parts_of_one && !is_main_channel(channel) ? channel : std::string(main_part);
    };
    std::vector<LayeredPicture::Channel> channels = std::move(picture.channels);
    picture.channels.clear();
    std::vector<PicturePart> parts = {{main_part, picture}};
    if (parts_of_one)
        for (const auto& [name, own] : cryptomattes) parts[0].picture.attributes.insert(own.begin(), own.end());
    for (LayeredPicture::Channel& channel : channels) {
        const std::string layer = layer_of(channel.name);
        auto part =
            std::find_if(parts.begin(), parts.end(), [&](const PicturePart& known) { return known.name == layer; });
        if (part == parts.end()) {
            part = parts.insert(part, {layer, picture});
            if (!is_color(channel.name)) {
                part->picture.attributes["colorInteropID"] = std::string("data");
                if (!parts_of_one) part->picture.attributes.erase("chromaticities");  // which parts of a file share
            }
            if (const auto own = cryptomattes.find(unnumbered(layer)); own != cryptomattes.end())
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
