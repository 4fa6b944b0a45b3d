// Rays exactly in the plane of a face.
#pragma once

#include "apps/render_verify/geometry/upright_solids.h"

namespace cistula::verify::geometry {

struct FacePlanes {
    static constexpr const char* name = "geometry/rays-in-face-planes";
    static constexpr const char* exact =
        "a sheet is passed by; a cube of planes too; one of triangles is left as often as entered";
    static constexpr Bound bound = no_failures("rays");

    enum class Kind { sheet, planes, triangles } kind;

    static void plan(Plan& plan) {
        const uint64_t rays = plan.rays(1'000'000, 20000);
        SceneDescription sheet = empty_scene();
        TrianglesObject square;
        square.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
        square.triangles = {{0, 1, 2}, {0, 2, 3}};
        add_object(sheet, square);
        plan.add("sheet", sheet, FacePlanes{Kind::sheet}, square.vertices, rays);
        for (const Shape shape : {Shape::planes, Shape::triangles}) {
            SceneDescription scene = empty_scene();
            const SolidObject cube = solid_object(PlatonicSolid::cube);
            add_solid(scene, shape, cube);
            plan.add("cube" + shape_name(shape), scene,
                     FacePlanes{shape == Shape::planes ? Kind::planes : Kind::triangles}, edge_points(cube), rays);
        }
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Real half = kind == Kind::sheet    ? Real(0)
                          : kind == Kind::planes ? setup.scene.slabs[0].high
                                                 : magnitude(setup.point(0).x);
        const int axis = kind == Kind::sheet ? 2 : draw.between(0, 2);
        const Real plane = draw.one_in(2) ? half : -half;
        Vec3<Real> target = setup.point(draw.below(setup.points.size));
        if (draw.one_in(2)) target = draw.in_cube(setup.extent());
        Vec3<Real> origin = draw.in_cube(setup.extent());
        origin[(axis + (draw.one_in(2) ? 1 : 2)) % 3] = Real(draw.sign() * 1.25) * setup.extent();  // beside the face
        origin[axis] = target[axis] = plane;
        Ray<Real> ray = ray_from(origin, target - origin);
        if (draw.one_in(2) && length(ray.direction) > Real(0)) {
            ray.direction = normalized(ray.direction);
            ray.direction[axis] = draw.one_in(2) ? Real(0) : Real(-0.0);
        }
        const Crossings found = cross_all(intersector, ray);
        if (kind == Kind::triangles)
            tally.expect(found.balanced() && found.enters <= 1);
        else
            tally.expect(found.are(0, 0) && found.sheets == 0);
    }
};

}  // namespace cistula::verify::geometry
