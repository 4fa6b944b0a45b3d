// The order of triangles and lights in a file does not change any integer of a film.
#pragma once

#include <algorithm>

#include "apps/render_verify/shadows/local_light.h"
#include "apps/render_verify/stage.h"

namespace cistula::verify::shadows {

/// Glass and mirrors of triangles and of planes in a room with many lights, in a frame with the bound pinned: the sum
/// of the lights' intensities, of which the bound is made, is rounded in their order.
inline SceneDescription glass_room() {
    SceneDescription scene = lit_scene();
    scene.ambient = glm::dvec3(0.125);
    scene.frame = FrameOfReference{glm::dvec3(0), -3, 4096.0};
    scene.camera.position = {0.4, -5, 2.5};
    scene.camera.target = {0, 0, 0.2};
    scene.materials[0].specular = 0.5;
    scene.materials[0].exponent = 20;
    MaterialDescription glass = scene.materials[0];
    glass.transmission = 0.6, glass.reflection = 0.2, glass.index = 1.3;
    glass.tint = {0.9, 0.7, 0.5};
    glass.absorption = {0.1, 0.2, 0.05};
    const int tinted = add_material(scene, glass);
    glass.transmission = 0.47, glass.tint = {0.6, 0.8, 1};
    const int bluish = add_material(scene, glass);
    glass.transmission = 0.71;
    const int clearer = add_material(scene, glass);
    add_object(scene, square(6, -1.1, 3, false));
    TrianglesObject first = star(0.6, 1.1), second = torus(0.7, 0.25, 12, 8);
    for (glm::dvec3& p : first.vertices) p += glm::dvec3(-1, 0.3, 0);
    for (glm::dvec3& p : second.vertices) p += glm::dvec3(1, 0.5, 0.3);
    add_object(scene, first, tinted);
    add_object(scene, second, bluish);
    add_solid(scene, Shape::planes, solid_object(PlatonicSolid::icosahedron, {0.2, -1.2, -0.2}, 0.6, {17, 41, 73}),
              clearer);
    for (uint32_t k = 0; k < 24; ++k) {
        const double a = 0.61 * k;
        LightDescription& light = add_light(scene, {2.7 * std::cos(a), 2.3 * std::sin(a), 1.3 + 0.1 * k});
        light.color = glm::dvec3(0.1 + 0.013 * k, 0.3 - 0.007 * k, 0.2) * (k % 3 ? 1.0 : 1.7);
        light.radius = k % 4 ? 0 : 0.05;
        light.falloff = k % 8 == 0;
    }
    return scene;
}

/// A permutation of the numbers below n: the reverse, or a random one.
inline std::vector<uint32_t> permutation(size_t n, uint64_t which) {
    std::vector<uint32_t> order(n);
    for (size_t i = 0; i < n; ++i) order[i] = uint32_t(n - 1 - i);
    if (which != 0)
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            return parity::mixed(a + (which << 32)) < parity::mixed(b + (which << 32));
        });
    return order;
}
template <class T>
void permute(std::vector<T>& items, uint64_t which) {
    const std::vector<T> before = items;
    const std::vector<uint32_t> order = permutation(items.size(), which);
    for (size_t i = 0; i < items.size(); ++i) items[i] = before[order[i]];
}

/// The id of a pixel in a scene whose lights are permuted, in the original order of lights.
inline int32_t id_before(const SceneDescription& scene, int32_t id, uint64_t which) {
    const auto solids = int32_t(scene.objects.size());
    if (id <= solids) return id;
    std::vector<uint32_t> visible;  // the lights with a radius, in their new order
    for (const uint32_t light : permutation(scene.lights.size(), which))
        if (scene.lights[light].shown()) visible.push_back(light);
    const uint32_t light = visible[size_t(id - solids - 1)];
    int32_t before = solids + 1;
    for (uint32_t i = 0; i < light; ++i) before += scene.lights[i].shown();
    return before;
}

/// `change(scene, which)` permutes the scene; `id(scene, id, which)` is what an id of the permuted scene was before.
template <class Change, class Id>
void compare_permuted(const Stage& stage, Tally& tally, const Change& change, const Id& id) {
    const int width = stage.quick ? 40 : 240, height = stage.quick ? 30 : 180;
    const SceneDescription scene = glass_room();
    const Film expected = stage.render(scene, width, height);
    for (uint64_t which = 0; which < (stage.quick ? 2 : 4); ++which) {
        SceneDescription other = scene;
        change(other, which);
        const Film found = stage.render(other, width, height);
        tally.expect(found.radiance_exponent == expected.radiance_exponent &&
                     found.fixed_shift == expected.fixed_shift);
        for (size_t i = 0; i < expected.pixels.size(); ++i) {
            const PixelRecord &a = expected.pixels[i], &b = found.pixels[i];
            ++tally.place;
            for (int c = 0; c < 3; ++c) {
                tally.expect(a.radiance[c] == b.radiance[c]);
                tally.expect(a.pruned[c] == b.pruned[c] && a.cut[c] == b.cut[c]);
            }
            tally.expect(a.hits == b.hits && a.rays == b.rays && a.id == id(scene, b.id, which) && a.z == b.z);
            tally.witness(a.id > 1 && a.radiance[0] > 0);
        }
    }
}

struct PermutedTriangles {
    static constexpr const char* name = "shadows/permuted-triangles";
    static constexpr const char* exact = "0 differing integers of films of meshes in another order";
    static constexpr Bound bound = no_failures("integers");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        const auto change = [](SceneDescription& scene, uint64_t which) {
            for (ObjectDescription& object : scene.objects)
                if (auto* mesh = std::get_if<TrianglesObject>(&object.shape)) permute(mesh->triangles, which);
        };
        compare_permuted(stage, tally, change, [](const SceneDescription&, int32_t id, uint64_t) { return id; });
    }
};

struct PermutedLights {
    static constexpr const char* name = "shadows/permuted-lights";
    static constexpr const char* exact = "0 differing integers of films with their lights in another order";
    static constexpr Bound bound = no_failures("integers");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        const auto change = [](SceneDescription& scene, uint64_t which) { permute(scene.lights, which); };
        compare_permuted(stage, tally, change, id_before);
    }
};

}  // namespace cistula::verify::shadows
