// A scene of Cistula's as the course work's algorithm takes it, all of it triangles.
#pragma once

#include "bench/seed_baseline.h"
#include "scene/compile/scene_normalization.h"
#include "scene/compile/scene_source.h"
#include "scene/description/camera_path.h"
#include "scene/description/platonic.h"

namespace cistula::seed {

inline Vec vec(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// What the description of the course work does not have, or what no figure needs: it would cost the baseline time.
inline void check(const SceneDescription& scene, const SceneSource& source) {
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::usage, scene.source + ": is more than the baseline renders: " + what);
    };
    for (const MaterialDescription& m : source.materials) {
        if (m.fresnel || m.absorption != glm::dvec3(0) || m.tint != glm::dvec3(1) || m.specular_color != glm::dvec3(1))
            refuse("material " + m.name + " must have white tint and highlights, no absorption and no fresnel");
    }
    for (const LightDescription& light : scene.lights)
        if (light.falloff || light.radius > 0) refuse("a light falls off or is seen; it must do neither");
    for (const SourceSolid& solid : source.solids)
        if (solid.polyhedron && solid.polyhedron->edge_lights.count > 0) refuse("a solid has lights on its edges");
}

inline Material material_of(const SceneDescription& scene, const MaterialDescription& m, OwnedScene& owned) {
    Material material{vec(m.color),
                      vec(m.ambient * scene.ambient),
                      m.diffuse,
                      m.specular,
                      m.exponent,
                      m.reflection,
                      m.transmission,
                      m.index,
                      0,
                      0,
                      0};
    if (m.texture < 0) return material;
    const TextureDescription& texture = scene.textures[static_cast<size_t>(m.texture)];
    material.texture_width = material.texture_height = 2;
    material.first_texel = static_cast<int>(owned.texels.size());
    for (const int cell : {0, 1, 1, 0}) owned.texels.push_back(vec(texture.checker[static_cast<size_t>(cell)]));
    return material;
}

inline void append_triangles(const SceneDescription& scene, const MeshSource& mesh, int material,
                             const MaterialDescription& m, OwnedScene& owned) {
    for (const auto& t : mesh.triangles) {
        const glm::dvec3& corner = mesh.vertices[t[0]];
        Triangle triangle{vec(corner), vec(mesh.vertices[t[1]] - corner), vec(mesh.vertices[t[2]] - corner), {},
                          material,    static_cast<int>(owned.uvs.size())};
        triangle.normal = normalized(cross(triangle.ab, triangle.ac));
        owned.triangles.push_back(triangle);
        if (m.texture < 0) continue;
        for (const uint32_t c : t) {
            const glm::dvec2 uv =
                mesh.uvs.empty() ? glm::dvec2(0) : mesh.uvs[c] * scene.textures[static_cast<size_t>(m.texture)].repeat;
            owned.uvs.push_back({uv.x, uv.y});
        }
    }
}

/// Throws Error (usage) for what the course work's algorithm does not do.
inline OwnedScene make_scene(const SceneDescription& scene) {
    for (const TextureDescription& texture : scene.textures)
        if (!texture.file.empty() || texture.texels)
            throw Error(ErrorKind::usage,
                        scene.source + ": is more than the baseline renders: textures must be checkers");
    const SceneSource source = gather_scene(scene);
    check(scene, source);
    OwnedScene owned;
    owned.background = vec(scene.background);
    for (const MaterialDescription& m : source.materials) owned.materials.push_back(material_of(scene, m, owned));
    for (const SourceSolid& solid : source.solids) {
        MeshSource made;
        if (solid.polyhedron) {
            made.owned_vertices = world_vertices(*solid.polyhedron);
            made.owned_triangles = triangulated(polyhedron_of(*solid.polyhedron));
            made.view_owned();
        }
        append_triangles(scene, solid.polyhedron ? made : solid.mesh, static_cast<int>(solid.material),
                         source.materials[solid.material], owned);
    }
    for (const LightDescription& light : scene.lights)
        if (light.color != glm::dvec3(0)) owned.lights.push_back({vec(light.position), vec(light.color)});
    return owned;
}

inline View make_view(const CameraFrame& frame, int width, int height) {
    const Camera& camera = frame.camera;
    return {vec(camera.position),
            vec(camera.forward),
            vec(camera.right * camera.tan_half_width),
            vec(camera.up * camera.tan_half_width),
            width,
            height};
}

}  // namespace cistula::seed
