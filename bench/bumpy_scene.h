// The sphere that benchmarks of rays are about.
#pragma once

#include "scene/description/description.h"
#include "testing/generated_mesh.h"

namespace cistula::bench {

/// 1.3 million triangles, seen from near by under a horizontal angle in degrees: at 30 every ray hits, at 40 those of
/// the picture's corners do not.
inline SceneDescription bumpy_scene(double field_of_view) {
    SceneDescription scene;
    scene.source = "bumpy sphere";
    scene.camera.position = {0, -2.6, 1};
    scene.camera.field_of_view = field_of_view;
    scene.materials.emplace_back();
    ObjectDescription object;
    object.name = "sphere";
    object.material = 0;
    object.shape = bumpy_sphere(1'300'000);
    object.place = "/objects/0";
    scene.objects.push_back(std::move(object));
    return scene;
}

}  // namespace cistula::bench
