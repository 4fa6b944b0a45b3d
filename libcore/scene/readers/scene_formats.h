// The formats of scenes, JSON and the text input (docs/scene.md), and what else a file may be. Private: use
// read_scene.h.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>

#include "scene/description/description.h"

namespace cistula {

class JsonObject;
class JsonValue;

/// Parses a JSON scene. Throws Error (usage) with `label` and the JSON pointer, or line and column. Does not set
/// `source`.
SceneDescription read_json_scene(const std::string& text, const std::string& label, const std::string& base_dir);

/// Reads the key "group" of lights. Throws Error (usage) if layers cannot be named so.
void read_light_group(JsonObject& keys, std::string& group);

/// Path of `file`, which is named in a scene in folder `base_dir`.
std::string file_beside_scene(const std::string& file, const std::string& base_dir);

/// The parts of a scene that its objects refer to.
struct ObjectContext {
    const SceneDescription& scene;                          // its materials are complete
    const std::unordered_map<std::string, int>& materials;  // indices by name
    const std::string& base_dir;
};

/// Reads one element of "objects".
ObjectDescription read_json_object(const JsonValue& value, const ObjectContext& context);

/// Index of the name that `value` holds. Throws Error (usage) with the nearest known name; `kind` is "material" or
/// "texture".
int index_of_name(const JsonValue& value, const std::unordered_map<std::string, int>& indices, const std::string& kind);

/// Parses the text input, in either order of its parts. Throws Error (usage): "label:line: expected ..., found ...".
/// Does not set `source`.
SceneDescription read_text_input(const std::string& text, const std::string& label, const std::string& base_dir);

/// A valid, colorful input in the text input's format; it describes the same scene as scenes/seed.json.
std::string text_input_template();

/// "is a PNG picture; ...", with what is wanted, for the start of a file without its byte order mark; empty where it is
/// none of the formats that are known here. Some hundred bytes are enough.
std::string no_scene_because(std::string_view start);

}  // namespace cistula
