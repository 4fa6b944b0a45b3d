// Rays at edges and vertices of closed bodies, from outside, from inside and from the faces themselves.
#pragma once

#include "cistula/numerics/vec.h"
#include "cistula/shading/surface.h"
#include "verify/setup.h"

namespace cistula::verify::geometry {

/// What rays at the edges of a Platonic solid are given. Numbers: the center, the inradius, the greatest distance of
/// targets from the solid's edges due to rounding of scene units, then its planes from first_plane on.
struct AtEdges {
    static constexpr uint32_t first_plane = 5;
    uint32_t solid;
    bool tiny;  // so small in its scene that its inside contains few floating-point numbers
};

/// A ray from inside a convex solid has exactly one exit, also where two or more faces meet.
struct EdgesFromInside : AtEdges {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> middle = setup.vector(0);
        const double inradius = setup.numbers[3];
        const double reach = tiny ? 0.25 : draw.one_in(8) ? 0.0 : 0.9;
        const Vec3<Real> origin(middle + in_ball(draw) * (reach * inradius));
        const Ray<Real> ray = aimed(setup, draw, origin, setup.point(i % setup.points.size));
        tally.expect(cross_all(intersector, inside(ray, solid), solid).are(0, 1));
    }
};

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

/// A ray from outside enters and leaves a convex solid once or misses it, also at its edges and its silhouette.
struct EdgesFromOutside : AtEdges {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        const double inradius = setup.numbers[3];
        const Vec3<Real> target = setup.point(i % setup.points.size);
        const bool near = tiny && draw.one_in(4);
        const Vec3<Real> origin = near ? Vec3<Real>(Vec3<double>(target) + on_sphere(draw) * (64 * inradius))
                                       : outside_origin(draw, target, extent);
        const Ray<Real> ray = aimed(setup, draw, origin, target);
        const Crossings found = cross_all(intersector, ray, solid);
        // Planes and corners are rounded by a few u M, and so is the line where the test works with it.
        const double margin = 1e-3 * inradius + 32 * double(RealTraits<Real>::unit) * extent;
        expect_ways(tally, found, setup.numbers_from(first_plane), margin, Vec3<double>(ray.origin),
                    normalized(Vec3<double>(ray.direction)));
    }
};

/// Starts on solids of planes: within rounding of two faces or more, one of which is the face just left.
struct OriginsOnPlanes : AtEdges {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const SceneView<Real>& scene = setup.scene;
        const Solid& body = scene.solids[solid];
        const Vec3<Real> start = setup.point(i % setup.points.size);
        const double reach = double(incidence<Real> * scene.extent) + setup.numbers[4];
        uint32_t incident[8], count = 0;
        for (uint32_t face = 0; face < 2 * body.slab_count && count < 8; ++face)
            if (magnitude(beyond(scene, body, face, start)) <= reach) incident[count++] = face;
        if (count < 2) {
            tally.expect(false);  // the targets are on edges
            return;
        }
        const uint32_t left = incident[draw.below(count)];
        Vec3<double> aim = on_sphere(draw);
        // Along the face, give or take a few u: rounding may send a line that was reflected inward out again.
        const bool grazing = draw.one_in(4);
        const double beside = draw.centered<double>(16.0) * double(RealTraits<Real>::unit);
        if (grazing) {
            const Vec3<double> normal = outward(scene, body, left);
            aim = normalized(aim - normal * dot(normal, aim)) + normal * beside;
        }
        const Vec3<Real> way(aim);
        const bool inward = grazing || dot(outward(scene, body, left), Vec3<double>(way)) < 0;
        Ray<Real> ray = ray_from(start, way);
        ray.from_solid = solid;
        ray.from_face = left;
        if (!inward) {
            tally.expect(cross_all(intersector, ray, solid).are(0, 0));
            return;
        }
        ray = inside(ray, solid);
        const Hit<Real> hit = first_of(intersector, ray);
        bool good = key_kind(hit.key) == CrossingKind::leave && hit.t >= Real(0) && key_face(hit.key) != left &&
                    cross_all(intersector, ray, solid).are(0, 1);
        // Faces that the start lies on and the line goes out of: the way out is no farther than the nearest of them,
        // the start's distance from it (at most `reach`) and its rounding (as much again) over the slope.
        for (uint32_t k = 0; k < count; ++k) {
            const double slope = dot(outward(scene, body, incident[k]), Vec3<double>(way));
            if (incident[k] == left || !(slope > 0.01)) continue;
            tally.witness(true);
            good = good && double(hit.t) * slope <= 2 * reach;
        }
        tally.expect(good);
    }

  private:
    template <class Real>
    CISTULA_HD static Vec3<double> outward(const SceneView<Real>& scene, const Solid& body, uint32_t face) {
        const Vec3<double> normal(scene.slabs[body.first_slab + face / 2].normal);
        return face & 1u ? normal : -normal;
    }
    /// Distance of a point outside a face's plane; minus infinity for the missing side of a single plane.
    template <class Real>
    CISTULA_HD static double beyond(const SceneView<Real>& scene, const Solid& body, uint32_t face,
                                    const Vec3<Real>& p) {
        const Slab<Real>& slab = scene.slabs[body.first_slab + face / 2];
        const double at = dot(Vec3<double>(slab.normal), Vec3<double>(p));
        return face & 1u ? at - double(slab.high) : double(slab.low) - at;
    }
    /// The next crossing of the tested solid; another solid may come before it.
    template <class Real, class Tracer>
    CISTULA_HD Hit<Real> first_of(const Tracer& intersector, Ray<Real> ray) const {
        for (;;) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found() || key_solid(hit.key) == solid) return hit;
            ray.media.add(key_solid(hit.key), media_change(key_kind(hit.key)));
            ray.after = {hit.t, hit.key};
        }
    }
};

/// Starts on solids of triangles: a ray finds the face, and the next line starts there as the ray tree starts it.
struct OriginsOnTriangles : AtEdges {
    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        const Vec3<Real> target = setup.point(i % setup.points.size);
        const Vec3<double> middle = setup.vector(0);
        const bool from_inside = draw.one_in(2);
        const Vec3<Real> origin =
            from_inside ? Vec3<Real>(middle + in_ball(draw) * (0.25 * setup.numbers[3]))
                        : Vec3<Real>(middle + on_sphere(draw) * (tiny ? 64 * setup.numbers[3] : 1.9 * extent));
        Ray<Real> ray = ray_from(origin, normalized(target - origin));
        if (from_inside) ray = inside(ray, solid);
        const Hit<Real> hit = intersector.closest(ray);
        if (!hit.found() || key_solid(hit.key) != solid) {
            tally.expect(!from_inside);  // the silhouette may be missed, or another solid be in the way
            return;
        }
        tally.witness(hit.u == Real(0) || hit.v == Real(0) || hit.u + hit.v == Real(1));
        const Surface<Real> surface = surface_at<Real, Effects<0>>(setup.scene, ray, hit);
        Vec3<Real> way(on_sphere(draw));
        if (draw.one_in(2)) way = normalized(setup.any_point(draw) - surface.viewer_side);
        if (!(dot(way, surface.normal) > Real(0))) way = -way;
        if (!(dot(way, surface.normal) > Real(0x1p-10))) return;
        const Ray<Real> next = leaving(surface.viewer_side, way, hit, ray.media);
        const Crossings found = cross_all(intersector, next, solid);
        // Where corners were rounded by more than u M before they came into the frame, or the solid is no larger than a
        // few u M, faces of several triangles are bent, and a line may cross the bend.
        const bool bent = tiny || setup.numbers[4] > double(RealTraits<Real>::unit) * extent;
        if (from_inside) {
            const Hit<Real> out = intersector.closest(next);
            tally.expect(found.in_order && found.leaves == found.enters + 1 && (bent || found.leaves == 1) &&
                         (key_solid(out.key) != solid || key_face(out.key) != key_face(hit.key)));
        } else {
            tally.expect(found.balanced() && (bent || found.enters == 0));
        }
    }
};

/// Rays at a closed lens of two fans of triangles that share their rim. Points: the upper hub, the lower hub, the rim.
struct Fans {
    uint32_t spokes;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> hub = setup.point(draw.below(2));
        const Vec3<Real> rim = setup.point(2 + draw.below(spokes));
        const uint32_t kind = draw.below(4);
        const Real share = kind == 0 ? Real(draw.between(0, 14)) / Real(16) : Real(0.9) * draw.unit<Real>();
        const Vec3<Real> target = kind < 2 ? along(hub, share, rim - hub) : hub;
        if (draw.one_in(4)) {
            const Vec3<double> middle = (setup.points[0] + setup.points[1]) * 0.5;
            const Vec3<Real> origin(middle + in_ball(draw) * (0.1 * setup.factor));
            tally.expect(cross_all(intersector, inside(aimed(setup, draw, origin, target), 0)).are(0, 1));
            return;
        }
        Vec3<Real> origin(on_sphere(draw) * (1.9 * double(setup.extent())));
        if (draw.one_in(8)) origin = target, origin.z = draw.one_in(2) ? Real(1.25) : Real(-1.25);
        const Ray<Real> ray = aimed(setup, draw, origin, target);
        const Crossings found = cross_all(intersector, ray);
        // A line steeper than the lens crosses the lens if it crosses its faces.
        const bool steep = magnitude(ray.direction.z) > Real(0.5) * length(ray.direction);
        tally.witness(steep);
        tally.expect(steep ? found.are(1, 1) : found.balanced());
    }
};

/// Rays at triangles 2^20 times as long as wide, in closed meshes. Numbers: the planes of the box.
struct Slivers {
    bool box;

    template <class Real, class Tracer>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Tracer& intersector, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t n = setup.points.size;
        const uint32_t first = draw.below(n);
        const uint32_t step = draw.between(1, 9);
        const Vec3<Real> a = setup.point(first);
        const Vec3<Real> b = setup.point((first + step) % n);
        const uint32_t kind = draw.below(4);
        const Vec3<Real> target = kind < 2 ? a : along(a, kind == 2 ? Real(0.5) : draw.unit<Real>(), b - a);
        const Vec3<Real> outside = outside_origin(draw, target, double(setup.extent()));
        if (box && draw.one_in(3)) {
            const Vec3<Real> origin(in_ball(draw) * (0.9 * setup.numbers[3]));
            tally.expect(cross_all(intersector, inside(aimed(setup, draw, origin, target), 0)).are(0, 1));
            return;
        }
        const Ray<Real> ray = aimed(setup, draw, outside, target);
        const Crossings found = cross_all(intersector, ray);
        const double margin = 1e-4;
        const Vec3<double> from(ray.origin), way = normalized(Vec3<double>(ray.direction));
        const bool through = box && chord(setup.numbers, margin, from, way) > margin;
        tally.witness(box ? through : found.enters > 0);
        tally.expect(through ? found.are(1, 1) : found.balanced());
    }
};

// ---- the precautions of the geometry removed one at a time. The broken tests are made here; the library has no
// switches for them.

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
                    const int a = (k + 1) % 3;
                    const int b = (k + 2) % 3;
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

/// Rays from inside at vertices only, where edge functions of many triangles are 0 or nearly so. Numbers: the center,
/// the inradius.
template <Flaw flaw>
struct Flawed {
    template <class Real>
    CISTULA_HD void operator()(const Setup<Real>& setup, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> middle = setup.vector(0);
        const double reach = draw.one_in(8) ? 0.0 : 0.9;
        const Vec3<Real> origin(middle + in_ball(draw) * (reach * setup.numbers[3]));
        const Ray<Real> ray = aimed(setup, draw, origin, setup.point(i % setup.points.size));
        tally.expect(flawed_crossings<flaw>(setup.scene, ray) == 1);
    }
};

}  // namespace cistula::verify::geometry
