// Degenerate triangles: reported when the scene is read, never hit.
#pragma once

#include <limits>

#include "apps/render_verify/geometry/upright_solids.h"

namespace cistula::verify::geometry {

struct Degenerate {
    static constexpr const char* name = "geometry/degenerate-triangles";
    static constexpr const char* exact = "no area, a repeated vertex, NaN, infinity: reported at load, never hit";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;

    bool sound_one;  // solid 0 is a valid triangle

    /// A mesh of one valid and ten degenerate triangles.
    static TrianglesObject broken() {
        const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
        TrianglesObject mesh;
        const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
            const uint32_t first = uint32_t(mesh.vertices.size());
            mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
            mesh.triangles.push_back({first, first + 1, first + 2});
        };
        const glm::dvec3 a(-1, -1, 0), b(1, -1, 0), c(0, 1, 0);
        add({-1, -1, -0.5}, {1, -1, -0.5}, {0, 1, -0.5});
        add(a, a, a);
        add(a, b, a);
        add(a, b, b);
        add(a, b, (a + b) * 0.5);
        add(a, c, a + (c - a) * 2.0);
        add(a, b, {nan, nan, nan});
        add(a, {nan, 0, 0}, c);
        add({0, 0, nan}, b, c);
        add(a, b, {0, inf, 0});
        add({-inf, -inf, 0}, {inf, -inf, 0}, {0, inf, 0});
        return mesh;
    }

    static void plan(Plan& plan) {
        SceneDescription scene = empty_scene();
        add_object(scene, broken());
        const std::vector<glm::dvec3> targets{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0, -1, 0}, {1, 3, 0}, {0, -0.5, 0}};
        Part& part = plan.add("left out at load", scene, Degenerate{true}, targets, plan.rays(1'000'000, 20000));
        part.warnings = {"3 triangles with a repeated vertex", "5 triangles with a vertex that is not finite",
                         "2 triangles of zero area"};
        // Finite ones written into the compiled arrays, since those that close a mesh stay there. Trees contain no
        // others.
        Part& raw = plan.add("in the arrays", scene, Degenerate{true}, targets, plan.rays(1'000'000, 20000));
        raw.edit([](auto& compiled) {
            auto& cluster = compiled.clusters[0];
            using Real = std::remove_reference_t<decltype(cluster.corner[0][0][0])>;
            const TrianglesObject mesh = broken();
            const std::array<int, 5> chosen{1, 2, 3, 4, 5};
            for (const int t : chosen) {
                for (int c = 0; c < 3; ++c)
                    for (int axis = 0; axis < 3; ++axis)
                        cluster.corner[c][axis][cluster.count] = Real(mesh.vertices[size_t(3 * t + c)][axis]);
                cluster.triangle[cluster.count] = cluster.count;
                ++cluster.count;
            }
        });
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> a = setup.point(draw.below(setup.points.size)), b = setup.point(draw.below(setup.points.size));
        const Vec3<Real> target = draw.one_in(2) ? a : along(a, draw.unit<Real>(), b - a);
        const Ray<Real> ray = aimed(setup, draw, Vec3<Real>(on_sphere(draw) * (1.9 * double(setup.extent()))), target);
        const Hit<Real> hit = intersector.closest(ray);
        // The valid triangle is number 0.
        tally.witness(hit.found() && key_face(hit.key) == 0);
        tally.expect(!hit.found() || (key_face(hit.key) == 0 && is_finite(hit.t)));
    }
};

}  // namespace cistula::verify::geometry
