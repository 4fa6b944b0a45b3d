// Bodies of radius 1 on a floor, as they look whatever else is in their scene.
#pragma once

#include <algorithm>

#include "apps/render_verify/case.h"
#include "apps/render_verify/scenes.h"
#include "apps/render_verify/stage.h"
#include "render/record/film_picture.h"

namespace cistula::verify::size {

/// What a view shows beside the body's shadow.
enum class Look { shadow, reflection, mirror, glass, texture };

/// A body over a floor of this half-size, without lights, seen from above at a slant; no horizon is in view.
inline SceneDescription view(Look look, Shape shape, PlatonicSolid kind, double half_size) {
    SceneDescription scene = empty_scene();
    scene.film.width = 48;
    scene.film.height = 36;
    scene.depth = 5;
    scene.ambient = glm::dvec3(0.2);
    scene.background = {0.3, 0.4, 0.55};
    scene.camera.position = {0, -6, 3};
    scene.camera.target = {0, 0, 0.6};
    scene.camera.field_of_view = 50;
    MaterialDescription& floor = scene.materials[0];
    if (look == Look::mirror) floor.reflection = 0.5;
    if (look == Look::texture) {
        TextureDescription checker;
        checker.name = "checker";
        checker.repeat = glm::dvec2(0.5);
        scene.textures.push_back(checker);
        floor.texture = 0;
    }
    MaterialDescription body;
    body.color = {0.8, 0.3, 0.2};
    if (look == Look::reflection) body.reflection = 0.6;
    if (look == Look::glass) {
        body.reflection = 0.1, body.transmission = 0.8, body.index = 1.5;
        // A line that leaves the glass all but level meets a large floor and misses a small one: one color.
        scene.background = scene.ambient * floor.color;
    }
    const int material = add_material(scene, body);
    TrianglesObject quad;
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
        quad.vertices.emplace_back(x * half_size, y * half_size, 0);
        quad.uvs.emplace_back(x * half_size, y * half_size);
    }
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    add_object(scene, quad);
    add_solid(scene, shape, solid_object(kind, {0, 0, 1.2}, 1, {10, 20, 30}), material);
    return scene;
}

inline SceneDescription lamp_lit(Look look, Shape shape, PlatonicSolid kind, double half_size) {
    SceneDescription scene = view(look, shape, kind, half_size);
    add_light(scene, {3, -3, 8});
    return scene;
}

/// Expects that every pixel lies between the least and the largest of the expected ones beside it and its own, give or
/// take 1e-3: borders may move by less than a pixel.
inline void expect_alike(Tally& tally, const Film& found_film, const Film& expected_film) {
    const ColorPicture found = to_color(found_film), expected = to_color(expected_film);
    const int width = int(expected_film.rect.width), height = int(expected_film.rect.height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            bool alike = found_film.flags == 0 && expected_film.flags == 0;
            for (int c = 0; c < 3; ++c) {
                float low = INFINITY, high = -INFINITY;
                for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
                    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
                        const float value = expected.texels[size_t(v * width + u)][c];
                        low = std::min(low, value);
                        high = std::max(high, value);
                    }
                const float value = found.texels[size_t(y * width + x)][c];
                alike = alike && value >= low - 1e-3f && value <= high + 1e-3f;
            }
            tally.place = uint64_t(y * width + x);
            tally.expect(alike);
        }
}

/// Expects scenes to look like the first of them, which is small, but for those that float warns of.
inline void expect_alike(Stage& stage, Tally& tally, const std::vector<SceneDescription>& scenes) {
    Film expected;
    for (const SceneDescription& scene : scenes) {
        if (stage.warns_of(scene)) continue;
        const Film film = stage.render(scene, scene.film.width, scene.film.height);
        if (&scene == &scenes.front())
            expected = film;
        else
            expect_alike(tally, film, expected);
    }
}

}  // namespace cistula::verify::size
