// Lights on a solid's surface: the outside gets no light of them, the inside all, except the faces on which they lie.
#pragma once

#include "apps/render_verify/shadows/acne.h"
#include "apps/render_verify/shadows/half_spaces.h"

namespace cistula::verify::shadows {

/// Rays at a solid from outside or from inside. Numbers as for HalfSpaces, then the solid's center and inradius.
struct OwnLight : HalfSpaces {
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent()), doubt = 64 * double(RealTraits<Real>::unit) * extent;
        const uint32_t light = draw.below(lights);
        const bool within = draw.one_in(2);
        const uint32_t first = lights, last = first + 4 * faces;
        const Vec3<double> middle(setup.numbers[last], setup.numbers[last + 1], setup.numbers[last + 2]);
        const double inradius = setup.numbers[last + 3];
        const Vec3<double> away = on_sphere(draw);
        const Vec3<double> target = in_ball(draw);
        const Vec3<Real> origin(within ? middle + target * (0.8 * inradius) : away * (1.9 * extent));
        const Vec3<Real> way = within ? Vec3<Real>(away) : Vec3<Real>(target * extent) - origin;
        Ray<Real> ray = ray_from(origin, normalized(way));
        if (within) ray.media.add(0, 1);
        const Hit<Real> hit = intersector.closest(ray);
        if (within) tally.expect(hit.found());
        if (!hit.found()) return;
        const Surface<Real> surface = surface_at<Real, All>(setup.scene, ray, hit);
        const LocalLight lit = local_light(setup, intersector, ray, hit, surface, light);
        const LocalLight open = local_light(setup, Unshadowed(), ray, hit, surface, light);
        // The face that is hit, by its normal, and whether the light lies on it.
        const uint32_t incident = uint32_t(setup.numbers[light]);
        double depth = 1e300;
        bool holds = false;
        const Vec3<double> normal = Vec3<double>(surface.normal) * (within ? -1.0 : 1.0);
        for (uint32_t f = 0; f < faces; ++f) {
            const uint32_t k = first + 4 * f;
            if (!(dot(Vec3<double>(setup.numbers[k], setup.numbers[k + 1], setup.numbers[k + 2]), normal) > 0.9))
                continue;
            holds = (incident >> f & 1u) != 0;
            depth = -height(setup.numbers, 0, f, Vec3<double>(setup.scene.lights[light].position));
        }
        const bool reached = within && !holds && depth > doubt;
        tally.witness(reached && lit.shadow_rays != 0);
        tally.expect(lit == open && lit.flags == 0 && (reached ? lit.radiance[0] > 0 : lit.dark()));
    }
};

template <class Functor>
void plan_own_light(Plan& plan, Shape shape) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)})
            for (const bool glass : {false, true}) {
                SceneDescription scene = lit_scene();
                scene.materials[0] = glass_or_opaque(scene, glass);
                scene.materials[0].specular = 1;
                const SolidObject solid = solid_object(kind, glm::dvec3(0), 1, rotation);
                add_solid(scene, shape, solid);
                const std::vector<OnSolid> on = places_on(platonic_shape(kind));
                const Rotation turned(rotation);
                for (const OnSolid& light : on) add_light(scene, turned(light.place));
                Part& part =
                    plan.add(std::string(platonic_name(kind)) + (glass ? ", glass" : ", opaque"), scene,
                             Functor{{{1, uint32_t(platonic_shape(kind).faces.size()), uint32_t(on.size()), glass}}},
                             {}, plan.rays(300'000, 4000));
                add_half_spaces(part, {solid}, {on});
                part.frame_numbers = [first = part.frame_numbers, solid](const glm::dvec3& center, double factor,
                                                                         std::vector<double>& numbers) {
                    first(center, factor, numbers);
                    const glm::dvec3 middle = (solid.center - center) * factor;
                    const double inradius = platonic_shape(solid.solid).inradius * solid.radius * factor;
                    numbers.insert(numbers.end(), {middle.x, middle.y, middle.z, inradius});
                };
            }
}

struct OwnLightPlanes : OwnLight {
    static constexpr const char* name = "shadows/own-lights/planes";
    static constexpr const char* exact = "lights on a solid leave its outside black and reach all of its inside";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_own_light<OwnLightPlanes>(plan, Shape::planes); }
};

struct OwnLightTriangles : OwnLight {
    static constexpr const char* name = "shadows/own-lights/triangles";
    static constexpr const char* exact = "lights on a mesh leave its outside black and reach all of its inside";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_own_light<OwnLightTriangles>(plan, Shape::triangles); }
};

/// Shading at the very position of a light on a face, and at the next points: no light, and no NaN.
struct LightAtThePoint {
    static constexpr const char* name = "shadows/light-at-the-point";
    static constexpr const char* exact = "a light at the point that is shaded, in its face: 0, never NaN";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void plan(Plan& plan) {
        for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)})
            for (const Body body : {Body::planes, Body::triangles, Body::sheet})
                for (const bool falloff : {false, true}) {
                    SceneDescription scene = lit_scene();
                    scene.materials[0].specular = 1;
                    const SolidObject solid =
                        solid_object(PlatonicSolid::cube, glm::dvec3(0), 1.7320508075688772, rotation);
                    if (body == Body::sheet)
                        add_object(scene, square(1, 1, 4, false, rotation));
                    else
                        add_solid(scene, body == Body::planes ? Shape::planes : Shape::triangles, solid);
                    const Rotation turned(rotation);
                    std::vector<glm::dvec3> points;
                    for (const glm::dvec3& p : {glm::dvec3(0, 0, 1), glm::dvec3(0.5, 0.5, 1), glm::dvec3(0.3, -0.7, 1),
                                                glm::dvec3(-0.5, 0.25, 1), glm::dvec3(0.125, 0.125, 1)}) {
                        points.push_back(turned(p));
                        LightDescription& light = add_light(scene, points.back());
                        light.falloff = falloff;
                        light.radius = falloff ? 0x1p-16 : 0;
                    }
                    plan.add(body == Body::planes      ? "planes"
                             : body == Body::triangles ? "triangles"
                                                       : "a square",
                             scene, LightAtThePoint(), points, plan.rays(200'000, 4000));
                }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = uint32_t(i % setup.points.size);
        const Vec3<Real> at = setup.point(light);
        Vec3<double> away = on_sphere(draw);
        if (dot(away, Vec3<double>(at)) < 0) away = -away;  // mostly from over the face
        const int closeness = draw.between(8, 30);
        const Vec3<double> aside = draw.in_cube<double>(draw.one_in(2) ? 0 : parity::two_to<double>(-closeness));
        const Vec3<Real> target(Vec3<double>(at) + aside);
        const Ray<Real> ray = ray_from(Vec3<Real>(away * 1.9), normalized(target - Vec3<Real>(away * 1.9)));
        const Hit<Real> hit = intersector.closest(ray);
        tally.witness(hit.found());
        if (hit.found()) {
            const Surface<Real> surface = surface_at<Real, All>(setup.scene, ray, hit);
            const LocalLight lit = local_light(setup, intersector, ray, hit, surface, light);
            // Faces other than the light's look away from it, or, seen from below, are not reached by this ray.
            tally.expect(lit.flags == 0 && lit.dark());
        }
        const ShadowRay<Real> none = shadow_ray(setup, setup.scene.lights[light].position, light);
        const Vec3<Real> found = intersector.template transmittance<All>(none);
        tally.expect(found == Vec3<Real>(Real(0)) || found == Vec3<Real>(Real(1)));
    }
};

}  // namespace cistula::verify::shadows
