// A clear solid of the surrounding index changes no bit of the image.
#pragma once

#include <algorithm>
#include <functional>

#include "apps/render_verify/case.h"
#include "apps/render_verify/refraction/lines.h"
#include "apps/render_verify/scenes.h"
#include "apps/render_verify/stage.h"

namespace cistula::verify::refraction {

/// A room with a checkered floor, an opaque solid, a mirror, tinted absorbing Fresnel glass, and lights of all kinds.
/// The frame and the bound are given, so that additional solids change neither.
inline SceneDescription room() {
    SceneDescription scene = empty_scene();
    scene.frame = FrameOfReference{{0, 0, 0}, -2, 64.0};
    scene.camera.position = {3.1, -3.7, 2.2};
    scene.camera.target = {0, 0, 0.4};
    scene.camera.field_of_view = 50;
    scene.depth = 6;
    scene.ambient = glm::dvec3(0.2);
    scene.background = {0.1, 0.2, 0.4};
    TextureDescription checker;
    checker.name = "checker";
    checker.checker = {glm::dvec3(0.9, 0.8, 0.7), glm::dvec3(0.1, 0.2, 0.3)};
    checker.repeat = {8, 8};
    scene.textures.push_back(checker);
    MaterialDescription floor, mirror, tinted, solid;
    floor.texture = 0;
    floor.reflection = 0.2;
    mirror.reflection = 0.8;
    mirror.specular = 0.5;
    tinted.reflection = 0.2;
    tinted.transmission = 0.7;
    tinted.tint = {0.9, 1, 0.8};
    tinted.index = 1.5;
    tinted.fresnel = true;
    tinted.absorption = {0.1, 0.2, 0.3};
    solid.specular = 0.5;
    TrianglesObject quad;
    quad.vertices = {{-5, -5, -1}, {5, -5, -1}, {5, 5, -1}, {-5, 5, -1}};
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    quad.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    add_object(scene, quad, add_material(scene, floor));
    add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, {-1.5, 1.25, -0.25}, 1, {0, 0, 20}),
              add_material(scene, mirror));
    add_solid(scene, Shape::planes, solid_object(PlatonicSolid::icosahedron, {0.5, -0.5, 0.25}, 1, {10, 20, 30}),
              add_material(scene, tinted));
    add_solid(scene, Shape::triangles, solid_object(PlatonicSolid::octahedron, {-1, -1.5, 0}, 0.7, {5, 0, 40}),
              add_material(scene, solid));
    add_light(scene, {3, -3, 4});
    LightDescription& seen = add_light(scene, {-1, 0.5, 1.5});
    seen.color = {0.8, 0.6, 0.4};
    seen.radius = 0.125;
    seen.falloff = true;
    return scene;
}

/// Expects equal pixels, except for ray counts and ids: in the image without, which has `solids` solids, these are
/// lower by `fewer`, those of lights by `fewer_in_all`.
inline void expect_same(const Film& with, const Film& without, int solids, int fewer, int fewer_in_all, Tally& tally) {
    for (size_t i = 0; i < without.pixels.size(); ++i) {
        const PixelRecord &a = with.pixels[i], &b = without.pixels[i];
        const int id = b.id == 0 ? 0 : b.id + (b.id > solids ? fewer_in_all : fewer);
        bool same = a.hits == b.hits && a.z == b.z && a.id == id;
        for (int c = 0; c < 3; ++c)
            same = same && a.radiance[c] == b.radiance[c] && a.pruned[c] == b.pruned[c] && a.cut[c] == b.cut[c] &&
                   a.normal[c] == b.normal[c];
        tally.place = i;
        tally.expect(same);
    }
}

struct IndexOne {
    static constexpr const char* name = "refraction/index-one";
    static constexpr const char* exact = "the image without the solid, integer for integer";
    static constexpr Bound bound = no_failures("pixels");

    using Change = std::function<void(SceneDescription&, int clear)>;

    static void render(Stage& stage, Tally& tally) {
        const int width = stage.quick ? 40 : 320, height = stage.quick ? 30 : 240;
        const auto compare = [&](const SceneDescription& scene, bool first, const Change& add) {
            SceneDescription with = scene, alone = scene;
            const int clear = add_material(with, glass(1)), split = add_material(with, glass(1));
            with.materials[size_t(split)].fresnel = true;
            const size_t before = with.objects.size();
            add(with, clear);
            const int added = int(with.objects.size() - before);
            for (size_t k = before; k < with.objects.size(); k += 2) with.objects[k].material = split;
            if (first) std::rotate(with.objects.begin(), with.objects.begin() + long(before), with.objects.end());
            const Film seen = stage.render(with, width, height), expected = stage.render(alone, width, height);
            tally.expect(seen.flags == 0 && expected.flags == 0 && seen.fixed_shift == expected.fixed_shift &&
                         seen.radiance_exponent == expected.radiance_exponent);
            expect_same(seen, expected, int(alone.objects.size()), first ? added : 0, added, tally);
        };
        // A solid of lower priority than all others: through everything, around the camera and around lights. At most 8
        // in one place.
        const Change everywhere = [](SceneDescription& scene, int clear) {
            for (size_t k = 0; k < 5; ++k) {
                const PlatonicSolid kind = platonic_solids[k];
                const double angle = 20 * double(k);
                if (k % 2 == 0)
                    add_solid(scene, Shape::planes,
                              solid_object(kind, {0.5 * double(k) - 1, 0.25, 0.125}, 2, {angle, 5, 7}), clear);
                else
                    add_solid(scene, Shape::triangles,
                              solid_object(kind, {0.5, 0.5 * double(k) - 1, 0.5}, 1, {3, angle, 9}), clear);
            }
            add_solid(scene, Shape::planes, solid_object(PlatonicSolid::icosahedron, scene.camera.position, 1), clear);
            add_solid(scene, Shape::triangles, solid_object(PlatonicSolid::dodecahedron, scene.camera.position, 0.5),
                      clear);
            add_solid(scene, Shape::planes, solid_object(PlatonicSolid::octahedron, scene.lights[1].position, 1),
                      clear);
            add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, {3, -3, 3}, std::sqrt(3.0)), clear);
        };
        compare(room(), true, everywhere);
        // Last in the file they would carve a hole into what they overlap: beside it. (On the floor they would
        // change t by rounding: the group contact has such.)
        const Change beside = [](SceneDescription& scene, int clear) {
            add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, {2.75, 1.75, 0.25}, std::sqrt(3.0)),
                      clear);
            add_solid(scene, Shape::triangles, solid_object(PlatonicSolid::cube, {-3, -3, 0.25}, std::sqrt(3.0)),
                      clear);
            TrianglesObject ring = torus(0.5, 0.2, 24, 12), spikes = star();
            for (glm::dvec3& p : ring.vertices) p += glm::dvec3(1.5, -2.5, 0.5);
            for (glm::dvec3& p : spikes.vertices) p += glm::dvec3(-1.5, 4, 1);
            add_object(scene, ring, clear);
            add_object(scene, spikes, clear);
            add_solid(scene, Shape::planes, solid_object(PlatonicSolid::octahedron, {2.75, -0.5, 1.25}, 1), clear);
        };
        compare(room(), false, beside);
        // Inside a body of the same index, seen from outside and from within.
        for (const Shape shape : {Shape::planes, Shape::triangles})
            for (const bool from_within : {false, true}) {
                SceneDescription scene = room();
                MaterialDescription material = glass(1.5);
                material.reflection = 0.1;
                material.transmission = 0.9;
                add_solid(scene, shape, solid_object(PlatonicSolid::dodecahedron, {2, -2, 1.5}, 1),
                          add_material(scene, material));
                if (from_within) scene.camera.position = {2.25, -2.25, 1.5};
                compare(scene, false, [&](SceneDescription& with, int clear) {
                    with.materials[size_t(clear)].index = with.materials[size_t(clear) + 1].index = 1.5;
                    add_solid(with, Shape::planes, solid_object(PlatonicSolid::icosahedron, {2, -2, 1.5}, 0.5), clear);
                    add_solid(with, Shape::triangles, solid_object(PlatonicSolid::octahedron, {2, -2, 1.5}, 0.375),
                              clear);
                });
            }
    }
};

}  // namespace cistula::verify::refraction
