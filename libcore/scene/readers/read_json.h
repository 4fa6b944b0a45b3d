// The JSON scene format (docs/scene.md). Private: use read_scene.h.
#pragma once

#include <string>
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

}  // namespace cistula
