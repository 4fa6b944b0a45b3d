// What the numbers of a compiled scene are called in its file, for those who report on it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/description/description.h"

namespace cistula {

struct SceneNames {
    struct Named {
        std::string name;
        std::string place;  // where it stands in the file: "/objects/2"; empty: not in it by itself
    };
    std::vector<Named> solids;       // as CompiledScene::solids
    std::vector<Named> materials;    // as CompiledScene::materials
    std::vector<Named> lights;       // as CompiledScene::lights
    std::vector<Named> seen_lights;  // as CompiledScene::seen_lights
};

/// Opens the meshes that the scene names, as compile_scene does. Throws Error as that.
SceneNames name_scene(const SceneDescription& description);

}  // namespace cistula
