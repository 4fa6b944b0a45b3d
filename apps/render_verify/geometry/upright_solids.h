// The five solids about the origin, shared by several cases.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/crossings.h"
#include "apps/render_verify/scenes.h"

namespace cistula::verify::geometry {

inline std::string shape_name(Shape shape) {
    return shape == Shape::planes ? " of planes" : " of triangles";
}

/// Adds parts with the five solids about the origin, as planes and as triangles, upright and turned.
template <class Functor>
void plan_upright(Plan& plan, uint64_t rays) {
    for (const PlatonicSolid kind : platonic_solids)
        for (const Shape shape : {Shape::planes, Shape::triangles})
            for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)}) {
                const PlacedSolid placed = placed_solid(kind, shape, placements()[0], rotation);
                Part& part = plan.add(placed.label, placed.scene, Functor{}, edge_points(placed.solid), rays);
                part.frame_numbers = [solid = placed.solid](const glm::dvec3& center, double factor,
                                                            std::vector<double>& numbers) {
                    add_planes(solid, center, factor, numbers);
                };
            }
}

}  // namespace cistula::verify::geometry
