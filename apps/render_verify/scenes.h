// Scene descriptions and targets shared by cases.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "apps/render_verify/plan.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "testing/generated_mesh.h"

namespace cistula::verify {

inline constexpr PlatonicSolid platonic_solids[] = {PlatonicSolid::tetrahedron, PlatonicSolid::cube,
                                                    PlatonicSolid::octahedron, PlatonicSolid::dodecahedron,
                                                    PlatonicSolid::icosahedron};

/// The form of a solid: its planes, a mesh that keeps its triangles, or a mesh that is compiled into planes.
enum class Shape { planes, triangles, convex_mesh };

/// A description with one material, no objects, no lights.
inline SceneDescription empty_scene() {
    SceneDescription scene;
    scene.source = "verify";
    MaterialDescription material;
    material.name = "plain";
    scene.materials.push_back(material);
    return scene;
}

/// Adds a material and returns its index.
inline int add_material(SceneDescription& scene, const MaterialDescription& material) {
    scene.materials.push_back(material);
    scene.materials.back().name = "m" + std::to_string(scene.materials.size());
    return int(scene.materials.size()) - 1;
}

template <class Object>
void add_object(SceneDescription& scene, const Object& shape, int material = 0) {
    ObjectDescription object;
    object.name = "o" + std::to_string(scene.objects.size());
    object.place = "/objects/" + std::to_string(scene.objects.size());
    object.material = material;
    object.shape = shape;
    scene.objects.push_back(std::move(object));
}

inline LightDescription& add_light(SceneDescription& scene, const glm::dvec3& position) {
    LightDescription light;
    light.position = position;
    light.place = "/lights/" + std::to_string(scene.lights.size());
    scene.lights.push_back(light);
    return scene.lights.back();
}

inline SolidObject solid_object(PlatonicSolid kind, const glm::dvec3& center = glm::dvec3(0), double radius = 1,
                                const glm::dvec3& rotation = glm::dvec3(0)) {
    SolidObject solid;
    solid.solid = kind;
    solid.center = center;
    solid.radius = radius;
    solid.rotation = rotation;
    return solid;
}

inline void add_solid(SceneDescription& scene, Shape shape, const SolidObject& solid, int material = 0) {
    if (shape == Shape::planes) return add_object(scene, solid, material);
    TrianglesObject mesh = triangulated_solid(solid);
    mesh.keep_triangles = shape == Shape::triangles;
    add_object(scene, mesh, material);
}

/// The corners of a solid and the points at k/16 of its edges.
inline std::vector<glm::dvec3> edge_points(const SolidObject& solid) {
    const PlatonicShape& shape = platonic_shape(solid.solid);
    const std::vector<glm::dvec3> corners = triangulated_solid(solid).vertices;
    std::vector<glm::dvec3> points = corners;
    for (const auto& edge : shape.edges)
        for (int k = 1; k < 16; ++k) {
            const glm::dvec3 &a = corners[edge.vertices[0]], &b = corners[edge.vertices[1]];
            points.push_back(a + (b - a) * (k / 16.0));
        }
    return points;
}

/// Appends outward unit normals and distances of a solid's faces in the frame, four numbers each (chord in
/// crossings.h).
inline void add_planes(const SolidObject& solid, const glm::dvec3& frame_center, double factor,
                       std::vector<double>& numbers) {
    const PlatonicShape& shape = platonic_shape(solid.solid);
    const Rotation rotation(solid.rotation);
    const glm::dvec3 center = (solid.center - frame_center) * factor;
    for (const auto& face : shape.faces) {
        const glm::dvec3 n = rotation(face.normal);
        numbers.insert(numbers.end(), {n.x, n.y, n.z, dot(n, center) + shape.inradius * solid.radius * factor});
    }
}

/// Position, size and neighbors of a test solid.
struct Placement {
    const char* name;
    glm::dvec3 center;
    double radius;
    bool beside_unit;  // a solid of radius 1 lies 1.5 to its side, first in the file
};

/// The placements, at all scales at which geometry is tested.
inline std::vector<Placement> placements() {
    return {{"scale 1", {0, 0, 0}, 1, false},
            {"scale 1 at 1e6", {1e6, -1e6, 1e6}, 1, false},
            {"scale 1e-6", {3e-6, -2e-6, 5e-6}, 1e-6, false},
            {"scale 2^40", {0, 0, 0}, 0x1p40, false},
            {"scale 2^-40", {0, 0, 0}, 0x1p-40, false},
            {"2^-20 beside a unit one", {1.5, 0.25, -0.125}, 0x1p-20, true}};
}

/// A scene with a Platonic solid at a placement, and the solid's index.
struct PlacedSolid {
    SceneDescription scene;
    SolidObject solid;
    uint32_t number;
    std::string label;
};
inline PlacedSolid placed_solid(PlatonicSolid kind, Shape shape, const Placement& placement,
                                const glm::dvec3& rotation) {
    PlacedSolid placed{empty_scene(), solid_object(kind, placement.center, placement.radius, rotation), 0, ""};
    if (placement.beside_unit) add_solid(placed.scene, shape, solid_object(kind, glm::dvec3(0), 1, rotation));
    placed.number = uint32_t(placed.scene.objects.size());
    add_solid(placed.scene, shape, placed.solid);
    placed.label = std::string(platonic_name(kind)) + (shape == Shape::planes ? " of planes, " : " of triangles, ") +
                   placement.name + (rotation == glm::dvec3(0) ? "" : ", turned");
    return placed;
}

}  // namespace cistula::verify
