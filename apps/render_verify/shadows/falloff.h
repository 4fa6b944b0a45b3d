// A plane under a light with falloff: I h / (h^2 + x^2)^(3/2).
#pragma once

#include "apps/render_verify/shadows/local_light.h"
#include "cistula/numerics/double_double.h"

namespace cistula::verify::shadows {

/// Rays down at a horizontal face. h and x are those of the point that the ray tree shades.
struct Falloff {
    static constexpr const char* name = "shadows/falloff";
    static constexpr const char* exact = "light on a plane under a lamp is I h/(h^2+x^2)^(3/2)";
    // In u, relative. The way to the light: 1 a component. Its square: 2 + 1 a product, 2 for two sums of positive
    // terms, 5; its root 2.5 + 1 = 3.5, the reciprocal 4.5; N.L = h times that: 1 + 4.5 + 1 = 6.5, the normal being
    // exact. kd N.L, C times it and I times it: 1 each where the factor is no power of two, but all are: 0. r^2: 7 + 1,
    // 1/r^2 9, the product 10. 16.5 in all; the sums' truncation 0.5 at what is tried. 17 u are 8.5 ulps of 2 u.
    static constexpr Bound bound = at_most(8.5, "ulps");
    static constexpr bool needs_witness = true;

    static void plan(Plan& plan) {
        for (const double scale : {1.0, 0x1p40, 0x1p-40})
            for (const double height : {0.5, 1.0, 3.0})
                for (const int body : {0, 1, 2}) {
                    SceneDescription scene = lit_scene();
                    scene.materials[0].color = glm::dvec3(1);
                    if (body == 2)
                        add_solid(scene, Shape::planes,
                                  solid_object(PlatonicSolid::cube, {0, 0, -scale}, 1.7320508075688772 * scale));
                    else
                        add_object(scene, square(scale, 0, body ? 16 : 1, false));
                    LightDescription& light = add_light(scene, glm::dvec3(0.25, -0.125, height) * scale);
                    light.color = glm::dvec3(scale * scale);
                    light.falloff = true;
                    light.radius = 0x1p-6 * scale;
                    Part& part = plan.add(body == 2 ? "cube"
                                          : body    ? "square of 512"
                                                    : "square",
                                          scene, Falloff(), {}, plan.rays(1'000'000, 2000));
                    part.frame_numbers = [scale](const glm::dvec3& center, double factor,
                                                 std::vector<double>& numbers) {
                        numbers = {-center.x * factor, -center.y * factor, -center.z * factor, scale * factor};
                    };
                }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const double half = setup.numbers[3];
        const Vec3<double> middle(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
        Vec3<double> at = draw.in_cube<double>(0.98 * half), from = draw.in_cube<double>(0.5 * half);
        at.z = 0, from.z = 0.25 * half + magnitude(from.z);
        const Vec3<Real> origin(middle + from);
        const Ray<Real> ray = ray_from(origin, normalized(Vec3<Real>(middle + at) - origin));
        const Hit<Real> hit = intersector.closest(ray);
        tally.expect(hit.found());
        if (!hit.found()) return;
        const Surface<Real> surface = surface_at<Real, All>(setup.scene, ray, hit);
        tally.expect(surface.normal == Vec3<Real>(Real(0), Real(0), Real(1)));
        const LocalLight lit = local_light(setup, intersector, ray, hit, surface, 0);
        const Light<Real>& light = setup.scene.lights[0];
        const Vec3<double> p(surface.viewer_side), l(light.position);
        const DoubleDouble x = two_sum(l.x, -p.x), y = two_sum(l.y, -p.y), h = two_sum(l.z, -p.z);
        const DoubleDouble square = x * x + y * y + h * h, ih = DoubleDouble(double(light.intensity.x)) * h;
        const DoubleDouble value =
            fast_two_sum(double(lit.radiance[0] >> 31) * 0x1p-31, double(lit.radiance[0] & 0x7fffffff) * 0x1p-62);
        if (!(value.high > 0x1p-8)) return;  // otherwise the sums have fewer digits than a double
        // v^2 r^6 over I^2 h^2 is 1 + 2 e: no root is taken.
        const DoubleDouble e = (value * value * (square * square * square) - ih * ih) / (ih * ih);
        tally.witness(lit.shadow_rays == 1);
        tally.measure(magnitude(double(e)) * 0.5 / (2 * double(RealTraits<Real>::unit)));
    }
};

}  // namespace cistula::verify::shadows
