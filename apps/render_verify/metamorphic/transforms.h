// Scenes in other units and at other positions: the frame of reference makes the numbers, and the image, the same.
#pragma once

#include <string>

#include "apps/render_verify/metamorphic/films.h"
#include "scene/compile/compiled_scene.h"

namespace cistula::verify::metamorphic {

/// Multiplies all lengths by 2^k and the intensities of lights with falloff by 4^k.
inline void scale_scene(SceneDescription& scene, int k) {
    const double s = std::ldexp(1.0, k);
    for (ObjectDescription& object : scene.objects) {
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) {
            solid->center *= s;
            solid->radius *= s;
            EdgeLights& lights = solid->edge_lights;
            lights.radius *= s;
            if (!lights.falloff) continue;
            lights.glow = lights.glow.value_or(lights.color);
            lights.color *= s * s;
        } else if (auto* triangles = std::get_if<TrianglesObject>(&object.shape)) {
            for (glm::dvec3& p : triangles->vertices) p *= s;
        }
    }
    for (LightDescription& light : scene.lights) {
        light.position *= s;
        light.radius *= s;
        if (!light.falloff) continue;
        light.glow = light.glow.value_or(light.color);
        light.color *= s * s;
    }
    for (MaterialDescription& m : scene.materials) m.absorption /= s;
    scene.camera.position *= s;
    scene.camera.target *= s;
    for (auto* path : {&scene.camera.position_path, &scene.camera.target_path})
        if (*path)
            for (double* length : {&(*path)->r0, &(*path)->z0, &(*path)->Ar, &(*path)->Az}) *length *= s;
    if (!scene.frame) return;
    scene.frame->center *= s;
    scene.frame->scale -= k;
}

struct PowersOfTwo {
    static constexpr const char* name = "metamorphic/scaled-by-powers-of-two";
    static constexpr const char* exact = "sums, ids and normals at 2^-40 to 2^40 times the size; Z times 2^k";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        const int step = stage.quick ? 20 : 4;
        for (uint64_t seed = 0, left = stage.quick ? 16 : 100; seed < generated_scene_count && left > 0; ++seed) {
            const SceneDescription scene = small_scene(seed);
            if (stage.quick && is_heavy(scene)) continue;
            --left;
            const Film expected = stage.render(scene, generated_settings(scene));
            tally.witness(shows_something(expected));
            for (int k = -40; k <= 40; k += step) {
                SceneDescription scaled = scene;
                scale_scene(scaled, k == 0 ? 1 : k);  // 2^1 in the place of 2^0
                const Film found = stage.render(scaled, generated_settings(scaled));
                expect_same(tally, found, expected, seed, uint64_t(k + 40), std::ldexp(1.0f, k == 0 ? 1 : k));
            }
        }
    }
};

/// Coordinates become multiples of 2^-20 of the scene's size, so that adding multiples of that, of up to 2^32 times it,
/// is exact in double; the frame is pinned, since corners of solids that are turned are not such multiples.
inline void put_on_grid(SceneDescription& scene) {
    const auto compiled = compile_scene<double>(scene);
    const double size = std::ldexp(1.0, -compiled->scale), step = size * 0x1p-20;
    const auto snap = [&](glm::dvec3& p) {
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::floor(p[axis] / step + 0.5) * step;
    };
    fix_camera(scene, size);
    snap(scene.camera.position);
    snap(scene.camera.target);
    for (ObjectDescription& object : scene.objects) {
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) snap(solid->center);
        if (auto* triangles = std::get_if<TrianglesObject>(&object.shape))
            for (glm::dvec3& p : triangles->vertices) snap(p);
    }
    for (LightDescription& light : scene.lights) snap(light.position);
    scene.frame = FrameOfReference();
    scene.frame->center = compiled->center;
    snap(scene.frame->center);
    scene.frame->scale = compiled->scale - 1;
}

/// Adds a sheet below everything else, which reaches farthest.
inline void add_ground(SceneDescription& scene, double reach) {
    const glm::dvec3& c = scene.frame->center;
    add_object(scene,
               sheet({c + glm::dvec3(-reach, -reach, -reach), c + glm::dvec3(reach, -reach, -reach),
                      c + glm::dvec3(reach, reach, -reach), c + glm::dvec3(-reach, reach, -reach)}),
               add_material(scene, MaterialDescription()));
}

inline void translate_scene(SceneDescription& scene, const glm::dvec3& by) {
    for (ObjectDescription& object : scene.objects) {
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) solid->center += by;
        if (auto* triangles = std::get_if<TrianglesObject>(&object.shape))
            for (glm::dvec3& p : triangles->vertices) p += by;
    }
    for (LightDescription& light : scene.lights) light.position += by;
    scene.camera.position += by;
    scene.camera.target += by;
    if (scene.frame) scene.frame->center += by;
}

/// Scenes on the grid and their displacements: by their size, and far away.
template <class Compare>
void translate_scenes(Stage& stage, Tally& tally, bool with_ground, const Compare& compare) {
    for (uint64_t seed = 0, left = stage.quick ? 24 : 150; seed < generated_scene_count && left > 0; ++seed) {
        SceneDescription scene = small_scene(seed);
        if (stage.quick && is_heavy(scene)) continue;
        --left;
        put_on_grid(scene);
        const double size = std::ldexp(1.0, -scene.frame->scale);
        if (with_ground) add_ground(scene, 1.75 * size);
        scene.contact = 0x1p-16 * size;  // not what the digits of a place say
        const Film expected = stage.render(scene, generated_settings(scene));
        tally.witness(shows_something(expected));
        uint64_t variation = 0;
        for (const glm::dvec3& by : {glm::dvec3(0x1p-19, -1, 0x1p10), glm::dvec3(-0x1p20, 0x1.8p15, 0x1p-18),
                                     glm::dvec3(0x1.4p30, 0x1p30, -0x1.8p29)}) {
            SceneDescription moved = scene;
            translate_scene(moved, by * size);
            compare(stage.render(moved, generated_settings(moved)), expected, seed, variation++);
        }
    }
}

struct DyadicTranslation {
    static constexpr const char* name = "metamorphic/dyadic-translation";
    static constexpr const char* exact = "hits and ids after an exact translation of up to 2^30 sizes";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        translate_scenes(stage, tally, false, [&](const Film& found, const Film& expected, uint64_t seed, uint64_t n) {
            expect_same_hits(tally, found, expected, seed, n);
        });
    }
};

/// M is the largest coordinate in world units, where corners of turned solids are rounded; where a corner on the grid
/// is the largest, nothing at all depends on the place.
struct TranslatedImages {
    static constexpr const char* name = "metamorphic/dyadic-translation/images";
    static constexpr const char* exact = "sums, ids, normals and Z, where M is that of a corner on the grid";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        translate_scenes(stage, tally, true, [&](const Film& found, const Film& expected, uint64_t seed, uint64_t n) {
            expect_same(tally, found, expected, seed, n);
        });
    }
};

/// Tests the frame's computed center: that of corners on a grid moves with them.
struct FoundCenter {
    static constexpr const char* name = "metamorphic/dyadic-translation/meshes";
    static constexpr const char* exact = "sums, ids, normals and Z of meshes, whose frame is found where they are";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        SceneDescription scene = empty_scene();
        scene.materials[0].transmission = 0.6;
        scene.materials[0].reflection = 0.2;
        scene.materials[0].index = 1.5;
        add_object(scene, torus(1.5, 0.5, 12, 8));
        add_object(scene, star(0.5));
        add_light(scene, {3, -4, 5});
        scene.camera.position = {1, -4, 2};
        for (ObjectDescription& object : scene.objects)
            for (glm::dvec3& p : std::get<TrianglesObject>(object.shape).vertices)
                for (int axis = 0; axis < 3; ++axis) p[axis] = std::floor(p[axis] * 0x1p16) * 0x1p-16;
        const FrameSettings settings = frame_of(32, 24, 1, 5);
        const Film expected = stage.render(scene, settings);
        tally.witness(shows_something(expected));
        for (int k = 0; k <= 32; k += stage.quick ? 8 : 1) {
            SceneDescription moved = scene;
            translate_scene(moved, glm::dvec3(std::ldexp(1.0, k), std::ldexp(-0.75, k), 0x1p-16 * k));
            expect_same(tally, stage.render(moved, settings), expected, 0, uint64_t(k));
        }
    }
};

}  // namespace cistula::verify::metamorphic
