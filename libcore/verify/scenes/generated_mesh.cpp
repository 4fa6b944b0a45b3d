#include "verify/scenes/generated_scene.h"

#include <cmath>

#include "cistula/numerics/trigonometry.h"
#include "cistula/numerics/vec.h"
#include "scene/compile/scene_normalization.h"
#include "scene/description/platonic.h"

namespace cistula {
namespace {

using glm::dvec3;
constexpr double pi = 3.14159265358979323846;

/// Two triangles between neighboring rows of a grid, counter-clockwise where rows go up and columns go left.
void add_quad(std::vector<std::array<uint32_t, 3>>& triangles, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
}

/// The splitmix64 generator.
struct Random {
    uint64_t state;
    double operator()() {  // in [0, 1)
        uint64_t z = (state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
};

}  // namespace

TrianglesObject bumpy_sphere(uint32_t triangles, double bump) {
    // rows of 2 rows columns each: 2 (rows - 1) columns triangles.
    uint32_t rows = 2;
    while (4 * uint64_t(rows) * (rows + 1) <= triangles) ++rows;
    const uint32_t columns = 2 * rows;
    TrianglesObject object;
    object.keep_triangles = true;
    object.vertices.reserve(uint64_t(rows - 1) * columns + 2);
    object.triangles.reserve(2 * uint64_t(rows - 1) * columns);
    const auto add_vertex = [&](const dvec3& p) {
        const double wave =
            elementary::sin(9 * p.x + 1) * elementary::sin(11 * p.y + 2) * elementary::sin(10 * p.z + 3);
        object.vertices.push_back(p * (1 + bump * wave));
    };
    add_vertex({0, 0, -1});
    for (uint32_t i = 1; i < rows; ++i) {
        const double theta = pi * i / rows;
        const double r = elementary::sin(theta);
        const double z = -elementary::cos(theta);
        for (uint32_t j = 0; j < columns; ++j) {
            const double phi = 2 * pi * j / columns;
            add_vertex({r * elementary::cos(phi), r * elementary::sin(phi), z});
        }
    }
    add_vertex({0, 0, 1});
    const auto last = static_cast<uint32_t>(object.vertices.size() - 1);
    const auto at = [&](uint32_t row, uint32_t column) { return 1 + (row - 1) * columns + column % columns; };
    for (uint32_t j = 0; j < columns; ++j) object.triangles.push_back({0, at(1, j + 1), at(1, j)});
    for (uint32_t i = 1; i + 1 < rows; ++i)
        for (uint32_t j = 0; j < columns; ++j)
            add_quad(object.triangles, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    for (uint32_t j = 0; j < columns; ++j) object.triangles.push_back({last, at(rows - 1, j), at(rows - 1, j + 1)});
    return object;
}

TrianglesObject torus(double radius, double tube, uint32_t around, uint32_t across) {
    TrianglesObject object;
    for (uint32_t i = 0; i < across; ++i) {
        const double theta = 2 * pi * i / across;
        const double r = radius + tube * elementary::cos(theta);
        const double z = tube * elementary::sin(theta);
        for (uint32_t j = 0; j < around; ++j) {
            const double phi = 2 * pi * j / around;
            object.vertices.push_back({r * elementary::cos(phi), r * elementary::sin(phi), z});
        }
    }
    const auto at = [&](uint32_t row, uint32_t column) { return row % across * around + column % around; };
    for (uint32_t i = 0; i < across; ++i)
        for (uint32_t j = 0; j < around; ++j)
            add_quad(object.triangles, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    return object;
}

TrianglesObject prism(uint32_t sides, double low, double high, double height) {
    TrianglesObject mesh;
    for (const bool up : {false, true})
        for (uint32_t i = 0; i < sides; ++i) {
            const double angle = 6.283185307179586 * i / sides;
            const double radius = up ? high : low;
            mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), up ? height : -height});
        }
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t a = i;
        const uint32_t b = (i + 1) % sides;
        mesh.triangles.push_back({a, b, sides + b});
        mesh.triangles.push_back({a, sides + b, sides + a});
    }
    for (uint32_t i = 1; i + 1 < sides; ++i) {
        mesh.triangles.push_back({0, i + 1, i});
        mesh.triangles.push_back({sides, sides + i, sides + i + 1});
    }
    return mesh;
}

TrianglesObject star(double inner, double outer) {
    const Polyhedron& shape = platonic_shape(PlatonicSolid::icosahedron);
    TrianglesObject object;
    for (const dvec3& p : shape.vertices) object.vertices.push_back(inner * p);
    for (const auto& face : shape.faces) {
        const auto tip = static_cast<uint32_t>(object.vertices.size());
        object.vertices.push_back(outer * face.normal);
        for (uint32_t i = 0; i < 3; ++i)
            object.triangles.push_back({face.vertices[i], face.vertices[(i + 1) % 3], tip});
    }
    return object;
}

TrianglesObject triangle_soup(uint32_t triangles, double size, uint64_t seed) {
    TrianglesObject object;
    Random random{seed};
    for (uint32_t i = 0; i < triangles; ++i) {
        const double x = 2 * random() - 1;
        const double y = 2 * random() - 1;
        const double z = 2 * random() - 1;
        for (uint32_t c = 0; c < 3; ++c) {
            const double dx = random() - 0.5;
            const double dy = random() - 0.5;
            const double dz = random() - 0.5;
            const double half = 0.5 * size;
            object.vertices.push_back({x + half * dx, y + half * dy, z + half * dz});
        }
        object.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return object;
}

TrianglesObject triangulated_solid(const SolidObject& solid) {
    TrianglesObject object;
    object.vertices = world_vertices(solid);
    object.triangles = triangulated(polyhedron_of(solid));
    object.keep_triangles = true;
    return object;
}

}  // namespace cistula
