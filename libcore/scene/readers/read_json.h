// The JSON scene format (docs/scene.md). Use read_scene.h.
#pragma once

#include <string>
#include <unordered_map>

#include "scene/description/description.h"

namespace cistula {

class JsonValue;

/// Throws Error (usage) with `label` and the JSON place, or line and column. Does not set `source`.
SceneDescription read_json_scene(const std::string& text, const std::string& label, const std::string& base_dir);

/// `file` as it is named in a scene that lies in `base_dir`.
std::string file_beside_scene(const std::string& file, const std::string& base_dir);

/// What objects refer to.
struct ObjectContext {
    const SceneDescription& scene;                          // its materials are complete
    const std::unordered_map<std::string, int>& materials;  // indices by name
    const std::string& base_dir;
};

/// One element of "objects".
ObjectDescription read_json_object(const JsonValue& value, const ObjectContext& context);

/// Index of the name that `value` holds, or an error that names the nearest; `kind` is "material" or "texture".
int index_of_name(const JsonValue& value, const std::unordered_map<std::string, int>& indices, const std::string& kind);

}  // namespace cistula
