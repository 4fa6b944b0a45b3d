// Rays with components that are not finite: they hit nothing, and queries terminate.
#pragma once

#include "apps/render_verify/geometry/upright_solids.h"
#include "cistula/shading/shadow.h"

namespace cistula::verify::geometry {

/// Adds a part with twenty overlapping solids and a light.
template <class Functor>
void plan_twenty(Plan& plan) {
    for (const Shape shape : {Shape::planes, Shape::triangles}) {
        SceneDescription scene = empty_scene();
        for (int k = 0; k < 20; ++k)
            add_solid(scene, shape, solid_object(platonic_solids[k % 5], {k % 5 - 2.0, k / 5 - 2.0, 0}, 0.7));
        add_light(scene, {0, 0, 3});
        plan.add("20 solids" + shape_name(shape), scene, Functor{}, {{0, 0, 0}}, plan.rays(1'000'000, 20000));
    }
}

struct NotFiniteRays {
    static constexpr const char* name = "geometry/not-finite-rays";
    static constexpr const char* exact = "NaN or infinity in origin or direction: a miss and no light";
    static constexpr Bound bound = no_failures("rays");

    static void plan(Plan& plan) { plan_twenty<NotFiniteRays>(plan); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        Ray<Real> ray = ray_from(Vec3<Real>(on_sphere(draw)), Vec3<Real>(on_sphere(draw)));
        const uint32_t broken = 1 + draw.below(63);  // bits: which of the six numbers
        for (int k = 0; k < 6; ++k) {
            const uint32_t kind = draw.below(3);
            const Real bad = kind == 0   ? parity::no_number<Real>
                             : kind == 1 ? RealTraits<Real>::infinity
                                         : -RealTraits<Real>::infinity;
            if (broken >> k & 1u) (k < 3 ? ray.origin[k] : ray.direction[k - 3]) = bad;
        }
        if (draw.one_in(4)) ray.media.add(draw.below(20), 1);
        const ShadowRay<Real> shadow{ray, Real(1), &setup.scene.lights[0]};
        const Vec3<Real> light = intersector.template transmittance<Effects<all_effects>>(shadow);
        tally.expect(!intersector.closest(ray).found() && light.x == Real(0) && light.y == Real(0) &&
                     light.z == Real(0));
    }
};

/// Rays with finite but extreme directions: hits are in order, and queries terminate. Rays start within 2 M and
/// directions are no longer than 1, as the renderer's are: Embree's own checks abort on numbers above 2^60.
struct ExtremeRays {
    static constexpr const char* name = "geometry/extreme-rays";
    static constexpr const char* exact = "subnormal numbers, zeros, no direction at all: crossings in order, to an end";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) { plan_twenty<ExtremeRays>(plan); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Real least = parity::two_to<Real>(1 - parity::Layout<Real>::bias - parity::Layout<Real>::digits);
        Ray<Real> ray = ray_from(Vec3<Real>(on_sphere(draw)), Vec3<Real>(on_sphere(draw)));
        const uint32_t changed = 1 + draw.below(63);
        for (int k = 0; k < 6; ++k) {
            const Real numbers[] = {RealTraits<Real>::least_normal,
                                    -RealTraits<Real>::least_normal,
                                    least,
                                    -least,
                                    Real(0),
                                    Real(-0.0),
                                    Real(1e-20),
                                    Real(-1e-30)};
            const Real extreme = numbers[draw.below(8)];
            if (changed >> k & 1u) (k < 3 ? ray.origin[k] : ray.direction[k - 3]) = extreme;
        }
        if (draw.one_in(8)) ray.direction = Vec3<Real>(Real(0));
        tally.expect(cross_all(intersector, ray).in_order);
    }
};

}  // namespace cistula::verify::geometry
