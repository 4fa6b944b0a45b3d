// Many visible lights: which one a ray hits, and how a picture shows them.
#pragma once

#include "apps/render_verify/shadows/local_light.h"
#include "apps/render_verify/stage.h"
#include "cistula/lights/visible_light.h"

namespace cistula::verify::shadows {

/// The tree over lights compared with a plain loop.
struct VisibleLightTree {
    static constexpr const char* name = "shadows/seen-lights/tree";
    static constexpr const char* exact =
        "(t, light) of trees over seen lights, anywhere or on edges, equals a plain loop's";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool own_traversal = true, needs_witness = true;

    static void plan(Plan& plan) {
        for (const double radius : {0x1p-4, 0x1p-8, 0x1p-14}) {
            SceneDescription scene = lit_scene();
            add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube, glm::dvec3(0), 0.125));
            std::vector<glm::dvec3> points;
            for (uint32_t k = 0; k < 4096; ++k) {
                Draw draw(k, 77);
                glm::dvec3 p = draw.in_cube<double>(1.0);
                if (k % 16 == 1) p = points.back();  // two at one position
                if (k % 16 == 2) p = points.back() + glm::dvec3(radius, 0, 0);
                if (k % 16 == 3) p.z = 0;
                LightDescription& light = add_light(scene, p);
                light.color = glm::dvec3(0);
                light.glow = glm::dvec3(1);
                light.radius = radius * (k % 5 ? 1 : 0.5);
                points.push_back(p);
            }
            plan.add("radius " + std::to_string(radius), scene, VisibleLightTree(), {}, plan.rays(100'000, 2500));
        }
        // On the edges of several solids.
        for (const double radius : {0x1p-4, 0x1p-8, 0x1p-14}) {
            SceneDescription scene = lit_scene();
            double k = 0;
            for (const PlatonicSolid shape :
                 {PlatonicSolid::tetrahedron, PlatonicSolid::cube, PlatonicSolid::octahedron,
                  PlatonicSolid::dodecahedron, PlatonicSolid::icosahedron}) {
                SolidObject solid = solid_object(shape, {k - 2, k * 0.25 - 0.5, 0.125 * k}, 0.5, {17 * k, 41, 73});
                solid.edge_lights = {6, glm::dvec3(0), glm::dvec3(1), radius, true, false, ""};
                add_solid(scene, Shape::planes, solid);
                ++k;
            }
            plan.add("on edges, radius " + std::to_string(radius), scene, VisibleLightTree(), {},
                     plan.rays(100'000, 2500));
        }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t aim = draw.below(setup.scene.visible_lights.size);
        const VisibleLight<Real>& light = setup.scene.visible_lights[aim];
        const Vec3<double> from = in_ball(draw);
        const Vec3<double> aside = on_sphere(draw);
        const int graze = draw.between(0, 3);  // the middle, the rim, half of it, anywhere
        const double share = graze == 0 ? 0 : graze == 1 ? 1 : graze == 2 ? 0.5 : 40 * draw.unit<double>();
        const Vec3<Real> origin(draw.one_in(8) ? Vec3<double>(light.center) : from * (1.9 * double(setup.extent())));
        const Vec3<Real> target(Vec3<double>(light.center) + aside * (share * double(light.radius)));
        const Ray<Real> ray = ray_from(origin, normalized(target - origin));
        if (!is_finite(ray)) return;
        const Real limit = draw.one_in(2) ? RealTraits<Real>::infinity : Real(4) * draw.unit<Real>();
        const VisibleLightHit<Real> found = closest_visible_light(setup.scene, ray, limit);
        VisibleLightHit<Real> expected;
        expected.t = limit;
        for (uint32_t k = 0; k < setup.scene.visible_lights.size; ++k)
            intersect_visible_light(setup.scene, k, ray, expected);
        tally.witness(expected.light != no_light);
        tally.expect(found.t == expected.t && found.light == expected.light);
    }
};

/// A wall of lights that are only visible, some in front of others, behind an octahedron that hides some of them.
struct VisibleLightPixels {
    static constexpr const char* name = "shadows/seen-lights/pixels";
    static constexpr const char* exact = "a picture of 4,096 seen lights: the glow of the nearest, every digit";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        const int width = stage.quick ? 40 : 320, height = stage.quick ? 30 : 240;
        const SolidObject solid = solid_object(PlatonicSolid::octahedron, {0.5, -1.5, 0.25}, 0.5, {17, 41, 73});
        SceneDescription scene = lit_scene();
        scene.camera.position = {0, -4, 0};
        scene.camera.target = {0, 0, 0};
        scene.camera.field_of_view = 60;
        scene.background = glm::dvec3(0.03125, 0, 0);
        add_solid(scene, Shape::planes, solid);
        for (uint32_t k = 0; k < 4096; ++k) {
            LightDescription& light = add_light(scene, {(k % 64) / 16.0 - 2, k % 3 * 0.125, (k / 64) / 16.0 - 2});
            light.color = glm::dvec3(0);
            light.radius = 0.025;
            light.glow = glm::dvec3(0.125 + (k % 64) / 64.0, 0.125 + (k / 64) / 64.0, 0.25);
        }
        const Film film = stage.render(scene, width, height);
        std::vector<double> planes;
        add_planes(solid, scene.camera.position, 1, planes);
        const double half = 0.57735026918962576451;  // tan 30 degrees
        // How near to a silhouette a pixel's ray may pass: the rounding of directions, centers and radii over a way of
        // 4 M, 2^-16 and less in float.
        const double doubt = 0x1p-14;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const glm::dvec3 way((2.0 * x + 1 - width) * half / width, 1, -(2.0 * y + 1 - height) * half / width);
                const glm::dvec3 direction = way / std::sqrt(dot(way, way));
                const Span<double> of{planes.data(), uint32_t(planes.size())};
                const bool hidden = chord(of, doubt, glm::dvec3(0), direction) > doubt;
                bool sure = hidden || chord(of, -doubt, glm::dvec3(0), direction) < -doubt;
                glm::dvec3 expected = hidden ? glm::dvec3(0) : scene.background;
                double nearest = 1e300;
                for (const LightDescription& light : scene.lights) {
                    if (hidden) break;
                    const glm::dvec3 to = light.position - scene.camera.position;
                    const double along_way = dot(to, direction);
                    const glm::dvec3 across = to - along_way * direction;
                    const double beside = std::sqrt(dot(across, across)) - light.radius;
                    sure &= std::fabs(beside) > doubt;
                    if (beside > 0) continue;
                    const double t = along_way - std::sqrt(light.radius * light.radius - dot(across, across));
                    if (t < nearest) nearest = t, expected = *light.glow;
                }
                ++tally.place;
                if (!sure) continue;
                const PixelRecord& pixel = film.pixels[size_t(y) * size_t(width) + size_t(x)];
                bool equal = true;
                for (int c = 0; c < 3; ++c)
                    equal &=
                        double(pixel.radiance[c]) == std::ldexp(expected[c], film.fixed_shift - film.radiance_exponent);
                tally.witness(!hidden && nearest < 1e300);
                tally.expect(equal);
            }
    }
};

}  // namespace cistula::verify::shadows
