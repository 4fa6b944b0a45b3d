// Scene descriptions and targets shared by cases.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scene/description/platonic.h"
#include "scene/description/rotation.h"
#include "verify/case.h"
#include "verify/scenes/generated_scene.h"

namespace cistula::verify {

inline constexpr PlatonicSolid platonic_solids[] = {PlatonicSolid::tetrahedron, PlatonicSolid::cube,
                                                    PlatonicSolid::octahedron, PlatonicSolid::dodecahedron,
                                                    PlatonicSolid::icosahedron};

/// Rotations of what is turned as it comes, or not.
inline const glm::dvec3 turns[] = {{0, 0, 0}, {31, 47, 11}};

/// The form of a solid: its planes, a mesh that keeps its triangles, or a mesh that is compiled into planes.
enum class Shape { planes, triangles, convex_mesh };

inline const char* shape_name(Shape shape) {
    return shape == Shape::planes ? " of planes" : " of triangles";
}

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
inline MaterialDescription paper(const glm::dvec3& color, double reflection = 0) {
    return {.color = color, .reflection = reflection};
}
/// A body that light passes unchanged but for a tint at each face.
inline MaterialDescription clear(const glm::dvec3& tint = glm::dvec3(1)) {
    return {.transmission = 1, .tint = tint};
}
/// A body that transmits all light, or all that Fresnel's equations leave.
inline MaterialDescription glass(double index, bool fresnel = false, const glm::dvec3& absorption = glm::dvec3(0)) {
    return {.transmission = 1, .index = index, .absorption = absorption, .fresnel = fresnel};
}
/// Gives material 0, or the one of this number, a checkerboard of so many periods per unit of uv.
inline void add_checker(SceneDescription& scene, const glm::dvec2& repeat, int material = 0,
                        const std::array<glm::dvec3, 2>& colors = {glm::dvec3(1), glm::dvec3(0)}) {
    scene.materials[size_t(material)].texture = int(scene.textures.size());
    scene.textures.push_back({.name = "checker", .checker = colors, .repeat = repeat});
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
    return {.solid = kind, .center = center, .radius = radius, .rotation = rotation};
}

inline void add_solid(SceneDescription& scene, Shape shape, const SolidObject& solid, int material = 0) {
    if (shape == Shape::planes) return add_object(scene, solid, material);
    TrianglesObject mesh = triangulated_solid(solid);
    mesh.keep_triangles = shape == Shape::triangles;
    add_object(scene, mesh, material);
}

// ---- triangles

/// The quadrilateral of these corners.
inline TrianglesObject quad(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    return {.vertices = {a, b, c, d}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
}
inline TrianglesObject parallelogram(const glm::dvec3& corner, const glm::dvec3& along, const glm::dvec3& across) {
    return quad(corner, corner + along, corner + along + across, corner + across);
}
/// The square [-half, half]^2 at a height; its uv are lengths.
inline TrianglesObject floor_of_half(double half, double height = 0) {
    TrianglesObject floor = parallelogram({-half, -half, height}, {2 * half, 0, 0}, {0, 2 * half, 0});
    for (const glm::dvec3& p : floor.vertices) floor.uvs.emplace_back(p.x, p.y);
    return floor;
}
inline TrianglesObject box(const glm::dvec3& low, const glm::dvec3& high, bool keep_triangles = false) {
    TrianglesObject mesh;
    for (const double z : {low.z, high.z})
        for (const double y : {low.y, high.y})
            for (const double x : {low.x, high.x}) mesh.vertices.push_back({x, y, z});
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    mesh.keep_triangles = keep_triangles;
    return mesh;
}
inline TrianglesObject moved(TrianglesObject mesh, const glm::dvec3& by, const glm::dvec3& scale = glm::dvec3(1)) {
    for (glm::dvec3& p : mesh.vertices) p = by + p * scale;
    return mesh;
}

/// Calls change(point) for all of a scene that has a place: bodies, lights, the camera and its target.
template <class Change>
void for_each_point(SceneDescription& scene, const Change& change) {
    for (ObjectDescription& object : scene.objects) {
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) change(solid->center);
        if (auto* ball = std::get_if<SphereObject>(&object.shape)) change(ball->center);
        if (auto* disk = std::get_if<DiskObject>(&object.shape)) change(disk->center);
        if (auto* mesh = std::get_if<TrianglesObject>(&object.shape))
            for (glm::dvec3& p : mesh->vertices) change(p);
    }
    for (LightDescription& light : scene.lights) change(light.position);
    change(scene.camera.position);
    change(scene.camera.target);
}

// ---- what rays are aimed at

/// The corners of a solid and the points at k/16 of its edges.
inline std::vector<glm::dvec3> edge_points(const SolidObject& solid) {
    const Polyhedron& shape = polyhedron_of(solid);
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
/// setup.h).
inline void add_planes(const SolidObject& solid, const PartFrame& frame, Numbers& numbers) {
    const Polyhedron& shape = polyhedron_of(solid);
    const Rotation rotation(solid.rotation);
    const glm::dvec3 center = frame.point(solid.center);
    for (const auto& face : shape.faces) {
        const glm::dvec3 n = rotation(face.normal);
        const double offset = offset_of(shape, face) * solid.radius * frame.factor;
        numbers.insert(numbers.end(), {n.x, n.y, n.z, dot(n, center) + offset});
    }
}
inline void add_vector(const glm::dvec3& v, Numbers& numbers) {
    numbers.insert(numbers.end(), {v.x, v.y, v.z});
}
/// Four numbers: a point and a length in the frame.
inline auto ball_numbers(const glm::dvec3& middle, double radius) {
    return [=](const PartFrame& frame, Numbers& numbers) {
        add_vector(frame.point(middle), numbers);
        numbers.push_back(radius * frame.factor);
    };
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

/// A scene with a solid at a placement, and the solid's index.
struct PlacedSolid {
    SceneDescription scene;
    SolidObject solid;
    uint32_t number;
    std::string label;
};
inline PlacedSolid placed_solid(SolidObject solid, Shape shape, const Placement& placement,
                                const glm::dvec3& rotation) {
    solid.rotation = rotation;
    PlacedSolid placed{empty_scene(), solid, 0, ""};
    placed.solid.center = placement.center;
    placed.solid.radius = placement.radius;
    if (placement.beside_unit) add_solid(placed.scene, shape, solid);
    placed.number = uint32_t(placed.scene.objects.size());
    add_solid(placed.scene, shape, placed.solid);
    placed.label = polyhedron_of(solid).name + shape_name(shape) + ", " + placement.name +
                   (rotation == glm::dvec3(0) ? "" : ", turned");
    return placed;
}
inline PlacedSolid placed_solid(PlatonicSolid kind, Shape shape, const Placement& placement,
                                const glm::dvec3& rotation) {
    return placed_solid(solid_object(kind), shape, placement, rotation);
}

}  // namespace cistula::verify
