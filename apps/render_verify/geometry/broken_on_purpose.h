// Negative controls: the precautions of the geometry removed one at a time. Each must fail on rays that the sound tests
// pass, or those prove nothing. The broken tests are made here; the library has no switches for them.
#pragma once

#include "apps/render_verify/geometry/edges_from_inside.h"

namespace cistula::verify::geometry {

enum class Flaw {
    contracted_products,  // the second product of an edge function rounded, the first not, as compilers contract them
    inclusive_edges,      // edges belong to both triangles beside them
    unpadded_boxes,       // the triangles' own boxes, met by the candidate ray without slack
};

/// A triangle's bounding box rounded to nearest, and a candidate ray without slack.
template <class Real>
CISTULA_HD inline bool meets_own_box(const Cluster<Real>& cluster, uint32_t lane, const Ray<Real>& ray) {
    BoxRay box_ray = BoxRay::of(ray.origin, ray.direction);
    box_ray.near_limit = 0;
    box_ray.far_limit = RealTraits<float>::infinity;
    float low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
        const Real(&corner)[3][3][cluster_lanes] = cluster.corner;
        low[axis] =
            float(min_or_second(corner[0][axis][lane], min_or_second(corner[1][axis][lane], corner[2][axis][lane])));
        high[axis] =
            float(max_or_second(corner[0][axis][lane], max_or_second(corner[1][axis][lane], corner[2][axis][lane])));
    }
    return box_ray.enter(low, high) < RealTraits<float>::infinity;
}

/// Crossings ahead of the ray, found by a loop over all triangles with the flawed test.
template <Flaw flaw, class Real>
CISTULA_HD inline uint32_t flawed_crossings(const SceneView<Real>& scene, const Ray<Real>& ray) {
    uint32_t count = 0;
    const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(ray.origin, ray.direction);
    for (uint32_t c = 0; c < scene.clusters.size; ++c) {
        const Cluster<Real>& cluster = scene.clusters[c];
        for (uint32_t lane = 0; lane < cluster.count; ++lane) {
            ShearedTriangle<Real> s = ShearedTriangle<Real>::of(cluster, int(lane), triangle_ray);
            if (flaw == Flaw::contracted_products)
                for (int k = 0; k < 3; ++k) {
                    const int a = (k + 1) % 3, b = (k + 2) % 3;
                    const Real rounded = s.y[b] * s.x[a];
                    s.edge[k] = fused(s.x[b], s.y[a], -rounded);
                }
            const Real det = s.edge[0] + s.edge[1] + s.edge[2];
            if (!s.within() || det == Real(0)) continue;
            if (flaw != Flaw::inclusive_edges && !s.owns_zero_edges(det > Real(0) ? Real(1) : Real(-1))) continue;
            if (flaw == Flaw::unpadded_boxes && !meets_own_box(cluster, lane, ray)) continue;
            const Real depth = s.edge[0] * (triangle_ray.sz * s.z[0]) + s.edge[1] * (triangle_ray.sz * s.z[1]) +
                               s.edge[2] * (triangle_ray.sz * s.z[2]);
            count += depth / det >= Real(0) ? 1 : 0;
        }
    }
    return count;
}

/// The rays of edges_from_inside, at vertices only, where edge functions of many triangles are 0 or nearly so.
template <Flaw flaw>
struct Flawed {
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> middle(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
        const double reach = draw.one_in(8) ? 0.0 : 0.9;
        const Vec3<Real> origin(middle + in_ball(draw) * (reach * setup.numbers[3]));
        const Ray<Real> ray = aimed(setup, draw, origin, setup.point(i % setup.points.size));
        tally.expect(flawed_crossings<flaw>(setup.scene, ray) == 1);
    }

    template <class Functor>
    static void plan_with(Plan& plan) {
        for (const PlatonicSolid kind : platonic_solids)
            for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)}) {
                const PlacedSolid placed = placed_solid(kind, Shape::triangles, placements()[0], rotation);
                const std::vector<glm::dvec3> points = edge_points(placed.solid);
                Part& part =
                    plan.add(placed.label, placed.scene, Functor{}, points, points.size() * plan.rays(512, 32));
                part.frame_numbers = [solid = placed.solid](const glm::dvec3& center, double factor,
                                                            std::vector<double>& numbers) {
                    const glm::dvec3 at = (solid.center - center) * factor;
                    numbers = {at.x, at.y, at.z, solid.radius * factor * platonic_shape(solid.solid).inradius};
                };
            }
    }
};

struct ContractedProducts : Flawed<Flaw::contracted_products> {
    static constexpr const char* name = "geometry/broken/contracted-products";
    static constexpr const char* exact = "edge functions with contracted products leak at vertices and edges";
    static constexpr Bound bound = must_fail(1, "rays");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_with<ContractedProducts>(plan); }
};

struct InclusiveEdges : Flawed<Flaw::inclusive_edges> {
    static constexpr const char* name = "geometry/broken/inclusive-edges";
    static constexpr const char* exact = "inclusive edges are hit twice";
    static constexpr Bound bound = must_fail(1, "rays");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_with<InclusiveEdges>(plan); }
};

struct UnpaddedBoxes : Flawed<Flaw::unpadded_boxes> {
    static constexpr const char* name = "geometry/broken/unpadded-boxes";
    static constexpr const char* exact = "boxes without padding hide hits that the triangles accept";
    static constexpr Bound bound = must_fail(1, "rays");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_with<UnpaddedBoxes>(plan); }
};

}  // namespace cistula::verify::geometry
