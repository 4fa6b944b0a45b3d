// Comparison of films, and the scenes that they show.
#pragma once

#include <algorithm>
#include <cmath>

#include "apps/render_verify/case.h"
#include "apps/render_verify/scenes.h"
#include "apps/render_verify/stage.h"
#include "cistula/model/effects.h"
#include "scene/description/camera_path.h"
#include "testing/generated_scene.h"

namespace cistula::verify::metamorphic {

/// Whether two pixels are equal bit for bit, with z multiplied by a power of two.
inline bool same_pixel(const PixelRecord& a, const PixelRecord& b, float z_factor = 1) {
    bool same = a.hits == b.hits && a.rays == b.rays && a.id == b.id &&
                bits_as<uint32_t>(a.z) == bits_as<uint32_t>(b.z * z_factor);
    for (int c = 0; c < 3; ++c)
        same &= a.radiance[c] == b.radiance[c] && a.pruned[c] == b.pruned[c] && a.cut[c] == b.cut[c] &&
                bits_as<uint32_t>(a.normal[c]) == bits_as<uint32_t>(b.normal[c]);
    return same;
}

/// The place of a pixel as a number: 3001200017 is scene 3, variation 12, pixel 17.
inline uint64_t place_of(uint64_t scene, uint64_t variation, size_t pixel) {
    return scene * 1'000'000'000 + variation * 1'000'000 + pixel;
}

/// Expects equal pixels, one try each. A film with flags, or of another size or scale, fails for all.
inline void expect_same(Tally& tally, const Film& found, const Film& expected, uint64_t scene, uint64_t variation,
                        float z_factor = 1, int exponent = 0) {
    const bool comparable = found.flags == 0 && expected.flags == 0 && found.pixels.size() == expected.pixels.size() &&
                            found.fixed_shift == expected.fixed_shift &&
                            found.radiance_exponent == expected.radiance_exponent + exponent;
    for (size_t i = 0; i < expected.pixels.size(); ++i) {
        tally.place = place_of(scene, variation, i);
        tally.expect(comparable && same_pixel(found.pixels[i], expected.pixels[i], z_factor));
    }
}

/// Expects equal hits only: the numbers of samples that hit, and the solids.
inline void expect_same_hits(Tally& tally, const Film& found, const Film& expected, uint64_t scene,
                             uint64_t variation) {
    for (size_t i = 0; i < expected.pixels.size(); ++i) {
        tally.place = place_of(scene, variation, i);
        tally.expect(found.flags == 0 && found.pixels[i].hits == expected.pixels[i].hits &&
                     found.pixels[i].id == expected.pixels[i].id);
    }
}

/// Whether a film shows more than a background of one color.
inline bool shows_something(const Film& film) {
    const auto hit = [](const PixelRecord& pixel) { return pixel.hits > 0; };
    return std::count_if(film.pixels.begin(), film.pixels.end(), hit) * 20 > ptrdiff_t(film.pixels.size());
}

/// A generated scene whose picture is small enough for the plain loop over all primitives.
inline SceneDescription small_scene(uint64_t seed) {
    SceneDescription scene = generated_scene(seed);
    scene.film.width = 24;
    scene.film.height = 16;
    scene.film.supersample = std::min(scene.film.supersample, 2);
    scene.depth = std::min(scene.depth, 6);
    return scene;
}
/// Whether a quick run skips the scene: the plain loop is slow for many triangles.
inline bool is_heavy(const SceneDescription& scene) {
    size_t triangles = 0;
    for (const ObjectDescription& object : scene.objects)
        if (const auto* mesh = std::get_if<TrianglesObject>(&object.shape)) triangles += mesh->triangles.size();
    return triangles > 300;
}

/// Replaces the camera's paths by its position and target in frame 0, which can then be moved. `reach` is a length of
/// the scene.
inline void fix_camera(SceneDescription& scene, double reach) {
    const Camera camera = camera_at(scene.camera, 0).camera;
    scene.camera.position_path.reset();
    scene.camera.target_path.reset();
    scene.camera.position = camera.position;
    scene.camera.target = camera.position + camera.forward * reach;
}

/// A flat sheet.
inline TrianglesObject sheet(const std::array<glm::dvec3, 4>& corners) {
    TrianglesObject quad;
    quad.vertices.assign(corners.begin(), corners.end());
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    return quad;
}

inline FrameSettings frame_of(int width, int height, int supersample = 1, int depth = 2) {
    FrameSettings settings;
    settings.set_size(width, height);
    settings.supersample = supersample;
    settings.depth = depth;
    return settings;
}

}  // namespace cistula::verify::metamorphic
