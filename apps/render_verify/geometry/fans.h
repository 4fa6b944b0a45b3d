// Fans of many triangles about one vertex: a closed lens of two fans that share their rim.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/crossings.h"
#include "apps/render_verify/scenes.h"

namespace cistula::verify::geometry {

/// The lens as a mesh. Vertices: the upper hub, the lower hub, the rim.
inline TrianglesObject lens(uint32_t spokes, const glm::dvec3& center, double height) {
    TrianglesObject mesh;
    mesh.keep_triangles = true;
    mesh.vertices = {center + glm::dvec3(0, 0, height), center - glm::dvec3(0, 0, height)};
    for (uint32_t i = 0; i < spokes; ++i) {
        const double angle = 6.283185307179586 * i / spokes;
        mesh.vertices.push_back(center + glm::dvec3(std::cos(angle), std::sin(angle), 0));
    }
    for (uint32_t i = 0; i < spokes; ++i) {
        const uint32_t a = 2 + i, b = 2 + (i + 1) % spokes;
        mesh.triangles.push_back({0, a, b});
        mesh.triangles.push_back({1, b, a});
    }
    return mesh;
}

struct Fans {
    static constexpr const char* name = "geometry/fans";
    static constexpr const char* exact = "4 to 65,536 triangles about a vertex: one way in, one way out";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;

    uint32_t spokes;

    static void plan(Plan& plan) {
        for (const uint32_t spokes : {4u, 5u, 8u, 31u, 256u, 2048u, 65536u}) {
            const bool odd = spokes % 2 != 0;
            const TrianglesObject mesh = lens(spokes, odd ? glm::dvec3(0.1, 0.3, 0.2) : glm::dvec3(0), 0.25);
            // The check of the places that mirrored rays start from takes the square of a fan's triangles at load; rays
            // that go straight do without, so the largest fan takes the place of a small one after that.
            const bool by_hand = spokes > 4096;
            SceneDescription scene = empty_scene();
            add_object(scene, by_hand ? lens(8, glm::dvec3(0), 0.25) : mesh);
            Part& part = plan.add(std::to_string(spokes) + " spokes", scene, Fans{spokes}, mesh.vertices,
                                  by_hand ? plan.rays(5'000, 500) : plan.rays(200'000, 4000));
            if (by_hand) part.edit([mesh](auto& compiled) { put_triangles(compiled, mesh); });
        }
    }

    /// Replaces a compiled scene's clusters by those of a lens: eight neighbors of either fan each.
    template <class Scene>
    static void put_triangles(Scene& compiled, const TrianglesObject& mesh) {
        using Lanes = typename decltype(compiled.clusters)::value_type;
        using Real = std::remove_reference_t<decltype(Lanes::corner[0][0][0])>;
        compiled.clusters.clear();
        for (size_t fan = 0; fan < 2; ++fan)
            for (size_t first = fan; first < mesh.triangles.size(); first += 2 * cluster_lanes) {
                Lanes cluster{};
                for (size_t t = first; t < mesh.triangles.size() && cluster.count < cluster_lanes; t += 2) {
                    for (int c = 0; c < 3; ++c)
                        for (int axis = 0; axis < 3; ++axis)
                            cluster.corner[c][axis][cluster.count] =
                                Real(mesh.vertices[mesh.triangles[t][size_t(c)]][axis]);
                    cluster.triangle[cluster.count++] = uint32_t(t);
                }
                compiled.clusters.push_back(cluster);
            }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> hub = setup.point(draw.below(2)), rim = setup.point(2 + draw.below(spokes));
        const uint32_t kind = draw.below(4);
        const Real share = kind == 0 ? Real(draw.between(0, 14)) / Real(16) : Real(0.9) * draw.unit<Real>();
        const Vec3<Real> target = kind < 2 ? along(hub, share, rim - hub) : hub;
        if (draw.one_in(4)) {
            const Vec3<double> middle = (setup.points[0] + setup.points[1]) * 0.5;
            const Vec3<Real> origin(middle + in_ball(draw) * (0.1 * setup.factor));
            tally.expect(cross_all(intersector, inside(aimed(setup, draw, origin, target), 0)).are(0, 1));
            return;
        }
        Vec3<Real> origin(on_sphere(draw) * (1.9 * double(setup.extent())));
        if (draw.one_in(8)) origin = target, origin.z = draw.one_in(2) ? Real(1.25) : Real(-1.25);
        const Ray<Real> ray = aimed(setup, draw, origin, target);
        const Crossings found = cross_all(intersector, ray);
        // A line steeper than the lens crosses the lens if it crosses its faces.
        const bool steep = magnitude(ray.direction.z) > Real(0.5) * length(ray.direction);
        tally.witness(steep);
        tally.expect(steep ? found.are(1, 1) : found.balanced());
    }
};

}  // namespace cistula::verify::geometry
