#include "scene/description/light_group.h"

#include <algorithm>

namespace cistula {
namespace {

constexpr size_t longest = 63 - light_layer_prefix.size();  // bytes; Blender reads 63 of a layer's name

/// Whether a character may be in the name of a layer. All of UTF-8 beyond ASCII may.
bool is_allowed(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           static_cast<unsigned char>(c) >= 0x80;
}

/// The longest whole characters of a name that take so many bytes.
std::string cut(const std::string& name, size_t bytes) {
    size_t end = std::min(name.size(), bytes);
    while (end < name.size() && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;
    return name.substr(0, end);
}

}  // namespace

LightGroups::LightGroups(const SceneDescription& scene) : scene_(scene) {
    for (const LightDescription& light : scene.lights) used_.insert(light.group);
    for (const ObjectDescription& object : scene.objects)
        if (const auto* solid = std::get_if<SolidObject>(&object.shape)) used_.insert(solid->edge_lights.group);
}

std::string LightGroups::own(const std::string& name) {
    std::string tried = cut(name, longest);
    for (int number = 2; !used_.insert(tried).second; ++number) {
        const std::string end = '_' + std::to_string(number);
        tried = cut(name, longest - end.size()) + end;
    }
    return tried;
}

std::string LightGroups::of_light(size_t i) {
    const std::string& given = scene_.lights[i].group;
    return given.empty() ? own("light" + std::to_string(i)) : given;
}

std::string LightGroups::of_edges(const EdgeLights& lights, const std::string& solid) {
    if (!lights.group.empty()) return lights.group;
    std::string name = "edges_" + solid;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return !is_allowed(c); }, '_');
    return own(name);
}

std::string fault_of_light_group(const std::string& name) {
    if (name.empty()) return "is empty";
    if (name.size() > longest) return "is longer than " + std::to_string(longest) + " bytes";
    if (name.find('.') != std::string::npos) return "has a dot, which separates layers from channels";
    if (!std::all_of(name.begin(), name.end(), is_allowed)) return "has other characters than letters, digits, _ and -";
    for (const std::string_view layer : common_light_layer_names)
        if (name == layer) return "is that of a layer which every scene has";
    return "";
}

}  // namespace cistula
