// Many coincident triangles: each is hit once, the last sheet first; copies within one sheet count once.
#pragma once

#include "apps/render_verify/geometry/upright_solids.h"

namespace cistula::verify::geometry {

struct Coincident {
    static constexpr const char* name = "geometry/coincident-triangles";
    static constexpr const char* exact =
        "a thousand sheets in one place: the last first, then all others in order; a thousand copies in one: one";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;

    static constexpr uint32_t copies = 1000;
    uint32_t solids;  // 1: all copies in one sheet; else one sheet each

    static void plan(Plan& plan) {
        for (const uint32_t solids : {1u, copies}) {
            SceneDescription scene = empty_scene();
            TrianglesObject sheet;
            sheet.vertices = {{-1, -0.7, 0.1}, {1, -0.9, -0.3}, {0.1, 1, 0.2}};
            for (uint32_t k = 0; k < copies / solids; ++k) sheet.triangles.push_back({0, 1, 2});
            for (uint32_t k = 0; k < solids; ++k) add_object(scene, sheet);
            plan.add(solids == 1 ? "one sheet" : "a thousand sheets", scene, Coincident{solids}, sheet.vertices,
                     plan.rays(2000, 40));
        }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> a = setup.point(draw.below(3)), b = setup.point(draw.below(3));
        const Vec3<Real> middle = (setup.point(0) + setup.point(1) + setup.point(2)) * Real(1.0 / 3.0);
        const Vec3<Real> edge = along(a, draw.unit<Real>(), b - a);
        const Vec3<Real> target = draw.one_in(2) ? along(middle, Real(0.9) * draw.unit<Real>(), edge - middle) : edge;
        Ray<Real> ray = aimed(setup, draw, Vec3<Real>(on_sphere(draw) * (1.9 * double(setup.extent()))), target);
        uint32_t met = 0;
        Real t = 0;
        bool in_order = true;
        for (; met <= solids; ++met) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found()) break;
            if (met == 0) t = hit.t;
            const uint32_t last = solids - 1 - met;
            in_order = in_order && hit.t == t && key_face(hit.key) == last && key_solid(hit.key) == last;
            ray.after = {hit.t, hit.key};
        }
        tally.witness(met == solids);
        tally.expect(in_order && (met == 0 || met == solids));
    }
};

}  // namespace cistula::verify::geometry
