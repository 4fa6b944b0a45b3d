// Lines that start on a face, an edge or a vertex of a solid, as reflected and refracted rays do.
#pragma once

#include "apps/render_verify/geometry/edges_from_outside.h"
#include "cistula/shading/surface.h"

namespace cistula::verify::geometry {

/// Starts on solids of planes: within rounding of two faces or more, one of which is the face just left.
struct OriginsOnPlanes {
    static constexpr const char* name = "geometry/origins-on-faces/planes";
    static constexpr const char* exact =
        "inward or along it: one way out, by a neighbor where that is near; outward: nothing";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;

    uint32_t solid;
    bool tiny;

    static void plan(Plan& plan) { plan_solids<OriginsOnPlanes>(plan, Shape::planes, 512, 8); }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
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
    template <class Real, class Intersector>
    CISTULA_HD Hit<Real> first_of(const Intersector& intersector, Ray<Real> ray) const {
        for (;;) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found() || key_solid(hit.key) == solid) return hit;
            ray.media.add(key_solid(hit.key), media_change(key_kind(hit.key)));
            ray.after = {hit.t, hit.key};
        }
    }
};

/// Starts on solids of triangles: a ray finds the face, and the next line starts there as the ray tree starts it.
struct FromTriangles {
    uint32_t solid;
    bool tiny;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        const Vec3<Real> target = setup.point(i % setup.points.size);
        const Vec3<double> middle(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
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
        if (draw.one_in(2)) way = normalized(setup.point(draw.below(setup.points.size)) - surface.viewer_side);
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

struct OriginsOnTriangles : FromTriangles {
    static constexpr const char* name = "geometry/origins-on-faces/triangles";
    static constexpr const char* exact = "inward: one way out, not by the face left; outward: nothing";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) {
        plan_solids<OriginsOnTriangles>(plan, Shape::triangles, 512, 8);
        std::erase_if(plan.parts, [](const Part& part) { return part_is_tiny(part); });
    }
    static bool part_is_tiny(const Part& part) { return part.scene.objects.size() > 1; }
};

struct OriginsOnTinyTriangles : FromTriangles {
    static constexpr const char* name = "geometry/origins-on-faces/tiny-triangles";
    static constexpr bool float_warns = true;
    static constexpr const char* exact = "the same on a 2^-20 solid beside a unit one: a way out more than ways in";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) {
        plan_solids<OriginsOnTinyTriangles>(plan, Shape::triangles, 512, 8);
        std::erase_if(plan.parts, [](const Part& part) { return !OriginsOnTriangles::part_is_tiny(part); });
    }
};

}  // namespace cistula::verify::geometry
