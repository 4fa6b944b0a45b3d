// Smooth meshes of known surfaces, which tests use as well.
#pragma once

#include <cmath>
#include <map>

#include "cistula/numerics/vec.h"
#include "scene/description/description.h"

namespace cistula::verify::smooth {

/// A closed mesh of 20 * 4^level triangles around the origin, cut from an icosahedron, with a corner at radius(d) in
/// direction d, and the normals of the surface, by differences.
template <class Radius>
TrianglesObject round_mesh(int level, const Radius& radius) {
    const double golden = 0.5 + 0.5 * std::sqrt(5.0);
    std::vector<glm::dvec3> way;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-golden, golden}) {
            way.push_back(normalized(glm::dvec3(a, b, 0)));
            way.push_back(normalized(glm::dvec3(0, a, b)));
            way.push_back(normalized(glm::dvec3(b, 0, a)));
        }
    TrianglesObject mesh;
    const double side = 1.01 * 2 / std::sqrt(golden * golden + 1);  // of the icosahedron, and a little
    for (uint32_t a = 0; a < 12; ++a)
        for (uint32_t b = a + 1; b < 12; ++b)
            for (uint32_t c = b + 1; c < 12; ++c) {
                if (length(way[a] - way[b]) > side || length(way[b] - way[c]) > side || length(way[c] - way[a]) > side)
                    continue;
                const bool outward = dot(cross(way[b] - way[a], way[c] - way[a]), way[a]) > 0;
                mesh.triangles.push_back({a, outward ? b : c, outward ? c : b});
            }
    for (; level > 0; --level) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [at, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, uint32_t(way.size()));
            if (is_new) way.push_back(normalized(way[a] + way[b]));
            return at->second;
        };
        std::vector<std::array<uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const uint32_t ab = middle(a, b);
            const uint32_t bc = middle(b, c);
            const uint32_t ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    const auto point = [&](const glm::dvec3& d) { return radius(d) * d; };
    for (const glm::dvec3& d : way) {
        const glm::dvec3 u = normalized(cross(d, std::abs(d.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        const glm::dvec3 v = cross(d, u);
        const auto slope = [&](const glm::dvec3& w) {
            return point(normalized(d + 1e-5 * w)) - point(normalized(d - 1e-5 * w));
        };
        mesh.vertices.push_back(point(d));
        mesh.normals.push_back(normalized(cross(slope(u), slope(v))));
    }
    return mesh;
}

/// A torus about the z axis.
inline TrianglesObject ring_mesh(uint32_t around, uint32_t across, double radius, double tube) {
    constexpr double turn = 6.283185307179586;
    TrianglesObject mesh;
    for (uint32_t i = 0; i < around; ++i)
        for (uint32_t j = 0; j < across; ++j) {
            const double a = turn * i / around;
            const double b = turn * j / across;
            const glm::dvec3 out(std::cos(a), std::sin(a), 0);
            mesh.normals.push_back(std::cos(b) * out + glm::dvec3(0, 0, std::sin(b)));
            mesh.vertices.push_back(radius * out + tube * mesh.normals.back());
            const auto at = [&](uint32_t x, uint32_t y) { return (x % around) * across + y % across; };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

}  // namespace cistula::verify::smooth
