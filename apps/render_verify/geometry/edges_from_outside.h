// A ray from outside enters and leaves a convex solid once or misses it, also at its edges and its silhouette.
#pragma once

#include "apps/render_verify/geometry/edges_from_inside.h"

namespace cistula::verify::geometry {

/// A ray from outside at a target: from far away, from a coarse lattice, or parallel to an axis.
template <class Real>
CISTULA_HD inline Vec3<Real> outside_origin(Draw& draw, const Vec3<Real>& target, double extent) {
    const uint32_t kind = draw.below(8);
    if (kind == 0) {
        Vec3<Real> origin = target;
        const int axis = draw.between(0, 2);
        origin[axis] = Real(draw.sign() * 1.25 * extent);
        return origin;
    }
    Vec3<Real> origin(on_sphere(draw) * (1.9 * extent));
    if (kind < 4)
        for (int k = 0; k < 3; ++k) origin[k] = floor_of(origin[k] * Real(64)) / Real(64);
    return origin;
}

struct EdgesFromOutside {
    uint32_t solid;
    bool tiny;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent()), inradius = setup.numbers[3];
        const Vec3<Real> target = setup.point(i % setup.points.size);
        const bool near = tiny && draw.one_in(4);
        const Vec3<Real> origin = near ? Vec3<Real>(Vec3<double>(target) + on_sphere(draw) * (64 * inradius))
                                       : outside_origin(draw, target, extent);
        const Ray<Real> ray = aimed(setup, draw, origin, target);
        const Crossings found = cross_all(intersector, ray, solid);
        // Planes and corners are rounded by a few u M, and so is the line where the test works with it.
        const double margin = 1e-3 * inradius + 32 * double(RealTraits<Real>::unit) * extent;
        const Span<double> planes{setup.numbers.data + first_plane, setup.numbers.size - first_plane};
        const Vec3<double> from(ray.origin), way = normalized(Vec3<double>(ray.direction));
        const bool through = chord(planes, margin, from, way) > margin;
        const bool past = chord(planes, -margin, from, way) < 0;
        tally.witness(through);
        tally.expect(found.balanced() && (!through || found.are(1, 1)) && (!past || found.are(0, 0)));
    }
};

struct EdgesFromOutsidePlanes : EdgesFromOutside {
    static constexpr const char* name = "geometry/edges-from-outside/planes";
    static constexpr const char* exact = "as many ways in as out; one each where the line is inside";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_solids<EdgesFromOutsidePlanes>(plan, Shape::planes, 512, 8); }
};

struct EdgesFromOutsideTriangles : EdgesFromOutside {
    static constexpr const char* name = "geometry/edges-from-outside/triangles";
    static constexpr const char* exact = "as many ways in as out; one each where the line is inside";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_solids<EdgesFromOutsideTriangles>(plan, Shape::triangles, 512, 8); }
};

}  // namespace cistula::verify::geometry
