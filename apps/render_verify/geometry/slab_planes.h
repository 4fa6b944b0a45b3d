// Lines along axes at the border of a cube, and origins in the planes of its faces.
#pragma once

#include "apps/render_verify/geometry/upright_solids.h"

namespace cistula::verify::geometry {

/// Rays along an axis at an upright cube; inside if both other coordinates are strictly between the planes.
struct AxisParallel {
    static constexpr const char* name = "geometry/axis-parallel";
    static constexpr const char* exact =
        "lines along axes meet a cube of planes iff strictly within it, to the last bit";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;

    bool planes;

    static void plan(Plan& plan) {
        for (const Shape shape : {Shape::planes, Shape::triangles}) {
            SceneDescription scene = empty_scene();
            const SolidObject cube = solid_object(PlatonicSolid::cube);
            add_solid(scene, shape, cube);
            plan.add("cube" + shape_name(shape), scene, AxisParallel{shape == Shape::planes},
                     triangulated_solid(cube).vertices, plan.rays(1'000'000, 20000));
        }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        // The cube stands about the frame's origin, so that its planes are where its corners are, or where slabs say.
        const Real half = planes ? setup.scene.slabs[0].high : magnitude(setup.point(0).x);
        const int axis = draw.between(0, 2);
        Ray<Real> ray = ray_from(Vec3<Real>(Real(0)), Vec3<Real>(Real(0)));
        bool within = true, on = false;
        for (int k = 0; k < 3; ++k) {
            if (k == axis) continue;
            const uint32_t kind = draw.below(4);
            Real at = draw.centered(Real(1));
            if (kind == 0) at = half;
            if (kind == 1) at = parity::stepped(half, draw.between(-2, 2));
            if (kind == 2) at = Real(0);
            ray.origin[k] = draw.one_in(2) ? at : -at;
            ray.direction[k] = draw.one_in(2) ? Real(0) : Real(-0.0);
            within = within && at < half && -at < half;
            on = on || at == half || -at == half;
        }
        ray.direction[axis] = Real(draw.sign());
        ray.origin[axis] = Real(-1.25) * setup.extent() * ray.direction[axis];
        tally.witness(on);
        const Crossings found = cross_all(intersector, ray);
        // In the plane of a face of triangles the line may be on either side of it, but must leave if it enters.
        if (!planes && on)
            tally.expect(found.balanced() && found.enters <= 1);
        else
            tally.expect(within ? found.are(1, 1) : found.are(0, 0));
    }
};

/// Rays that start exactly in the plane of a cube's face, without state from a previous hit.
struct OnSlabPlanes {
    static constexpr const char* name = "geometry/origins-on-slab-planes";
    static constexpr const char* exact = "from a face inward: in at t = 0 and out; outward or along it: nothing";
    static constexpr Bound bound = no_failures("rays");

    static void plan(Plan& plan) {
        SceneDescription scene = empty_scene();
        add_object(scene, solid_object(PlatonicSolid::cube));
        plan.add("cube of planes", scene, OnSlabPlanes{}, {}, plan.rays(1'000'000, 20000));
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t face = draw.below(3);
        const Slab<Real>& slab = setup.scene.slabs[face];
        const int axis = slab.normal.x != Real(0) ? 0 : slab.normal.y != Real(0) ? 1 : 2;
        const int side = draw.sign();
        Ray<Real> ray;
        for (int k = 0; k < 3; ++k) ray.origin[k] = draw.centered(Real(0.99) * slab.high);
        ray.origin[axis] = side > 0 ? slab.high : -slab.high;
        Vec3<double> way = on_sphere(draw);
        const uint32_t kind = draw.below(4);
        if (kind == 0) way[axis] = 0;                                     // along the face
        if (kind == 1) way = Vec3<double>(0.0), way[axis] = draw.sign();  // straight
        if (kind >= 2 && magnitude(way[axis]) < 0.01) way[axis] = 0.5;
        ray.direction = Vec3<Real>(way);
        const Real outward = ray.direction[axis] * Real(side);
        if (outward < Real(0)) {
            const Hit<Real> first = intersector.closest(ray);
            tally.expect(first.found() && first.t == Real(0) && first.enters && cross_all(intersector, ray).are(1, 1));
        } else {
            tally.expect(cross_all(intersector, ray).are(0, 0));
        }
    }
};

}  // namespace cistula::verify::geometry
