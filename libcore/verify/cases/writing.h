// Scenes as people write them: turned, moved, of any size, with few digits, wound as it comes.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "verify/cases/pictures.h"
#include "verify/cases/scenes.h"
#include "verify/draw.h"

namespace cistula::verify {

using glm::dvec3;
inline constexpr int all_digits = 17;
inline constexpr int digits_of_float = 0;

/// A number as a file gives it, with so many significant digits.
inline double rounded(double number, int digits) {
    if (digits == digits_of_float) return double(float(number));
    char text[40];
    std::snprintf(text, sizeof(text), "%.*g", digits, number);
    return digits == all_digits ? number : std::strtod(text, nullptr);
}

/// How a scene is written: turned by Rotation(degrees), made `size` as large, then moved.
struct Writing {
    dvec3 degrees{0}, origin{0};
    double size = 1;
    int digits = all_digits;   // of what objects are made of
    bool rounds_rest = false;  // lights and the camera's position have as many

    dvec3 direction(const dvec3& d) const { return Rotation(degrees)(d); }
    dvec3 place(const dvec3& p) const { return origin + direction(p) * size; }
    dvec3 point(const dvec3& p, bool rounds = true) const {
        dvec3 at = place(p);
        for (int k = 0; k < 3; ++k) at[k] = rounds ? rounded(at[k], digits) : at[k];
        return at;
    }
};

/// A writing turned at random and moved by up to `reach`, its size within `times` of 1.
inline Writing random_writing(Draw& draw, double reach, double times = 1) {
    Writing writing;
    writing.degrees = draw.in_cube<double>(180);
    writing.origin = draw.in_cube<double>(reach);
    writing.size = std::pow(times, draw.centered<double>(1));
    return writing;
}

/// A scene of triangles and of lights without falloff, written so.
inline SceneDescription written(SceneDescription scene, const Writing& writing) {
    for (ObjectDescription& object : scene.objects)
        for (dvec3& vertex : std::get<TrianglesObject>(object.shape).vertices) vertex = writing.point(vertex);
    for (LightDescription& light : scene.lights) light.position = writing.point(light.position, writing.rounds_rest);
    for (MaterialDescription& material : scene.materials) material.absorption /= writing.size;
    scene.camera.position = writing.point(scene.camera.position, writing.rounds_rest);
    scene.camera.target = writing.place(scene.camera.target);
    scene.camera.up = writing.direction(scene.camera.up);
    return scene;
}

/// The faces of a box, each a sheet of its own.
inline std::vector<TrianglesObject> sheets_of_box(const TrianglesObject& box) {
    std::vector<TrianglesObject> sheets;
    for (size_t i = 0; i < box.triangles.size(); i += 2) {
        const auto &first = box.triangles[i], &second = box.triangles[i + 1];
        TrianglesObject sheet;
        for (const uint32_t v : {first[0], first[1], first[2], second[2]}) sheet.vertices.push_back(box.vertices[v]);
        sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
        sheets.push_back(std::move(sheet));
    }
    return sheets;
}
inline void turn_inside_out(TrianglesObject& mesh) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}
/// Turns each triangle or none, each as it comes.
inline void wind_at_random(TrianglesObject& mesh, Draw& draw) {
    for (auto& triangle : mesh.triangles)
        if (draw.one_in(2)) std::swap(triangle[1], triangle[2]);
}
/// One mesh of several, their vertices apart.
inline TrianglesObject joined(const std::vector<TrianglesObject>& pieces) {
    TrianglesObject mesh;
    for (const TrianglesObject& piece : pieces) {
        const auto first = uint32_t(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), piece.vertices.begin(), piece.vertices.end());
        for (const auto& t : piece.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        mesh.keep_triangles = mesh.keep_triangles || piece.keep_triangles;
    }
    return mesh;
}

// ---- views

/// A scene without objects in ambient light and that of one lamp, seen at (0, 0, 0.4) from above.
inline SceneDescription lit_scene() {
    SceneDescription scene = empty_scene();
    scene.film.width = 24, scene.film.height = 18;
    scene.depth = 8;
    scene.ambient = {0.3, 0.35, 0.4};
    scene.background = {0.2, 0.5, 0.8};
    scene.camera.position = {2, -4.6, 2.7};
    scene.camera.target = {0.07, 0.03, 0.4};
    scene.camera.field_of_view = 38;
    add_light(scene, {-3, -4, 5}).color = dvec3(0.6);
    return scene;
}
/// The number of scenes that are drawn.
inline uint64_t scenes(const Stage& stage, uint64_t in_full = 8, uint64_t in_quick = 2) {
    return stage.quick ? in_quick : in_full;
}

}  // namespace cistula::verify
