// Lights on edges and corners of a nonconvex mesh: they are hidden by what lies between, not by the triangles that they
// lie on.
#pragma once

#include <algorithm>

#include "apps/render_verify/shadows/half_spaces.h"

namespace cistula::verify::shadows {

/// Numbers: the corners of the star's triangles, nine per triangle; then for each light the triangles on which it lies,
/// 30 bits per number.
struct LightsOnStar {
    static constexpr const char* name = "shadows/lights-on-solids/star";
    static constexpr const char* exact =
        "lights on reflex and convex edges, corners and faces: the faces between, counted";
    static constexpr Bound bound = no_failures("shadow rays");
    static constexpr bool needs_witness = true;

    uint32_t triangles, lights;
    bool glass;

    static void plan(Plan& plan) {
        for (const bool glass : {false, true})
            for (const double scale : {1.0, 0x1p40, 0x1p-40}) {
                TrianglesObject mesh = star(0.5, 1);
                for (glm::dvec3& p : mesh.vertices) p *= scale;
                SceneDescription scene = empty_scene();
                scene.materials[0] = glass_or_opaque(scene, glass);
                add_object(scene, mesh);
                // At corners, along edges and on faces: a light lies on the triangles that have all its corners.
                std::vector<std::vector<uint32_t>> held;
                for (uint32_t v = 0; v < mesh.vertices.size(); v += 3) held.push_back({v});
                for (uint32_t t = 0; t < mesh.triangles.size(); t += 4) {
                    const auto& c = mesh.triangles[t];
                    held.push_back({c[0], c[1]});  // reflex
                    held.push_back({c[1], c[2]});  // convex
                    held.push_back({c[0], c[1], c[2]});
                }
                for (size_t k = 0; k < held.size(); ++k) {
                    glm::dvec3 p = mesh.vertices[held[k][0]];
                    const double s = (k % 7 + 1) / 16.0;
                    for (size_t c = 1; c < held[k].size(); ++c)
                        p += s * (mesh.vertices[held[k][c]] - mesh.vertices[held[k][0]]);
                    add_light(scene, p);
                }
                const uint32_t n = uint32_t(mesh.triangles.size());
                Part& part = plan.add(glass ? "glass" : "opaque", scene, LightsOnStar{n, uint32_t(held.size()), glass},
                                      {}, plan.rays(500'000, 6000));
                part.frame_numbers = [mesh, held](const glm::dvec3& center, double factor,
                                                  std::vector<double>& numbers) {
                    for (const auto& triangle : mesh.triangles)
                        for (const uint32_t v : triangle) {
                            const glm::dvec3 p = (mesh.vertices[v] - center) * factor;
                            numbers.insert(numbers.end(), {p.x, p.y, p.z});
                        }
                    for (const auto& corners : held) {
                        uint64_t bits = 0;
                        for (size_t t = 0; t < mesh.triangles.size(); ++t) {
                            size_t found = 0;
                            for (const uint32_t v : mesh.triangles[t])
                                found += size_t(std::count(corners.begin(), corners.end(), v));
                            bits |= uint64_t(found == corners.size()) << t;
                        }
                        numbers.insert(numbers.end(), {double(bits & 0x3fffffffu), double(bits >> 30)});
                    }
                };
            }
    }

    CISTULA_HD Vec3<double> corner(const Span<double>& numbers, uint32_t triangle, uint32_t c) const {
        const uint32_t k = 9 * triangle + 3 * c;
        return {numbers[k], numbers[k + 1], numbers[k + 2]};
    }

    /// Relation of the segment from p to l to a triangle: 0 misses it, 1 crosses it, 2 too close to its border to
    /// decide.
    CISTULA_HD int meets(const Span<double>& numbers, uint32_t triangle, const Vec3<double>& p, const Vec3<double>& l,
                         double doubt) const {
        const Vec3<double> a = corner(numbers, triangle, 0), b = corner(numbers, triangle, 1),
                           c = corner(numbers, triangle, 2);
        const Vec3<double> normal = normalized(cross(b - a, c - a));
        const double from = dot(normal, p - a), to = dot(normal, l - a);
        if (magnitude(from) <= doubt || magnitude(to) <= doubt) return 2;
        if ((from > 0) == (to > 0)) return 0;
        const Vec3<double> x = p + (l - p) * (from / (from - to));
        const double aside = doubt * (1 + length(l - p) / magnitude(from - to));
        double least_in = 1e300;
        for (uint32_t e = 0; e < 3; ++e) {
            const Vec3<double> first = corner(numbers, triangle, e),
                               edge = corner(numbers, triangle, (e + 1) % 3) - first;
            least_in = min_or_second(least_in, dot(cross(edge, x - first), normal) / length(edge));
        }
        return least_in > aside ? 1 : least_in < -aside ? 0 : 2;
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = draw.below(lights);
        const Vec3<double> at(setup.scene.lights[light].position);
        const Vec3<double> somewhere = in_ball(draw) * (1.9 * double(setup.extent()));
        const double nearer = draw.one_in(2) ? 1 : parity::two_to<double>(-draw.between(0, 8));
        const Vec3<Real> origin(at + (somewhere - at) * nearer);
        const uint32_t k = 9 * triangles + 2 * light;
        const uint64_t holding = uint64_t(setup.numbers[k]) | uint64_t(setup.numbers[k + 1]) << 30;
        const double doubt = 64 * double(RealTraits<Real>::unit) * double(setup.extent());  // as in half_spaces.h
        int between = 0;
        for (uint32_t t = 0; t < triangles; ++t) {
            if (holding >> t & 1u) continue;
            const int met = meets(setup.numbers, t, Vec3<double>(origin), at, doubt);
            if (met == 2) return;
            between += met;
        }
        const Vec3<Real> found = intersector.template transmittance<All>(shadow_ray(setup, origin, light));
        const Real expected = between == 0 ? Real(1)
                              : glass      ? parity::two_to<Real>(-glass_halvings * between)
                                           : Real(0);
        tally.witness(between != 0);
        tally.expect(found == Vec3<Real>(expected));
    }
};

}  // namespace cistula::verify::shadows
