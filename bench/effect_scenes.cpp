#include "bench/effect_scenes.h"

#include "scene/read_scene.h"

namespace cistula::bench {

std::vector<EffectScene> effect_scenes(const std::string& folder) {
    const SceneDescription benchmark = read_scene(folder + "/scenes/benchmark.json");

    SceneDescription floor = benchmark;
    for (MaterialDescription& material : floor.materials) material.reflection = material.transmission = 0;
    floor.lights.resize(1);
    SceneDescription opaque = floor;
    std::erase_if(opaque.objects, [](const ObjectDescription& o) { return !std::holds_alternative<SolidObject>(o.shape); });

    SceneDescription mirrors = benchmark;
    for (MaterialDescription& material : mirrors.materials) material.transmission = 0;

    SceneDescription edge_lights = benchmark;
    for (ObjectDescription& object : edge_lights.objects)
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) {
            solid->edge_lights.count = 6;
            solid->edge_lights.color = glm::dvec3{0};
            solid->edge_lights.glow = glm::dvec3{1};
            solid->edge_lights.radius = 0.03;
        }

    std::vector<EffectScene> scenes = {{"opaque", opaque}, {"opaque_floor", floor}, {"mirrors", mirrors}, {"edge_lights", edge_lights}};
    for (const char* name : {"benchmark", "glass", "infinity", "mesh", "platonic", "seed"})
        scenes.push_back({name, read_scene(folder + "/scenes/" + name + ".json")});
    return scenes;
}

}  // namespace cistula::bench
