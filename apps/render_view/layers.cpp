#include "layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "base/suggest.h"
#include "image/picture/stored_picture.h"

namespace cistula {
namespace {

/// What follows the last dot of a name, or all of it.
std::string_view after_dot(std::string_view name) {
    return name.substr(name.rfind('.') + 1);  // npos + 1 is 0
}

/// Whether a layer's name is that of Cryptomatte's ids and coverages: CryptoObject00, crypto_asset01.
bool is_cryptomatte(std::string_view name) {
    const std::string last = lower_case(std::string(after_dot(name)));
    const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
    return last.find("crypto") != last.npos && is_digit(last.back()) && is_digit(last[last.size() - 2]);
}

bool is_normal(std::string_view name) {
    const std::string last = lower_case(std::string(after_dot(name)));
    return last == "n" || last.find("normal") != last.npos;
}

/// The kind of a channel that is a layer of its own. `component`: what follows its last dot.
LayerKind kind_of_one(std::string_view name, std::string_view component, ExrChannel::Type type) {
    const std::string last = lower_case(std::string(after_dot(name)));
    const auto ends = [&](std::string_view end) {
        return name.size() >= end.size() && name.substr(name.size() - end.size()) == end;
    };
    if (type == ExrChannel::Type::uint || last == "id" || ends("_id") || ends("Id") || ends("_ID"))
        return LayerKind::ids;
    if (component == "Z" || last == "z" || last.substr(0, 5) == "depth") return LayerKind::depth;
    if (component == "Y") return LayerKind::luminance;
    return LayerKind::scalar;
}

/// A set of components that are shown together.
struct ComponentSet {
    std::string_view components;  // in lower case, a letter each
    LayerKind kind;
};

/// The channels of a part with one name before the last dot.
class Group {
  public:
    Group(const ExrPart& part, std::string name) : part_(part), name_(std::move(name)) {}

    void add(size_t channel) { channels_.push_back(channel); }

    /// The group's layers; what they leave is a layer for each channel.
    std::vector<Layer> layers() const {
        std::vector<Layer> layers;
        std::vector<size_t> rest = channels_;
        if (const std::optional<Layer> set = first_set()) {
            layers.push_back(*set);
            std::erase_if(rest, [&](size_t channel) {
                return std::find(set->channels.begin(), set->channels.end(), channel) != set->channels.end();
            });
        }
        for (const size_t channel : rest) {
            const std::string& full = part_.channels[channel].name;
            const std::string name = channels_.size() == 1 && !name_.empty() ? name_ : full;
            layers.push_back({name, kind_of_one(name, after_dot(full), part_.channels[channel].type), 0, {channel}});
        }
        return layers;
    }

  private:
    std::optional<Layer> first_set() const {
        constexpr ComponentSet mattes{"rgba", LayerKind::mattes};
        constexpr ComponentSet sets[] = {{"rgb", LayerKind::color},
                                         {"xyz", LayerKind::vectors},
                                         {"xy", LayerKind::vectors},
                                         {"uv", LayerKind::texture}};
        if (is_cryptomatte(name_))
            if (const auto channels = find(letters(mattes.components)); !channels.empty())
                return Layer{name_, mattes.kind, 0, channels};
        if (name_.empty())
            if (const auto channels = find({"ry", "y", "by"}); !channels.empty())
                return Layer{"YC", LayerKind::chroma, 0, channels};
        for (const ComponentSet& set : sets) {
            if (name_.empty() && set.kind != LayerKind::color) continue;  // Z without a dot is a depth
            const std::vector<size_t> channels = find(letters(set.components));
            if (channels.empty()) continue;
            const bool normals = set.components == "xyz" && is_normal(name_);
            return Layer{name_.empty() ? "RGB" : name_, normals ? LayerKind::normals : set.kind, 0, channels};
        }
        return std::nullopt;
    }

    static std::vector<std::string> letters(std::string_view components) {
        std::vector<std::string> each;
        for (const char component : components) each.emplace_back(1, component);
        return each;
    }

    /// The channels of all these components; empty if one is missing.
    std::vector<size_t> find(const std::vector<std::string>& components) const {
        std::vector<size_t> found;
        for (const std::string& component : components) {
            const auto channel = std::find_if(channels_.begin(), channels_.end(), [&](size_t i) {
                return lower_case(std::string(after_dot(part_.channels[i].name))) == component;
            });
            if (channel == channels_.end()) return {};
            found.push_back(*channel);
        }
        return found;
    }

    const ExrPart& part_;
    std::string name_;
    std::vector<size_t> channels_;
};

std::vector<Layer> layers_of_part(const ExrPart& part) {
    std::map<std::string, Group> groups;  // that without a name first
    for (size_t i = 0; i < part.channels.size(); ++i) {
        const std::string& channel = part.channels[i].name;
        const size_t dot = channel.rfind('.');
        const std::string name = dot == channel.npos ? "" : channel.substr(0, dot);
        groups.try_emplace(name, part, name).first->second.add(i);
    }
    std::vector<Layer> layers;
    for (const auto& entry : groups) {
        const std::vector<Layer> more = entry.second.layers();
        layers.insert(layers.end(), more.begin(), more.end());
    }
    return layers;
}

}  // namespace

std::string_view kind_name(LayerKind kind) {
    switch (kind) {
        case LayerKind::color:
            return "color";
        case LayerKind::luminance:
            return "luminance";
        case LayerKind::chroma:
            return "luminance, chroma";
        case LayerKind::ids:
            return "ids";
        case LayerKind::mattes:
            return "mattes";
        case LayerKind::depth:
            return "depth";
        case LayerKind::normals:
            return "normals";
        case LayerKind::vectors:
            return "vectors";
        case LayerKind::texture:
            return "texture coordinates";
        case LayerKind::scalar:
            break;
    }
    return "scalar";
}

std::vector<Layer> layers_of(const std::vector<ExrPart>& parts) {
    std::vector<Layer> layers;
    std::set<std::string> names;
    for (size_t i = 0; i < parts.size(); ++i)
        for (Layer& layer : layers_of_part(parts[i])) {
            if (parts.size() > 1) layer.name = name_in_part(parts[i].name, layer.name);
            const std::string name = layer.name;
            for (int number = 2; !names.insert(layer.name).second; ++number)
                layer.name = fmt::format("{} ({})", name, number);
            layer.part = i;
            layers.push_back(std::move(layer));
        }
    return layers;
}

const Layer& default_layer(const std::vector<Layer>& layers) {
    for (const LayerKind kind : {LayerKind::color, LayerKind::chroma, LayerKind::luminance})
        for (const Layer& layer : layers)
            if (layer.kind == kind) return layer;
    return layers.front();
}

}  // namespace cistula
