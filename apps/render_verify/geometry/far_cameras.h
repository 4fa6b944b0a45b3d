// Cameras so far away that the scene is a point in float: rays start near the scene, computed in double.
#pragma once

#include "apps/render_verify/geometry/upright_solids.h"
#include "cistula/transport/pixel.h"

namespace cistula::verify::geometry {

struct FarCameras {
    static constexpr const char* name = "geometry/far-cameras";
    static constexpr const char* exact = "from 1e3 to 1e9 scene sizes away: one way in, one out, none beside the solid";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_upright<FarCameras>(plan, plan.rays(1'000'000, 4000)); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const double powers[] = {1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9};
        const double distance = powers[draw.below(7)] * (1 + draw.unit<double>());
        FrameView frame;
        frame.camera.position = on_sphere(draw) * (distance * double(setup.extent()));
        frame.is_far = true;
        const bool at_edge = draw.one_in(2);
        const Vec3<double> inner = in_ball(draw) * double(setup.extent());
        const Vec3<double> target = at_edge ? setup.points[draw.below(setup.points.size)] : inner;
        const Vec3<double> way = normalized(target - frame.camera.position);
        // The line itself, about the point of it that is nearest to the scene's center: 1e9 away its direction, in
        // double, is good to 1e9 * 2^-52 = 2e-7 there.
        const Vec3<double> nearest = along(frame.camera.position, -dot(frame.camera.position, way), way);
        const double margin = 1e-4;
        const bool through = chord(setup.numbers, margin, nearest, way) > margin;
        const bool past = chord(setup.numbers, -margin, nearest, way) < 0;
        Ray<Real> ray;
        double start;
        if (!primary_ray<Real>(setup.scene, frame, way, ray, start)) {
            tally.expect(past);
            return;
        }
        const Crossings found = cross_all(intersector, ray);
        tally.witness(through);
        tally.expect(found.balanced() && (!through || found.are(1, 1)) && (!past || found.are(0, 0)));
    }
};

}  // namespace cistula::verify::geometry
