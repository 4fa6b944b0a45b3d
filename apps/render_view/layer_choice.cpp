#include "layer_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/common/command_line.h"
#include "base/suggest.h"

namespace cistula {
namespace {

const Layer* find(const std::vector<Layer>& layers, std::string_view name) {
    const auto found =
        std::find_if(layers.begin(), layers.end(), [&](const Layer& layer) { return layer.name == name; });
    return found == layers.end() ? nullptr : &*found;
}

/// The text's names; a layer whose own name has commas is one.
std::vector<std::string_view> names_in(const std::vector<Layer>& layers, std::string_view text) {
    if (find(layers, text)) return {text};
    return parts_at_commas(text);
}

/// What a name asks for that is not a layer's: a channel, or the layers of a Cryptomatte.
std::vector<Layer> parts_of_layers(const std::vector<ExrPart>& parts, const std::vector<Layer>& layers,
                                   std::string_view name) {
    std::vector<Layer> found;
    for (const Layer& layer : layers) {
        if (layer.kind == LayerKind::mattes &&
            layer.name.substr(0, layer.name.find_last_not_of("0123456789") + 1) == name)
            found.push_back(layer);
        for (const size_t channel : layer.channels)
            if (parts[layer.part].channels[channel].name == name)
                return {{std::string(name), LayerKind::scalar, layer.part, {channel}}};
    }
    return found;
}

}  // namespace

std::vector<Layer> chosen_layers(const std::vector<ExrPart>& parts, const std::vector<Layer>& layers,
                                 const std::vector<std::string>& texts, const std::string& file) {
    if (texts.empty()) return {default_layer(layers)};
    std::vector<Layer> chosen;
    for (const std::string& text : texts)
        for (const std::string_view name : names_in(layers, text)) {
            const Layer* layer = find(layers, name);
            const std::vector<Layer> within = layer ? std::vector{*layer} : parts_of_layers(parts, layers, name);
            if (within.empty()) {
                std::vector<std::string_view> names;
                for (const Layer& known : layers) names.push_back(known.name);
                fail_usage(fmt::format("--layer {}: {} has no layer {}; {}", text, file, quoted(name),
                                       nearest_first(name, names, "layers")));
            }
            for (const Layer& one : within)
                if (!find(chosen, one.name)) chosen.push_back(one);
        }
    return chosen;
}

std::string layer_table(const std::vector<ExrPart>& parts, const std::vector<Layer>& layers) {
    size_t width = 5;
    for (const Layer& layer : layers) width = std::max(width, one_line(layer.name).size());
    std::string table = fmt::format("{:<{}}  {:<19}  {:<11}  {}\n", "layer", width, "shown as", "size", "channels");
    for (const Layer& layer : layers) {
        const ExrPart& part = parts[layer.part];
        std::string channels;
        for (const size_t channel : layer.channels) channels += " " + one_line(part.channels[channel].name);
        table += fmt::format("{:<{}}  {:<19}  {:<11}  {}{}\n", one_line(layer.name), width, kind_name(layer.kind),
                             fmt::format("{}x{}", part.width, part.height),
                             type_name(part.channels[layer.channels[0]].type), channels);
    }
    return table;
}

}  // namespace cistula
