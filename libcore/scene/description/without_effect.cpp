#include "scene/description/without_effect.h"

namespace cistula {
namespace {

void take_from(MaterialDescription& m, uint32_t effect) {
    if (effect == effect_texture) m.texture = -1;
    if (effect == effect_diffuse) m.diffuse = 0;
    if (effect == effect_specular) m.specular = 0;
    if (effect == effect_reflection) m.reflection = 0;
    if (effect == effect_transmission || effect == effect_insides) m.transmission = 0;
    // Fresnel's terms would bring either share back.
    if ((effect & (effect_reflection | effect_transmission | effect_insides | effect_fresnel)) != 0) m.fresnel = false;
    if (effect == effect_refraction) m.index = 1;
    if (effect == effect_absorption) m.absorption = glm::dvec3{0};
    if (effect == effect_tint) m.tint = glm::dvec3{1};
}

/// Hides a light, or removes its falloff.
template <class Light>
void take_from_light(Light& light, uint32_t effect) {
    if (effect == effect_visible_lights) light.visible = false;
    if (effect == effect_light_falloff) light.falloff = false;
}

/// Makes a mesh triangles, if the shape is one.
void keep_triangles(ObjectDescription& object) {
    if (auto* mesh = std::get_if<MeshObject>(&object.shape)) mesh->keep_triangles = true;
    if (auto* list = std::get_if<TrianglesObject>(&object.shape)) list->keep_triangles = true;
}

/// Makes a mesh flat, if the shape is one.
void flatten(ObjectDescription& object) {
    if (auto* mesh = std::get_if<MeshObject>(&object.shape)) mesh->smooth = 0;
    if (auto* list = std::get_if<TrianglesObject>(&object.shape)) list->smooth = 0;
}

/// Makes the lights give no light, so that they are only visible.
void put_out(EdgeLights& lights) {
    lights.glow = lights.glow.value_or(lights.color);
    lights.color = glm::dvec3{0};
}

}  // namespace

std::optional<SceneDescription> without_effect(const SceneDescription& scene, uint32_t effect) {
    if ((effect & (effect_opaque_shadows | effect_transparent_shadows)) != 0) return std::nullopt;
    SceneDescription less = scene;
    less.motion = nullptr;  // which goes by the numbers of all objects
    if (effect == effect_sky) less.sky.reset();
    for (MaterialDescription& material : less.materials) take_from(material, effect);
    for (LightDescription& light : less.lights) take_from_light(light, effect);
    for (ObjectDescription& object : less.objects) {
        if (effect == effect_solids) keep_triangles(object);
        if (effect == effect_smooth) flatten(object);
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) {
            take_from_light(solid->edge_lights, effect);
            if (effect == effect_lights_on_faces) put_out(solid->edge_lights);
        }
    }
    std::erase_if(less.objects, [&](const ObjectDescription& object) {
        if (std::holds_alternative<SphereObject>(object.shape)) return effect == effect_spheres;
        if (std::holds_alternative<DiskObject>(object.shape)) return effect == effect_planes;
        const bool convex = std::holds_alternative<SolidObject>(object.shape);
        return effect == (convex ? effect_solids : effect_triangles);
    });
    if (less.objects.empty() && !scene.objects.empty()) return std::nullopt;
    return less;
}

}  // namespace cistula
