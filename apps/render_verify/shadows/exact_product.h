// A shadow through faces of transmission 2^-k is 2^-(sum of k), also where triangles meet.
#pragma once

#include "apps/render_verify/shadows/local_light.h"

namespace cistula::verify::shadows {

/// A pile of sheets, each a grid of triangles. Numbers: the axis of the pile, and the coordinate on it where lines
/// begin.
struct ThroughSheets {
    static constexpr const char* name = "shadows/exact-product/sheets";
    static constexpr const char* exact = "through m sheets of transmission 2^-k exactly 2^-sum, at shared edges too";
    static constexpr Bound bound = no_failures("shadow rays");

    int loss[3];  // the last channel is opaque if it is negative

    static void plan(Plan& plan) {
        for (const uint32_t sheets : {1u, 2u, 5u, 20u})
            for (const bool stopped : {false, true})
                for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)}) {
                    SceneDescription scene = lit_scene();
                    ThroughSheets functor{{0, 0, 0}};
                    std::vector<glm::dvec3> points;
                    for (uint32_t s = 0; s < sheets; ++s) {
                        const int all = int((s * 5 + sheets) % 4), green = int(s % 3);
                        MaterialDescription glass = scene.materials[0];
                        glass.transmission = std::ldexp(1.0, -all);
                        glass.tint = {1, std::ldexp(1.0, -green), stopped && s == sheets / 2 ? 0 : 0.5};
                        functor.loss[0] += all, functor.loss[1] += all + green, functor.loss[2] += all + 1;
                        const TrianglesObject sheet = square(4, 0.04 * s - 0.4, 16, s % 2 != 0, rotation);
                        add_object(scene, sheet, add_material(scene, glass));
                        for (const uint32_t x : {6u, 7u, 8u, 9u, 10u})
                            for (const uint32_t y : {6u, 8u, 9u}) {
                                const glm::dvec3 &a = sheet.vertices[17 * y + x], &b = sheet.vertices[17 * y + x + 1],
                                                 &c = sheet.vertices[17 * y + x + 17];
                                points.insert(points.end(),
                                              {a, a + 0.5 * (b - a), a + 0.3125 * (c - a), 0.5 * (b + c)});
                            }
                    }
                    if (stopped) functor.loss[2] = -1;
                    const Rotation turned(rotation);
                    for (const glm::dvec3& light :
                         {glm::dvec3(0, 0, 2), glm::dvec3(0.5, -0.5, 2), glm::dvec3(0.37, 0.11, 1.5)})
                        add_light(scene, turned(light));
                    Part& part = plan.add(std::to_string(sheets) + (stopped ? " sheets, blue stopped" : " sheets"),
                                          scene, functor, points, plan.rays(400'000, 1000));
                    part.frame_numbers = [axis = turned(glm::dvec3(0, 0, 1))](const glm::dvec3& center, double factor,
                                                                              std::vector<double>& numbers) {
                        numbers = {axis.x, axis.y, axis.z, (-0.6 - dot(axis, center)) * factor};
                    };
                }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = draw.below(setup.scene.lights.size);
        const Vec3<double> from(setup.scene.lights[light].position),
            axis(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
        // At a corner, an edge or a diagonal of some sheet; every third line somewhere near, so that all go through all
        // sheets.
        Vec3<double> target(setup.point(draw.below(setup.points.size)));
        const Vec3<double> aside = draw.in_cube<double>(0.03125);
        if (draw.one_in(3)) target += aside;
        const double down = (setup.numbers[3] - dot(axis, from)) / dot(axis, target - from);
        const Vec3<Real> origin(from + (target - from) * down);
        const Vec3<Real> found = intersector.template transmittance<All>(shadow_ray(setup, origin, light));
        for (int c = 0; c < 3; ++c) tally.expect(found[c] == (loss[c] < 0 ? Real(0) : parity::two_to<Real>(-loss[c])));
    }
};

/// Closed solids of planes and of triangles in a row; solid s takes 2^-(1 << s) at each of its faces, so that the share
/// tells which were crossed, and how often. Numbers: how many numbers the planes of each take, then the planes.
struct ThroughSolids {
    static constexpr const char* name = "shadows/exact-product/solids";
    static constexpr const char* exact =
        "through closed solids exactly 2^-sum over two faces each, aimed at their edges";
    static constexpr Bound bound = no_failures("shadow rays");
    static constexpr bool needs_witness = true;
    static constexpr uint32_t solids = 5;

    static void plan(Plan& plan) {
        for (const bool first_of_triangles : {false, true})
            for (const double scale : {1.0, 0x1p40, 0x1p-40}) {
                SceneDescription scene = lit_scene();
                std::vector<SolidObject> all;
                std::vector<glm::dvec3> points;
                for (uint32_t s = 0; s < solids; ++s) {
                    const SolidObject solid =
                        solid_object(platonic_solids[s], glm::dvec3(0.35 * s - 0.7, 0, 0) * scale, 0.16 * scale,
                                     s % 2 ? glm::dvec3(0) : glm::dvec3(31, 47, 11));
                    MaterialDescription glass = scene.materials[0];
                    glass.transmission = std::ldexp(1.0, -(1 << s));
                    add_solid(scene, (s % 2 == 0) == first_of_triangles ? Shape::triangles : Shape::planes, solid,
                              add_material(scene, glass));
                    all.push_back(solid);
                    const std::vector<glm::dvec3> its = edge_points(solid);
                    points.insert(points.end(), its.begin(), its.end());
                }
                for (const glm::dvec3& light :
                     {glm::dvec3(1.5, 0, 0), glm::dvec3(1.25, 0.0625, -0.03), glm::dvec3(-1.5, 0.1, 1)})
                    add_light(scene, light * scale);
                Part& part = plan.add(first_of_triangles ? "triangles first" : "planes first", scene, ThroughSolids(),
                                      points, plan.rays(1'000'000, 4000));
                part.frame_numbers = [all](const glm::dvec3& center, double factor, std::vector<double>& numbers) {
                    std::vector<double> planes;
                    for (const SolidObject& solid : all) {
                        const size_t before = planes.size();
                        add_planes(solid, center, factor, planes);
                        numbers.push_back(double(planes.size() - before));
                    }
                    numbers.insert(numbers.end(), planes.begin(), planes.end());
                };
            }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = draw.below(setup.scene.lights.size);
        const Vec3<double> from(setup.scene.lights[light].position);
        const Vec3<double> target(setup.point(draw.below(setup.points.size)));
        // Length of the line beyond the target: past the whole scene.
        const double reach = 1.7 * double(setup.extent());
        const Vec3<double> way = normalized(target - from);
        const double ahead = dot(target, way);
        const double rest = reach * reach - (dot(target, target) - ahead * ahead);
        if (!(rest > 0)) return;
        const Vec3<Real> origin(target + way * (square_root(rest) - ahead));
        const ShadowRay<Real> shadow = shadow_ray(setup, origin, light);
        const Vec3<Real> found = intersector.template transmittance<All>(shadow);
        // 64 u M: points, corners, planes and direction round by a few u M each over a way of 4 M.
        const double doubt = 64 * double(RealTraits<Real>::unit) * double(setup.extent());
        const Vec3<double> start(shadow.ray.origin), direction = normalized(Vec3<double>(shadow.ray.direction));
        uint32_t sure = 0, possible = 0;
        uint32_t first = solids;
        for (uint32_t s = 0; s < solids; ++s) {
            const uint32_t size = uint32_t(setup.numbers[s]);
            const Span<double> planes{setup.numbers.data + first, size};
            first += size;
            if (chord(planes, doubt, start, direction) > doubt) sure |= 1u << s;
            if (chord(planes, -doubt, start, direction) >= -doubt) possible |= 1u << s;
        }
        uint32_t losses = 1;
        while (losses < 100 && found.x != parity::two_to<Real>(-int(losses) + 1)) ++losses;
        --losses;  // the share is 2^-losses; two faces a solid make it even
        const uint32_t crossed = losses / 2;
        tally.witness(sure != possible);
        tally.expect(losses < 99 && losses % 2 == 0 && (crossed & sure) == sure && (crossed & ~possible) == 0 &&
                     found.y == found.x && found.z == found.x);
    }
};

}  // namespace cistula::verify::shadows
