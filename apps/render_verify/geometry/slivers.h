// Triangles 2^20 times as long as wide, in closed meshes.
#pragma once

#include "apps/render_verify/geometry/edges_from_outside.h"

namespace cistula::verify::geometry {

/// The box [-1, 1]^3, cut by grid planes at these coordinates of every axis.
inline TrianglesObject grid_box(const std::vector<double>& cuts) {
    const uint32_t n = uint32_t(cuts.size());
    TrianglesObject mesh;
    mesh.keep_triangles = true;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true}) {
            // Vertices at one position count as one, so every face may have its own.
            const uint32_t first = uint32_t(mesh.vertices.size());
            for (uint32_t i = 0; i < n; ++i)
                for (uint32_t j = 0; j < n; ++j) {
                    glm::dvec3 p;
                    p[axis] = high ? cuts.back() : cuts.front();
                    p[(axis + 1) % 3] = cuts[i];
                    p[(axis + 2) % 3] = cuts[j];
                    mesh.vertices.push_back(p);
                }
            for (uint32_t i = 0; i + 1 < n; ++i)
                for (uint32_t j = 0; j + 1 < n; ++j) {
                    const uint32_t a = first + i * n + j, b = a + n, c = b + 1, d = a + 1;
                    if (high) {
                        mesh.triangles.push_back({a, b, c});
                        mesh.triangles.push_back({a, c, d});
                    } else {
                        mesh.triangles.push_back({a, c, b});
                        mesh.triangles.push_back({a, d, c});
                    }
                }
        }
    return mesh;
}

/// A prism about a line through the origin with `sides` long thin faces.
inline TrianglesObject needle(uint32_t sides, double radius, const glm::dvec3& rotation, const glm::dvec3& center) {
    const Rotation turned(rotation);
    TrianglesObject mesh;
    mesh.keep_triangles = true;
    for (const double z : {-1.0, 1.0})
        for (uint32_t i = 0; i < sides; ++i) {
            const double angle = 6.283185307179586 * i / sides;
            mesh.vertices.push_back(center + turned(glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), z)));
        }
    for (uint32_t i = 0; i < sides; ++i) {
        const uint32_t a = i, b = (i + 1) % sides;
        mesh.triangles.push_back({a, b, sides + b});
        mesh.triangles.push_back({a, sides + b, sides + a});
    }
    for (uint32_t i = 1; i + 1 < sides; ++i) {
        mesh.triangles.push_back({0, i + 1, i});
        mesh.triangles.push_back({sides, sides + i, sides + i + 1});
    }
    return mesh;
}

struct Slivers {
    static constexpr const char* name = "geometry/slivers";
    static constexpr const char* exact =
        "closed meshes with triangles of aspect 2^20: as many ways in as out, one each in a box";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;

    bool box;

    static void plan(Plan& plan) {
        const uint64_t rays = plan.rays(4'000'000, 20000);
        const auto add = [&](const char* label, const TrianglesObject& mesh, bool is_box) {
            SceneDescription scene = empty_scene();
            add_object(scene, mesh);
            Part& part = plan.add(label, scene, Slivers{is_box}, mesh.vertices, rays);
            part.frame_numbers = [](const glm::dvec3& center, double factor, std::vector<double>& numbers) {
                for (int axis = 0; axis < 3; ++axis)
                    for (const double side : {-1.0, 1.0}) {
                        glm::dvec3 normal(0);
                        normal[axis] = side;
                        numbers.insert(numbers.end(),
                                       {normal.x, normal.y, normal.z, (1 - side * center[axis]) * factor});
                    }
            };
        };
        const double thin = 2 * 0x1p-20;
        add("box with strips", grid_box({-1, -0.5, -0.5 + thin, 0, thin, 0.3, 0.3 + thin, 1}), true);
        add("needle", needle(7, 0x1p-20, glm::dvec3(0), glm::dvec3(0)), false);
        add("needle, turned", needle(7, 0x1p-20, glm::dvec3(31, 47, 11), glm::dvec3(0)), false);
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t n = setup.points.size, first = draw.below(n), step = draw.between(1, 9);
        const Vec3<Real> a = setup.point(first), b = setup.point((first + step) % n);
        const uint32_t kind = draw.below(4);
        const Vec3<Real> target = kind < 2 ? a : along(a, kind == 2 ? Real(0.5) : draw.unit<Real>(), b - a);
        const Vec3<Real> outside = outside_origin(draw, target, double(setup.extent()));
        if (box && draw.one_in(3)) {
            const Vec3<Real> origin(in_ball(draw) * (0.9 * setup.numbers[3]));
            tally.expect(cross_all(intersector, inside(aimed(setup, draw, origin, target), 0)).are(0, 1));
            return;
        }
        const Ray<Real> ray = aimed(setup, draw, outside, target);
        const Crossings found = cross_all(intersector, ray);
        const double margin = 1e-4;
        const Vec3<double> from(ray.origin), way = normalized(Vec3<double>(ray.direction));
        const bool through = box && chord(setup.numbers, margin, from, way) > margin;
        tally.witness(box ? through : found.enters > 0);
        tally.expect(through ? found.are(1, 1) : found.balanced());
    }
};

}  // namespace cistula::verify::geometry
