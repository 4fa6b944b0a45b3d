// Directions stay of unit length however often they are reflected.
#pragma once

#include "apps/render_verify/mirrors/bounces_inside.h"
#include "cistula/numerics/double_double.h"

namespace cistula::verify::mirrors {

struct Lengths {
    bool renormalize;

    static constexpr double most = 1.76;
    static constexpr uint32_t reflections = 1000;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> middle(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
        const Vec3<Real> origin(middle + in_ball(draw) * setup.numbers[3]);
        Ray<Real> ray = inside(ray_from(origin, Vec3<Real>(on_sphere(draw))), 0);
        for (uint32_t n = 0; n < reflections; ++n) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found()) {
                tally.measure(RealTraits<double>::infinity);
                return;
            }
            const Surface<Real> s = surface_at<Real, Effects<0>>(setup.scene, ray, hit);
            Vec3<Real> way = reflected(ray.direction, s.normal);
            if (!renormalize) way = along(ray.direction, Real(-2) * dot(ray.direction, s.normal), s.normal);
            const double ulps = off_unit(Vec3<double>(way)) / (2 * double(RealTraits<Real>::unit));
            if (renormalize)
                tally.measure(ulps);
            else
                tally.expect(ulps <= most);
            ray = leaving(s.viewer_side, way, hit, ray.media);
        }
    }

  private:
    /// ||d| - 1|, up to its square.
    CISTULA_HD static double off_unit(const Vec3<double>& d) {
        const DoubleDouble square = two_product(d.x, d.x) + two_product(d.y, d.y) + two_product(d.z, d.z);
        return 0.5 * magnitude(double(square - DoubleDouble(1)));
    }
};

template <class Case>
void plan_lengths(Plan& plan, bool renormalize) {
    SceneDescription solid = empty_scene(), mesh = empty_scene();
    const SolidObject dodecahedron =
        solid_object(PlatonicSolid::dodecahedron, glm::dvec3(0), 1, glm::dvec3(31, 47, 11));
    add_object(solid, dodecahedron);
    const InsideOf torus_body = closed_meshes()[0];
    add_object(mesh, torus_body.mesh);
    for (const bool planes : {true, false}) {
        Part& part = plan.add(planes ? "dodecahedron" : "torus", planes ? solid : mesh, Case{{renormalize}}, {},
                              plan.rays(planes ? 4096 : 1024, planes ? 64 : 16));
        part.frame_numbers = [=](const glm::dvec3& center, double factor, std::vector<double>& numbers) {
            const glm::dvec3 m = ((planes ? glm::dvec3(0) : torus_body.middle) - center) * factor;
            numbers = {m.x, m.y, m.z, 0.1 * factor};
        };
    }
}

struct UnitLength : Lengths {
    static constexpr const char* name = "mirrors/unit-length";
    static constexpr const char* exact = "||d| - 1| after 1, 2, ... 1,000 reflections";
    // A Newton step takes a length 1 + e to 1 - 3/2 e^2 with a factor f of 3/2 - |d|^2 / 2: the square is off by 3 u,
    // its half by 1.5 u, f is rounded by u, the products by u. What e was does not matter: 3.5 u, or 1.75 ulps, and e^2
    // (e is under 64 u) of float.
    static constexpr Bound bound = at_most(most, "ulps");
    static void plan(Plan& plan) { plan_lengths<UnitLength>(plan, true); }
};

struct LengthsNotRenormalized : Lengths {
    static constexpr const char* name = "mirrors/broken/not-renormalized";
    static constexpr const char* exact = "d - 2 (d.N) N alone drifts from unit length, which must be caught";
    static constexpr Bound bound = must_fail(1000, "reflections");
    static void plan(Plan& plan) { plan_lengths<LengthsNotRenormalized>(plan, false); }
};

}  // namespace cistula::verify::mirrors
