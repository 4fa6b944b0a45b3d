// A ray from inside a convex solid has exactly one exit, also where two or more faces meet.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/crossings.h"
#include "apps/render_verify/scenes.h"
#include "cistula/numerics/vec.h"

namespace cistula::verify::geometry {

/// Adds rays for every target of every placement of the five solids. Numbers: the center, the inradius, the greatest
/// distance of targets from the solid's edges due to rounding of scene units, then its planes from first_plane on.
inline constexpr uint32_t first_plane = 5;
template <class Functor>
void plan_solids(Plan& plan, Shape shape, uint64_t rays_a_target_full, uint64_t rays_a_target_quick) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const Placement& placement : placements())
            for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)}) {
                const PlacedSolid placed = placed_solid(kind, shape, placement, rotation);
                const std::vector<glm::dvec3> points = edge_points(placed.solid);
                Part& part = plan.add(placed.label, placed.scene, Functor{placed.number, placement.beside_unit}, points,
                                      points.size() * plan.rays(rays_a_target_full, rays_a_target_quick));
                part.frame_numbers = [solid = placed.solid](const glm::dvec3& center, double factor,
                                                            std::vector<double>& numbers) {
                    const glm::dvec3 middle = (solid.center - center) * factor;
                    const double radius = solid.radius * factor;
                    const double rounding = 0x1p-51 * (length(solid.center) + solid.radius) * factor;
                    numbers = {middle.x, middle.y, middle.z, radius * platonic_shape(solid.solid).inradius, rounding};
                    add_planes(solid, center, factor, numbers);
                };
            }
}

struct EdgesFromInside {
    uint32_t solid;
    bool tiny;  // so small in its scene that its inside contains few floating-point numbers

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> middle(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
        const double inradius = setup.numbers[3], reach = tiny ? 0.25 : draw.one_in(8) ? 0.0 : 0.9;
        const Vec3<Real> origin(middle + in_ball(draw) * (reach * inradius));
        const Ray<Real> ray = aimed(setup, draw, origin, setup.point(i % setup.points.size));
        tally.expect(cross_all(intersector, inside(ray, solid), solid).are(0, 1));
    }
};

struct EdgesFromInsidePlanes : EdgesFromInside {
    static constexpr const char* name = "geometry/edges-from-inside/planes";
    static constexpr const char* exact = "one way out at every vertex and k/16 of every edge";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) { plan_solids<EdgesFromInsidePlanes>(plan, Shape::planes, 512, 8); }
};

struct EdgesFromInsideTriangles : EdgesFromInside {
    static constexpr const char* name = "geometry/edges-from-inside/triangles";
    static constexpr const char* exact = "one way out at every vertex and k/16 of every edge";
    static constexpr Bound bound = no_failures("rays");
    static void plan(Plan& plan) { plan_solids<EdgesFromInsideTriangles>(plan, Shape::triangles, 512, 8); }
};

}  // namespace cistula::verify::geometry
