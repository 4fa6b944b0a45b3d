// What the targets of scenes share.
#pragma once

#include <algorithm>
#include <variant>

#include "checks.h"
#include "scene/compile/compiled_scene.h"
#include "scene/description/camera_path.h"

namespace cistula::fuzz {

/// Whether a scene opens no files and is small enough to be compiled in no time.
inline bool is_small(const SceneDescription& scene) {
    size_t parts = scene.lights.size();
    for (const ObjectDescription& object : scene.objects) {
        if (std::holds_alternative<MeshObject>(object.shape)) return false;
        ++parts;
        if (const auto* solid = std::get_if<SolidObject>(&object.shape))
            parts += 30 * static_cast<size_t>(solid->edge_lights.count);
        if (const auto* list = std::get_if<TrianglesObject>(&object.shape)) parts += list->triangles.size();
    }
    const auto is_file = [](const TextureDescription& texture) { return !texture.file.empty(); };
    return parts < 500 && std::none_of(scene.textures.begin(), scene.textures.end(), is_file);
}

/// Looks at cameras of a scene that was read, and compiles it. What is wrong with it is an Error (usage).
inline void check_scene(const SceneDescription& scene) {
    for (const int frame : {0, 1, scene.film.frames - 1, 9'999'999}) camera_at(scene.camera, frame);
    if (const std::string turns = camera_turns(scene.camera, {0, 1, 2, 7, 8}); !turns.empty()) one_line(turns);
    if (!is_small(scene)) return;
    const auto compiled = compile_scene<double>(scene);
    for (const std::string& warning : compiled->warnings) one_line(warning);
    compile_scene<float>(scene);
}

}  // namespace cistula::fuzz
