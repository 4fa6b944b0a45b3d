// Closed meshes: with a hole, with spikes, uneven.
#pragma once

#include <vector>

#include "testing/generated_mesh.h"

namespace cistula::verify::mirrors {

/// A mesh, a point inside, and the radius around it that is inside, too.
struct InsideOf {
    const char* name;
    TrianglesObject mesh;
    glm::dvec3 middle;
    double around;
};
inline std::vector<InsideOf> closed_meshes() {
    return {{"torus", torus(1, 0.4, 16, 12), {1, 0.05, 0.1}, 0.1},
            {"coarse torus", torus(1, 0.5, 5, 3), {0.8, 0.05, 0.02}, 0.02},
            {"star", star(), {0.01, 0.02, -0.03}, 0.1},
            {"sharp star", star(0.2, 1), {0.01, 0.02, -0.03}, 0.05},
            {"bumpy sphere", bumpy_sphere(500), {0.01, 0.02, -0.03}, 0.3}};
}

/// Corners, edge points and centers of triangles.
inline std::vector<glm::dvec3> mesh_points(const TrianglesObject& mesh) {
    std::vector<glm::dvec3> points = mesh.vertices;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        points.insert(points.end(), {(b + c) * 0.5, a + (b - a) * 0.3, (a + b + c) / 3.0});
    }
    return points;
}

}  // namespace cistula::verify::mirrors
