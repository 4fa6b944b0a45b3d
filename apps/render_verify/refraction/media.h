// Media side by side, overlapping and nested: the sequence of indices along a ray is that of the scene's description,
// without gaps of air where bodies touch.
#pragma once

#include <algorithm>

#include "apps/render_verify/case.h"
#include "apps/render_verify/refraction/bodies.h"

namespace cistula::verify::refraction {

/// Rays through faces that are all perpendicular to one axis; the sequence follows from the intervals alone.
struct MediaSequence {
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        const Span<double>& numbers = setup.numbers;
        const auto at = [&](double x, double y, double z) { return placed(numbers, x, y, z); };
        const uint32_t count = uint32_t(numbers[12]);
        const double reach = numbers[13], sine = numbers[14];
        const auto interval = [&](uint32_t k) { return numbers.data + 15 + 4 * k; };
        Draw draw = setup.draw(i);
        const uint32_t start = draw.below(count - 1);
        const double* from = interval(start);
        const auto [y, z] = place_on_face(draw, reach);  // the next one
        const Vec3<double> slope = in_ball(draw) * (sine / from[2]);
        const double across = square_root(1 - slope.y * slope.y - slope.z * slope.z);
        const double back = (from[1] - from[0]) * (0.0625 + 0.875 * draw.unit<double>()) / across;
        const Vec3<Real> target(at(from[1], y, z));
        const Vec3<Real> origin(at(from[1] - back * across, y - back * slope.y, z - back * slope.z));
        Ray<Real> ray = ray_from(origin, normalized(target - origin));
        surround(ray, uint32_t(from[3]));
        Lines<Real> lines;
        trace(setup, intersector, ray, lines);
        bool same = lines.whole();
        int line = 0;
        for (uint32_t k = start; k < count && same; ++k) {
            if (k > start && interval(k)[2] == interval(k - 1)[2]) continue;
            same = line < lines.count && lines.index[line] == interval(k)[2];
            ++line;
        }
        tally.expect(same && line == lines.count);
    }

    /// Adds parts for every order of the bodies in the file; `change` alters the compiled scene.
    template <class Functor, class Change>
    static void plan_bodies(Plan& plan, const std::vector<Form>& forms, const Change& change) {
        uint64_t number = 0;
        for (const Form form : forms)
            for (const Arrangement& arrangement : arrangements()) {
                std::vector<Body> bodies = arrangement.bodies;
                std::sort(bodies.begin(), bodies.end());
                do {
                    for (const glm::dvec3& turn : {glm::dvec3(0), glm::dvec3(20, 35, 50)}) {
                        Part& part = plan.add(label(form, arrangement.name, bodies, turn), scene_of(bodies, form, turn),
                                              Functor(), {}, plan.rays(20000, 100));
                        part.frame_numbers = [=](const glm::dvec3& center, double factor,
                                                 std::vector<double>& numbers) {
                            sequence_numbers(bodies, form, turn, center, factor, numbers);
                        };
                        change(part, number++);
                    }
                } while (std::next_permutation(bodies.begin(), bodies.end()));
            }
    }
};

struct MediaPlanes : MediaSequence {
    static constexpr const char* name = "refraction/media/planes";
    static constexpr const char* exact = "the sequence of indices through nested, abutting, overlapping solids";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) {
        plan_bodies<MediaPlanes>(plan, {Form::cubes}, [](Part&, uint64_t) {});
    }
};
struct MediaTriangles : MediaSequence {
    static constexpr const char* name = "refraction/media/triangles";
    static constexpr const char* exact = "the same through meshes, whose shared faces are cut in two ways";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) {
        plan_bodies<MediaTriangles>(plan, {Form::wide_boxes}, [](Part&, uint64_t) {});
    }
};
struct MediaMixed : MediaSequence {
    static constexpr const char* name = "refraction/media/planes-and-triangles";
    static constexpr const char* exact = "the same where a solid of planes shares a face with a mesh";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) {
        plan_bodies<MediaMixed>(plan, {Form::both}, [](Part&, uint64_t) {});
    }
};

/// Bodies moved by an ulp of M or not at all along each axis, so that shared faces have gaps and overlaps of up to
/// 2 ulps a coordinate: 7 u M, less than half of the 16 u M within which faces share a plane.
struct MediaMovedTriangles : MediaSequence {
    static constexpr const char* name = "refraction/media/within-rounding/triangles";
    static constexpr const char* exact = "the same where shared faces of meshes are ulps apart, or one in the other";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) {
        plan_bodies<MediaMovedTriangles>(plan, {Form::wide_boxes}, [](Part& part, uint64_t number) {
            part.edit([number, scene = part.scene](auto& compiled) { move_bodies(compiled, scene, number); });
        });
    }
};
struct MediaMovedPlanes : MediaSequence {
    static constexpr const char* name = "refraction/media/within-rounding/planes";
    static constexpr const char* exact =
        "the same where shared faces of solids of planes are ulps apart, or one in the other";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) {
        plan_bodies<MediaMovedPlanes>(plan, {Form::cubes}, [](Part& part, uint64_t number) {
            part.edit([number, scene = part.scene](auto& compiled) { move_bodies(compiled, scene, number); });
        });
    }
};

/// Eight cubes of one glass that share faces, edges and a corner act as one cube: a ray inside is in one medium,
/// however it is reflected.
struct Octants {
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> target = setup.point(draw.below(setup.points.size));
        const Vec3<double> way = on_sphere(draw);
        const Vec3<Real> origin(Vec3<double>(target) + way * (setup.numbers[0] * (2.5 + draw.unit<double>())));
        Lines<Real> lines;
        trace(setup, intersector, ray_from(origin, normalized(target - origin)), lines);
        bool one_body = lines.flags == 0 && lines.count >= 2 && lines.index[0] == 1 && lines.index[1] == 1.5;
        for (int k = 2; k < lines.count; ++k) one_body = one_body && lines.index[k] <= lines.index[k - 1];
        tally.expect(one_body && (lines.cut || lines.index[lines.count - 1] == 1));
    }
    template <class Functor>
    static void plan_octants(Plan& plan, const std::vector<Form>& forms) {
        for (const Form form : forms)
            for (const glm::dvec3& turn : {glm::dvec3(0), glm::dvec3(20, 35, 50)}) {
                const Rotation rotation(turn);
                SceneDescription scene = empty_scene();
                const int material = add_material(scene, glass(1.5));
                for (int octant = 0; octant < 8; ++octant) {
                    const glm::dvec3 center((octant & 1) - 0.5, (octant >> 1 & 1) - 0.5, (octant >> 2) - 0.5);
                    const bool cube = form == Form::cubes || (form == Form::both && octant % 3 == 0);
                    if (cube)
                        add_object(scene, solid_object(PlatonicSolid::cube, rotation(center), std::sqrt(0.75), turn),
                                   material);
                    else
                        add_object(scene, box_mesh(center - 0.5, center + 0.5, rotation, octant % 2 != 0), material);
                }
                // On the faces, edges and corner that they share, well within the whole.
                std::vector<glm::dvec3> points;
                for (int x = -7; x <= 7; ++x)
                    for (int y = -7; y <= 7; ++y)
                        for (const glm::dvec3& p : {glm::dvec3(0, x, y), glm::dvec3(x, 0, y), glm::dvec3(x, y, 0)})
                            points.push_back(rotation(p / 8.0));
                Part& part = plan.add(form == Form::cubes  ? "planes"
                                      : form == Form::both ? "planes and meshes"
                                                           : "meshes",
                                      scene, Functor(), points, plan.rays(200000, 2500));
                part.frame_numbers = [](const glm::dvec3&, double factor, std::vector<double>& numbers) {
                    numbers = {factor};
                };
            }
    }
};
struct MediaOctants : Octants {
    static constexpr const char* name = "refraction/media/octants";
    static constexpr const char* exact = "eight cubes of one glass: never out of it and in again";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) { plan_octants<MediaOctants>(plan, {Form::cubes, Form::wide_boxes}); }
};
struct MediaMixedOctants : Octants {
    static constexpr const char* name = "refraction/media/octants/planes-and-triangles";
    static constexpr const char* exact = "the same, some of planes and some meshes";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) { plan_octants<MediaMixedOctants>(plan, {Form::both}); }
};

}  // namespace cistula::verify::refraction
