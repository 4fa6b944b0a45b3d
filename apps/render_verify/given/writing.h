// Scenes as people write them: turned, moved, of any size, with few digits, in any order, wound as it comes.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "apps/render_verify/contact/compare.h"
#include "scene/description/camera_path.h"
#include "testing/draw/draw.h"

namespace cistula::verify::given {

using contact::place_of_scene;
using glm::dvec3;
using parity::Draw;

inline constexpr int all_digits = 17, digits_of_float = 0;

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

// ---- triangles

inline TrianglesObject box(const dvec3& low, const dvec3& high, bool keep_triangles = false) {
    TrianglesObject mesh;
    for (const double z : {low.z, high.z})
        for (const double y : {low.y, high.y})
            for (const double x : {low.x, high.x}) mesh.vertices.push_back({x, y, z});
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    mesh.keep_triangles = keep_triangles;
    return mesh;
}
inline TrianglesObject parallelogram(const dvec3& corner, const dvec3& along, const dvec3& across) {
    TrianglesObject mesh;
    mesh.vertices = {corner, corner + along, corner + along + across, corner + across};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
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
/// What lies on a floor, or is one.
inline MaterialDescription stone(const dvec3& color, double reflection = 0) {
    MaterialDescription material = contact::paper(color);
    material.reflection = reflection;
    return material;
}

/// Expects a scene's film to be another's, but for borders that are up to a pixel apart.
inline void expect_same_picture(const Stage& stage, Tally& tally, const SceneDescription& scene, const Film& expected,
                                uint64_t number) {
    contact::expect_one_of(tally, contact::film_of(stage, scene), {&expected}, place_of_scene(number));
}
inline void expect_same_picture(const Stage& stage, Tally& tally, const SceneDescription& scene,
                                const SceneDescription& expected, uint64_t number) {
    expect_same_picture(stage, tally, scene, contact::film_of(stage, expected), number);
}

/// The mean radiance of a pixel, with all digits of its sums.
inline double radiance(const Film& film, size_t pixel, int channel = 0) {
    return film.flags == 0 ? double(film.pixels[pixel].radiance[channel]) * film.unit() : INFINITY;
}
/// Calls take(pixel, direction) for each pixel of a film, with the direction of the ray through its middle in the scene
/// before it was written.
template <class Take>
void for_each_pixel(const Film& film, const SceneDescription& unwritten, const Take& take) {
    const Camera camera = camera_at(unwritten.camera, 0).camera;
    const int width = int(film.rect.width), height = int(film.rect.height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            take(size_t(y * width + x), camera_direction(camera, x + 0.5, y + 0.5, width, height));
}

/// The number of scenes that are drawn.
inline uint64_t scenes(const Stage& stage, uint64_t in_full = 8, uint64_t in_quick = 2) {
    return stage.quick ? in_quick : in_full;
}

}  // namespace cistula::verify::given
