// Scenes whose ray trees are endless for a test: lossless solids among mirrors.
#pragma once

#include <string>

#include "render/renderer.h"
#include "scene/readers/read_scene.h"

namespace cistula::test {

/// Octahedra in a tetrahedron of mirrors: every hit splits a branch in two. Few enough for a GPU's plain loop.
inline constexpr const char* room_of_mirrors_text = R"({
    "film": {"width": 96, "height": 54}, "depth": 2, "ambient": 1, "background": 1,
    "camera": {"position": [0.4, -1.8, 0.3], "target": [0, 0, 0], "fov": 60},
    "materials": {"clear": {"color": 1, "ambient": 1, "diffuse": 0, "reflection": 0.5, "transmission": 0.5},
                  "mirror": {"color": 1, "ambient": 1, "diffuse": 0, "reflection": 1}},
    "objects": [
        {"name": "left", "solid": "octahedron", "center": [-0.9, 0.2, 0.1], "radius": 0.8, "material": "clear"},
        {"name": "right", "solid": "octahedron", "center": [0.9, 0.2, -0.2], "radius": 0.8, "material": "clear"},
        {"name": "wall 1", "quad": [[7, -3, -7], [-3, 7, -7], [-9, 1, 5], [1, -9, 5]], "material": "mirror"},
        {"name": "wall 2", "quad": [[-7, 3, -7], [3, -7, -7], [9, -1, 5], [-1, 9, 5]], "material": "mirror"},
        {"name": "wall 3", "quad": [[-7, -3, 7], [3, 7, 7], [9, 1, -5], [-1, -9, -5]], "material": "mirror"},
        {"name": "wall 4", "quad": [[7, 3, 7], [-3, -7, 7], [-9, -1, -5], [1, 9, -5]], "material": "mirror"}]
})";
inline SceneDescription room_of_mirrors() {
    return read_scene_text(room_of_mirrors_text, "room.json", "");
}

/// Settings for an endless scene: nothing is pruned.
inline FrameSettings endless_settings(int width, int height) {
    FrameSettings settings;
    settings.set_size(width, height);
    settings.depth = 256;
    return settings;
}

}  // namespace cistula::test
