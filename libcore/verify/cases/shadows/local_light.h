// The contribution of one light at a hit, as the ray tree computes it, with and without shadows.
#pragma once

#include "cistula/numerics/double_double.h"
#include "cistula/shading/lighting.h"
#include "cistula/transport/pixel_sums.h"
#include "verify/cases/shadows/transmittance.h"

namespace cistula::verify::shadows {

/// Contribution of a light, with radiance in units of 2^-62.
struct LocalLight {
    int64_t radiance[3];
    uint32_t shadow_rays, flags;

    CISTULA_HD bool operator==(const LocalLight& o) const {
        return radiance[0] == o.radiance[0] && radiance[1] == o.radiance[1] && radiance[2] == o.radiance[2] &&
               flags == o.flags;
    }
    CISTULA_HD bool dark() const { return radiance[0] == 0 && radiance[1] == 0 && radiance[2] == 0; }
};

/// A stand-in for an intersector: all light arrives.
struct Unshadowed {
    template <class Real, class Media>
    CISTULA_HD Hit<Real> closest(const Ray<Real, Media>&) const {
        return Hit<Real>();
    }
    template <class E, class Real, class Media>
    CISTULA_HD Vec3<Real> transmittance(const ShadowRay<Real, Media>&) const {
        return Vec3<Real>(Real(1));
    }
};

template <class Real, class Tracer>
CISTULA_HD inline LocalLight local_light(const Setup<Real>& setup, const Tracer& intersector, const Ray<Real>& ray,
                                         const Hit<Real>& hit, const Surface<Real>& surface, uint32_t light) {
    SceneView<Real> one_light = setup.scene;
    one_light.lights = {setup.scene.lights.data + light, 1};
    TreeSettings settings;
    settings.fixed_scale = 0x1p62;
    settings.fixed_unit = 0x1p-62;
    PixelRecord record{};
    uint32_t flags = 0;
    PixelSums<Real> sums(settings, one_light, record, flags);
    PixelRays rays;
    SurfaceEvent<Real> event;
    event.begin(ray, hit);
    add_local_light<Real, All>(one_light, intersector, ray, event, surface, Vec3<Real>(Real(1)), sums, rays);
    return {{record.radiance[0], record.radiance[1], record.radiance[2]}, rays.shadow, flags};
}

/// No face and no convex body shadows itself: a face toward a light is fully lit, bit for bit. Rays at a convex body
/// from all around, with one light each. Numbers: the body's center and radius.
struct LitInFull {
    uint32_t solid;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> middle = setup.vector(0);
        const double radius = setup.numbers[3];
        const double extent = double(setup.extent());
        const double away = min_or_second(2.5 * radius, 1.95 * extent - length(middle));
        const Vec3<double> from = on_sphere(draw);
        const Vec3<double> at = in_ball(draw);
        const Vec3<Real> origin(middle + from * away), target(middle + at * (0.9 * radius));
        const Ray<Real> ray = ray_from(origin, normalized(target - origin));
        const Hit<Real> hit = intersector.closest(ray);
        if (!hit.found() || key_solid(hit.key) != solid) return;
        const uint32_t light = draw.below(setup.scene.lights.size);
        const Surface<Real> surface = surface_at<Real, All>(setup.scene, ray, hit);
        const LocalLight lit = local_light(setup, intersector, ray, hit, surface, light);
        const LocalLight open = local_light(setup, Unshadowed(), ray, hit, surface, light);
        // Where the light is clearly over or under the face: beyond what counts as in its plane (16 u M), the start of
        // the line (8 u M over the face) and the rounding of a dot product (5 u of the distance), all twice.
        const Vec3<double> way = Vec3<double>(setup.scene.lights[light].position) - Vec3<double>(surface.point);
        const double over = dot(Vec3<double>(surface.normal), way);
        const double distance = length(way);
        const double doubt = double(RealTraits<Real>::unit) * (48 * extent + 10 * distance);
        tally.witness(lit.shadow_rays != 0 && over < distance * 0x1p-6);
        tally.expect(lit == open && lit.flags == 0 &&
                     (over > doubt ? lit.radiance[0] > 0 : over >= -doubt || lit.dark()));
    }
};

/// Rays at a solid from outside or from inside. Numbers as for HalfSpaces, then the solid's center and inradius.
struct OwnLight : HalfSpaces {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        const double doubt = setup.units(64);
        const uint32_t light = draw.below(lights);
        const bool within = draw.one_in(2);
        const uint32_t first = lights;
        const uint32_t last = first + 4 * faces;
        const Vec3<double> middle = setup.vector(last);
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
            if (!(dot(setup.vector(k), normal) > 0.9)) continue;
            holds = (incident >> f & 1u) != 0;
            depth = -height(setup.numbers, 0, f, Vec3<double>(setup.scene.lights[light].position));
        }
        const bool reached = within && !holds && depth > doubt;
        tally.witness(reached && lit.shadow_rays != 0);
        tally.expect(lit == open && lit.flags == 0 && (reached ? lit.radiance[0] > 0 : lit.dark()));
    }
};

/// Shading at the very position of a light on a face, and at the next points: no light, and no NaN.
struct LightAtThePoint {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t light = uint32_t(i % setup.points.size);
        const Vec3<Real> at = setup.point(light);
        Vec3<double> away = on_sphere(draw);
        if (dot(away, Vec3<double>(at)) < 0) away = -away;  // mostly from over the face
        const int closeness = draw.between(8, 30);
        const Vec3<double> aside = draw.in_cube<double>(draw.one_in(2) ? 0 : two_to<double>(-closeness));
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

/// A plane under a light with falloff: I h / (h^2 + x^2)^(3/2). Rays down at a horizontal face; h and x are those of
/// the point that the ray tree shades.
struct Falloff {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double half = setup.numbers[3];
        const Vec3<double> middle = setup.vector(0);
        Vec3<double> at = draw.in_cube<double>(0.98 * half);
        Vec3<double> from = draw.in_cube<double>(0.5 * half);
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
        const DoubleDouble x = two_sum(l.x, -p.x);
        const DoubleDouble y = two_sum(l.y, -p.y);
        const DoubleDouble h = two_sum(l.z, -p.z);
        const DoubleDouble square = x * x + y * y + h * h;
        const DoubleDouble ih = DoubleDouble(double(light.intensity.x)) * h;
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
