#include "bench/effect_scenes.h"

#include "scene/description/without_effect.h"
#include "scene/readers/read_scene.h"

namespace cistula::bench {

std::vector<EffectScene> effect_scenes(const std::string& folder) {
    const SceneDescription benchmark = read_scene(folder + "/scenes/benchmark.json");

    const SceneDescription mirrors = without_effect(benchmark, effect_transmission).value();
    SceneDescription floor = without_effect(mirrors, effect_reflection).value();
    floor.lights.resize(1);
    const SceneDescription opaque = without_effect(floor, effect_triangles).value();

    SceneDescription edge_lights = benchmark;
    for (ObjectDescription& object : edge_lights.objects)
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) {
            solid->edge_lights.count = 6;
            solid->edge_lights.color = glm::dvec3{0};
            solid->edge_lights.glow = glm::dvec3{1};
            solid->edge_lights.radius = 0.03;
        }

    SceneDescription away = opaque;
    away.camera = CameraDescription();
    away.camera.position = {30, 0, 0};
    away.camera.target = {60, 0, 0};

    std::vector<EffectScene> scenes = {
        {"opaque", opaque, true},           {"opaque_floor", floor}, {"mirrors", mirrors, true},
        {"edge_lights", edge_lights, true}, {"away", away},          {"benchmark", benchmark, true}};
    for (const char* name : {"glass", "infinity", "mesh", "platonic", "seed"})
        scenes.push_back({name, read_scene(folder + "/scenes/" + name + ".json")});
    return scenes;
}

}  // namespace cistula::bench
