#include "scene/compile/scene_names.h"

#include "scene/description/platonic.h"

namespace cistula {
namespace {

bool shines(const glm::dvec3& color) {
    return color.x > 0 || color.y > 0 || color.z > 0;
}

void add_light(SceneNames& names, const std::string& name, const std::string& place, const glm::dvec3& color,
               bool shown) {
    if (shines(color)) names.lights.push_back({name, place});
    if (shown) names.visible_lights.push_back({name, place});
}

}  // namespace

SceneNames name_scene(const SceneSource& source) {
    const SceneDescription& description = *source.description;
    SceneNames names;
    for (const SourceSolid& solid : source.solids) names.solids.push_back({name_of(solid), solid.place});
    for (const MaterialDescription& material : source.materials) names.materials.push_back({material.name, ""});
    // Lights in the order of normalize_lights.
    for (size_t i = 0; i < description.lights.size(); ++i) {
        const LightDescription& light = description.lights[i];
        add_light(names, "light " + std::to_string(i), light.place, light.color, light.shown());
    }
    for (const SourceSolid& solid : source.solids) {
        if (!solid.polyhedron) continue;
        const EdgeLights& on_edges = solid.polyhedron->edge_lights;
        const size_t edges = polyhedron_of(*solid.polyhedron).edges.size();
        for (size_t edge = 0; edge < edges; ++edge)
            for (int i = 0; i < on_edges.count; ++i)
                add_light(names, name_of(solid) + " edge " + std::to_string(edge) + " light " + std::to_string(i),
                          solid.place, on_edges.color, on_edges.shown());
    }
    return names;
}

}  // namespace cistula
