// No light leaves a closed opaque solid, not through its edges and corners either; glass transmits its exact share.
#pragma once

#include "apps/render_verify/shadows/local_light.h"
#include "apps/render_verify/stage.h"

namespace cistula::verify::shadows {

/// Lights inside a solid: in the middle, near its faces, edges and corners.
inline uint32_t add_lights_inside(SceneDescription& scene, const SolidObject& solid) {
    const PlatonicShape& shape = platonic_shape(solid.solid);
    const Rotation turned(solid.rotation);
    const auto add = [&](const glm::dvec3& p) { add_light(scene, solid.center + turned(p) * solid.radius); };
    const auto& edge = shape.edges.back();
    add({0, 0, 0});
    add(shape.faces.front().normal * (shape.inradius * (1 - 0x1p-10)));
    add(shape.vertices.front() * (1 - 0x1p-8));
    add((shape.vertices[edge.vertices[0]] * 0.75 + shape.vertices[edge.vertices[1]] * 0.25) * (1 - 0x1p-8));
    return uint32_t(scene.lights.size());
}

/// Points outside a solid with lights inside. Numbers: the radius, the rounding of scene units, the solid's planes from
/// first_plane on.
struct FromOutside {
    static constexpr uint32_t first_plane = 2;
    uint32_t solid;
    int halvings;  // of the light at each face; negative: opaque

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = draw.below(setup.scene.lights.size);
        const Vec3<double> from(setup.scene.lights[light].position);
        const Vec3<double> target(setup.points[uint32_t(i % setup.points.size)]);
        // Beyond an edge or a corner, in the line of the light; some a hair beside it.
        const double extent = double(setup.extent()), radius = setup.numbers[0];
        double beyond = 1 + parity::two_to<double>(-draw.between(0, 8));
        if (draw.one_in(4)) beyond = 1 + draw.unit<double>() * (extent / radius);
        const Vec3<double> jitter = draw.in_cube<double>(8 * double(RealTraits<Real>::unit) * extent);
        const bool exact = draw.one_in(2);
        const Vec3<Real> origin(from + (target - from) * beyond + (exact ? Vec3<double>(0.0) : jitter));
        if (dot(origin, origin) > Real(4 * extent * extent)) return;
        double over = -1e300;
        for (uint32_t k = first_plane; k + 3 < setup.numbers.size; k += 4)
            over = max_or_second(over, dot(Vec3<double>(setup.numbers[k], setup.numbers[k + 1], setup.numbers[k + 2]),
                                           Vec3<double>(origin)) -
                                           setup.numbers[k + 3]);
        // Outside for sure: planes, corners and points are rounded by a few u M each.
        if (!(over > 32 * double(RealTraits<Real>::unit) * extent + setup.numbers[1])) return;
        const ShadowRay<Real> shadow = shadow_ray(setup, origin, light);
        const Vec3<Real> found = intersector.template transmittance<All>(shadow);
        tally.expect(found == Vec3<Real>(halvings < 0 ? Real(0) : parity::two_to<Real>(-halvings)));
        if (halvings < 0)
            tally.expect(intersector.template transmittance<Effects<opaque_bodies | effect_lights_on_faces>>(shadow) ==
                         Real(0));
    }
};

/// Adds the parts. `tiny`: only the solid that is a few floating-point numbers wide; else all others.
template <class Functor>
void plan_boxes(Plan& plan, Shape shape, int halvings, bool tiny) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const Placement& placement : placements())
            for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)}) {
                if (placement.beside_unit != tiny) continue;
                PlacedSolid placed = placed_solid(kind, shape, placement, rotation);
                placed.scene.materials[0].transmission = halvings < 0 ? 0 : std::ldexp(1.0, -halvings);
                add_lights_inside(placed.scene, placed.solid);
                Part& part = plan.add(placed.label, placed.scene, Functor{{placed.number, halvings}},
                                      edge_points(placed.solid), plan.rays(200'000, 1000));
                part.frame_numbers = [solid = placed.solid](const glm::dvec3& center, double factor,
                                                            std::vector<double>& numbers) {
                    numbers = {solid.radius * factor, 0x1p-51 * (length(solid.center) + solid.radius) * factor};
                    add_planes(solid, center, factor, numbers);
                };
            }
}

struct BoxPlanes : FromOutside {
    static constexpr const char* name = "shadows/closed-box/planes";
    static constexpr const char* exact = "0 light outside closed opaque solids, aimed through edges and corners";
    static constexpr Bound bound = no_failures("shadow rays");
    static void plan(Plan& plan) { plan_boxes<BoxPlanes>(plan, Shape::planes, -1, false); }
};

struct BoxTriangles : FromOutside {
    static constexpr const char* name = "shadows/closed-box/triangles";
    static constexpr const char* exact = "0 light outside closed opaque meshes, aimed through edges and corners";
    static constexpr Bound bound = no_failures("shadow rays");
    static void plan(Plan& plan) { plan_boxes<BoxTriangles>(plan, Shape::triangles, -1, false); }
};

/// A solid of 8 to 16 ulps of its coordinates: no light in it is farther from its faces than what counts as on them.
struct BoxTiny : FromOutside {
    static constexpr const char* name = "shadows/closed-box/tiny";
    static constexpr bool float_warns = true;
    static constexpr const char* exact = "the same of a solid of radius 2^-20 beside a unit one";
    static constexpr Bound bound = no_failures("shadow rays");
    static void plan(Plan& plan) {
        plan_boxes<BoxTiny>(plan, Shape::planes, -1, true);
        plan_boxes<BoxTiny>(plan, Shape::triangles, -1, true);
    }
};

struct InsideGlassPlanes : FromOutside {
    static constexpr const char* name = "shadows/light-inside/planes";
    static constexpr const char* exact = "a light inside a glass solid: one face's share outside";
    static constexpr Bound bound = no_failures("shadow rays");
    static void plan(Plan& plan) { plan_boxes<InsideGlassPlanes>(plan, Shape::planes, 3, false); }
};

struct InsideGlassTriangles : FromOutside {
    static constexpr const char* name = "shadows/light-inside/triangles";
    static constexpr const char* exact = "a light inside a glass mesh: one face's share outside";
    static constexpr Bound bound = no_failures("shadow rays");
    static void plan(Plan& plan) { plan_boxes<InsideGlassTriangles>(plan, Shape::triangles, 3, false); }
};

/// A floor around opaque solids with lights inside, rendered.
struct BoxPixels {
    static constexpr const char* name = "shadows/closed-box/pixels";
    static constexpr const char* exact = "every pixel of a floor around opaque solids with lights in them is 0";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void render(Stage& stage, Tally& tally) {
        const int width = stage.quick ? 40 : 320, height = stage.quick ? 30 : 240;
        for (int k = 0; k < 6; ++k) {
            SceneDescription scene = lit_scene();
            scene.camera.position = {0.3, -6, 3};
            scene.camera.target = {0, 0, -0.5};
            add_object(scene, square(8, -1.25, 4, false));
            const SolidObject solid = solid_object(platonic_solids[k % 5], {0.1, 0.2, 0}, 1.2, {17, 41, 73});
            if (k < 5)
                add_solid(scene, k % 2 ? Shape::planes : Shape::triangles, solid);
            else
                add_object(scene, torus(1.2, 0.5, 24, 12));
            if (k < 5)
                add_lights_inside(scene, solid);
            else
                for (const double a : {0.1, 2.0, 4.0}) add_light(scene, {1.2 * std::cos(a), 1.2 * std::sin(a), 0.3});
            Film film = stage.render(scene, width, height);
            for (const PixelRecord& pixel : film.pixels) {
                ++tally.place;
                tally.expect(pixel.radiance[0] == 0 && pixel.radiance[1] == 0 && pixel.radiance[2] == 0);
            }
            // The picture with a light outside is not dark, so nothing else darkens it.
            add_light(scene, {0.5, -3, 4});
            film = stage.render(scene, width, height);
            int lit = 0;
            for (const PixelRecord& pixel : film.pixels) lit += pixel.radiance[0] != 0;
            tally.expect(lit > width * height / 4);
            tally.witness(lit > 0);
        }
    }
};

}  // namespace cistula::verify::shadows
