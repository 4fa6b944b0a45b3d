// Scenes in which what is dark is in shadow.
#pragma once

#include "verify/cases/scenes.h"

namespace cistula::verify::shadows {

/// A scene of lights only, so that what is dark is in shadow.
inline SceneDescription dark_scene() {
    SceneDescription scene = empty_scene();
    scene.ambient = glm::dvec3(0);
    return scene;
}
/// The square [-half, half]^2 at height z, rotated; n x n cells of two triangles, cut along one diagonal or the other.
inline TrianglesObject square(double half, double z, uint32_t n, bool other_way,
                              const glm::dvec3& rotation = glm::dvec3(0), const glm::dvec3& center = glm::dvec3(0)) {
    const Rotation turned(rotation);
    TrianglesObject mesh;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x)
            mesh.vertices.push_back(center + turned(glm::dvec3(half * (2.0 * x / n - 1), half * (2.0 * y / n - 1), z)));
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x;
            const uint32_t b = a + 1;
            const uint32_t c = a + n + 1;
            const uint32_t d = c + 1;
            if (other_way) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({b, d, c});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({a, d, c});
            }
        }
    return mesh;
}

/// The object at a placement: a solid of planes, its triangles, or a square that faces up before rotation.
enum class Body { planes, triangles, sheet };

}  // namespace cistula::verify::shadows
