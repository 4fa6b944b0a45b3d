// Lines through balls of which closed forms say where they go.
#pragma once

#include "verify/cases/refraction/lines.h"

namespace cistula::verify::balls {

using refraction::Lines;
using refraction::trace;

/// Rays beside the first ball, aimed at its outline as finely as rounding tells apart: they meet it where they come
/// nearer than its radius, on its surface. Point 0: its center; number 0: its radius.
struct Outline {
    /// Whether the discriminant is that of textbooks, b^2 - (f.f - r^2), as a negative control.
    bool from_textbook;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> center(setup.point(0));
        const double radius = double(Real(setup.numbers[0]));
        const Vec3<Real> origin(center + on_sphere(draw) * (radius * (1.5 + draw.unit<double>())));
        const Vec3<double> to_center = center - Vec3<double>(origin);
        Vec3<double> beside = on_sphere(draw);
        beside -= dot(beside, to_center) / dot(to_center, to_center) * to_center;
        // The tangent's foot, off by up to 2^-2 to 2^-26 of the radius, 2^-55 in double.
        const double off =
            draw.centered<double>(1.0) * elementary::power_of_two(-int(draw.between(2, sizeof(Real) == 4 ? 26 : 55)));
        const double far = length(to_center);
        const double sine = radius * (1 + off) / far;  // of the angle between the ray and the center
        const Vec3<Real> direction(
            normalized(to_center + normalized(beside) * (far * sine / square_root(1 - sine * sine))));
        const Vec3<double> d(direction);
        const double along_line = dot(to_center, d) / dot(d, d);
        const Vec3<double> across = to_center - along_line * d;
        const double gap = length(across) - radius;
        const double slack = setup.units(8);
        bool found = false;
        double t = 0;
        if (from_textbook) {
            const Vec3<Real> f = setup.point(0) - origin;
            const Real b = dot(f, direction);
            const Real discriminant = b * b - (dot(f, f) - Real(radius) * Real(radius));
            found = discriminant > Real(0);
            if (found) t = double(b - square_root(discriminant));
        } else {
            const Hit<Real> hit = intersector.closest(ray_from(origin, direction));
            if (hit.found() && key_solid(hit.key) != 0) return;  // another ball is before it
            found = hit.found();
            if (found) t = double(hit.t);
        }
        tally.expect((found || gap > -slack) && (!found || gap < slack));
        const double depth = radius - length(Vec3<double>(origin) + t * d - center);
        if (found) tally.expect(magnitude(depth) < slack);
        tally.witness(magnitude(gap) < setup.units(64));
    }
};

/// A ray in the plane of the axis through a glass ball, parallel to the axis: it leaves turned by 2 (i - t), with sin i
/// its distance from the axis over the radius, sin t = sin i / index. A place is off by some u M, so an angle by u M /
/// r. Point 0: the center; numbers: radius, index.
struct Focus {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> center(setup.point(0));
        const double radius = double(Real(setup.numbers[0]));
        const double index = setup.numbers[1];
        const Vec3<Real> axis(on_sphere(draw));
        const Vec3<double> d = normalized(Vec3<double>(axis));
        Vec3<double> up = on_sphere(draw);
        up = normalized(up - dot(up, d) * d);
        const double wanted = 0.9 * draw.unit<double>();
        const Vec3<Real> origin(center + up * (radius * wanted) - d * (2 * radius));
        Lines<Real> lines;
        trace(setup, intersector, ray_from(origin, Vec3<Real>(d)), lines);
        const bool passes = lines.flags == 0 && lines.count >= 3;  // or more, beyond the ball
        tally.expect(passes);
        if (!passes) return;
        const Vec3<double> in(lines.direction[0]);
        const Vec3<double> off = center - Vec3<double>(origin);
        const Vec3<double> across = dot(off, in) / dot(in, in) * in - off;  // from the axis to the ray
        const double height = length(across);
        const double sine_in = height / radius;
        const double sine_within = sine_in / index;
        const double cosine_in = square_root(1 - sine_in * sine_in);
        const double cosine_within = square_root(1 - sine_within * sine_within);
        const double half_cosine = cosine_in * cosine_within + sine_in * sine_within;
        const double half_sine = sine_in * cosine_within - cosine_in * sine_within;
        const Vec3<double> toward_axis = height > 0 ? across / -height : Vec3<double>(0.0);
        const Vec3<double> out =
            in * (half_cosine * half_cosine - half_sine * half_sine) + toward_axis * (2 * half_sine * half_cosine);
        tally.measure(length(Vec3<double>(lines.direction[2]) - out) * radius / setup.units(1));
    }
};

/// A ray inside a glass ball, beyond the critical angle: every chord has the same length. Point 0: the center; number
/// 0: the radius.
struct Bounces {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> center(setup.point(0));
        const double radius = double(Real(setup.numbers[0]));
        const Vec3<double> normal = on_sphere(draw);
        Vec3<double> beside = on_sphere(draw);
        beside = normalized(beside - dot(beside, normal) * normal);
        const double cosine = 0.5 * elementary::power_of_two(-int(draw.below(8))) * (0.5 + 0.5 * draw.unit<double>());
        Ray<Real> ray = ray_from(Vec3<Real>(center + radius * normal),
                                 Vec3<Real>(normalized(beside * square_root(1 - cosine * cosine) - cosine * normal)));
        ray.from_solid = 0;
        ray.media.add(0, 1);
        Lines<Real> lines;
        trace(setup, intersector, ray, lines);
        bool inside = lines.flags == 0 && lines.count == Lines<Real>::capacity;
        for (int k = 0; inside && k < lines.count; ++k)
            inside = lines.index[k] == 1.5 && lines.first[k].found() && lines.first[k].t > Real(0);
        tally.expect(inside);
        if (!inside) return;
        double worst = 0;
        for (int k = 1; k < lines.count; ++k)
            worst = max_or_second(magnitude(double(lines.first[k].t) - double(lines.first[0].t)), worst);
        tally.measure(worst / setup.units(1));
    }
};

}  // namespace cistula::verify::balls
