#include "render/record/film_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "base/option_text.h"
#include "base/suggest.h"
#include "scene/description/light_group.h"

namespace cistula {

OutputChannels parse_layers(std::string_view text, OutputChannels layers) {
    struct Layer {
        std::string_view name, group;
        bool* wanted;
    };
    std::vector<Layer> known;
    for (const auto& [name, group, wanted] : named_layers) known.push_back({name, group, &(layers.*wanted)});
    for (int layer = 0; layer < path_layer_count; ++layer)
        known.push_back({path_layer_names[layer], "path", &layers.path[layer]});
    std::vector<std::string_view> names = {"all", "path", "data", "cryptomatte"};
    for (const Layer& layer : known) names.push_back(layer.name);
    std::vector<std::string> lights;
    for (const std::string_view name : common_light_layer_names)
        lights.push_back(std::string(light_layer_prefix).append(name));
    lights.push_back(std::string(light_layer_prefix).append("GROUP"));  // of the scene, which is not read yet
    names.insert(names.end(), lights.begin(), lights.end());
    for (const Layer& layer : known) *layer.wanted = false;
    layers.light_layers.clear();
    bool all_lights = false;
    for (const std::string_view name : parts_at_commas(text)) {
        bool found = false;
        if (name.starts_with(light_layer_prefix)) {
            layers.light = found = true;
            layers.light_layers.emplace_back(name.substr(light_layer_prefix.size()));
        }
        all_lights |= name == "light" || name == "all";
        for (const Layer& layer : known)
            if (layer.name == name || layer.group == name || name == "all") *layer.wanted = found = true;
        if (!found) fail_usage(fmt::format("there is no layer '{}'", name), nearest_first(name, names, "layers"));
    }
    if (all_lights) layers.light_layers.clear();
    return layers;
}

void require_light_layers(const OutputChannels& channels, const LayerNames& names) {
    std::vector<std::string_view> known(std::begin(common_light_layer_names), std::end(common_light_layer_names));
    known.insert(known.end(), names.light_groups.begin(), names.light_groups.end());
    for (const std::string& layer : channels.light_layers)
        if (std::find(known.begin(), known.end(), layer) == known.end())
            fail_usage(fmt::format("`layers` {}{}: the scene has no such group of lights", light_layer_prefix, layer),
                       nearest_first(layer, known, "groups"));
}

}  // namespace cistula
