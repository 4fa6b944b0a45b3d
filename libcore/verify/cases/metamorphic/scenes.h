// Generated scenes for cases that change them, and the scenes of samples on one side of a line.
#pragma once

#include "verify/cases/pictures.h"
#include "verify/cases/scenes.h"
#include "verify/scenes/generated_scene.h"

namespace cistula::verify::metamorphic {

/// A generated scene whose picture is small enough for the plain loop over all primitives.
inline SceneDescription small_scene(uint64_t seed) {
    SceneDescription scene = generated_scene(seed);
    scene.motion = nullptr;  // which knows nothing of what a case changes
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

/// Calls take(seed, scene) for the first generated scenes; take says whether the scene counts.
template <class Take>
void for_each_scene(const Stage& stage, int in_full, int in_quick, const Take& take) {
    int left = stage.quick ? in_quick : in_full;
    for (uint64_t seed = 0; seed < generated_scene_count && left > 0; ++seed) {
        const SceneDescription scene = small_scene(seed);
        if (stage.quick && is_heavy(scene)) continue;
        if (take(seed, scene)) --left;
    }
}

/// Samples of a picture in half steps from its center, as in camera_direction, and a line a x + b y = c there.
struct SampleLine {
    int a, b;
    double c;

    bool left_of(int across, int down) const { return a * across + b * down < c; }
};

/// A camera above a sheet in the plane z = 0 that ends at a line of the picture. `beyond`: the sheet on the other side,
/// which starts with the same two corners.
SceneDescription half_plane(const SampleLine& line, int samples_across, bool beyond);

}  // namespace cistula::verify::metamorphic
