// Paths inside closed solids: reflected, and sometimes aimed at difficult places.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/crossings.h"
#include "apps/render_verify/mirrors/closed_meshes.h"
#include "apps/render_verify/scenes.h"
#include "cistula/shading/snell.h"
#include "cistula/shading/surface.h"

namespace cistula::verify::mirrors {

/// How a line starts on a face.
enum class Start : uint32_t {
    as_rendered,
    face_left_out,  // on the face itself, which is excluded; no other state
    epsilon,        // on a convex solid's face; planes nearer than an epsilon are excluded, with no other state
};

inline constexpr uint32_t path_length = 100;

/// Paths aimed at corners, edges and faces. Numbers: a point inside, and the radius around it that is inside, too.
struct BouncesInside {
    Start start;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        const SceneView<Real>& scene = setup.scene;
        const bool convex = scene.solids[0].kind == SolidKind::convex;
        Draw draw = setup.draw(i);
        Ray<Real> ray;
        bool afresh = true;
        for (uint32_t n = 0; n < path_length; ++n) {
            const bool bounced = !afresh;
            if (afresh) ray = anew(setup, draw);
            afresh = true;
            const Hit<Real> hit = start == Start::epsilon ? beyond_epsilon(scene, ray) : intersector.closest(ray);
            bool good = hit.found() && key_kind(hit.key) == CrossingKind::leave &&
                        !(ray.from_solid == 0 && key_face(hit.key) == ray.from_face);
            // By parity the start is inside, exactly: on a mesh without any memory of the face that it left.
            if (good && n % 16 == 15 && start == Start::as_rendered) {
                Ray<Real> line = ray;
                if (!convex) line.from_solid = no_solid;
                const Crossings crossings = cross_all(intersector, line);
                good = crossings.in_order && crossings.leaves == crossings.enters + 1;
            }
            if (good) {
                const Surface<Real> s = surface_at<Real, Effects<0>>(scene, ray, hit);
                good = !convex || within_box(scene, s.point);
                Vec3<Real> way = reflected(ray.direction, s.normal);
                const bool aim = draw.one_in(4);
                const Vec3<Real> target = setup.point(draw.below(setup.points.size));
                const Vec3<Real> aimed_at = normalized(target - s.viewer_side);
                if (aim && dot(aimed_at, s.normal) > Real(0)) way = aimed_at;
                ray = leaving(start == Start::as_rendered ? s.viewer_side : s.point, way, hit, ray.media);
                if (start != Start::as_rendered) ray.after = {Real(0), 0};
                afresh = !good;
            }
            // In meshes, the way to the first face is tested by FirstLines.
            if (bounced || convex) tally.expect(good);
        }
    }

  protected:
    /// A line that starts inside, on no face.
    template <class Real>
    CISTULA_HD static Ray<Real> anew(const Setup<Real>& setup, Draw& draw) {
        const Vec3<double> middle(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
        const Vec3<Real> origin(middle + in_ball(draw) * setup.numbers[3]);
        const Vec3<Real> target = setup.point(draw.below(setup.points.size)), any(on_sphere(draw));
        return inside(ray_from(origin, draw.one_in(2) ? any : normalized(target - origin)), 0);
    }

  private:
    /// The nearest plane that the line leaves more than 2^-16 M ahead: the usual epsilon method of other renderers.
    template <class Real>
    CISTULA_HD static Hit<Real> beyond_epsilon(const SceneView<Real>& scene, const Ray<Real>& ray) {
        Hit<Real> best;
        for (uint32_t k = 0; k < scene.solids[0].slab_count; ++k) {
            const Slab<Real>& slab = scene.slabs[scene.solids[0].first_slab + k];
            const Real slope = dot(slab.normal, ray.direction);
            const bool high = slope > Real(0);
            const Real t = ((high ? slab.high : slab.low) - dot(slab.normal, ray.origin)) / slope;
            if (t > Real(0x1p-16) * scene.extent && t < best.t)
                best = {t, make_key(CrossingKind::leave, 0, 2 * k + (high ? 1 : 0)), Real(0), Real(0), 0, false};
        }
        return best;
    }
    /// Whether a point is at most as far outside as the trees' boxes allow for: 64 u M (docs/rules.md, 1).
    template <class Real>
    CISTULA_HD static bool within_box(const SceneView<Real>& scene, const Vec3<Real>& point) {
        const Vec3<double> p(point);
        const double most = 64 * double(RealTraits<Real>::unit * scene.extent);
        bool within = true;
        for (uint32_t k = 0; k < scene.solids[0].slab_count; ++k) {
            const Slab<Real>& slab = scene.slabs[scene.solids[0].first_slab + k];
            const double at = dot(Vec3<double>(slab.normal), p);
            within = within && at <= double(slab.high) + most && at >= double(slab.low) - most;
        }
        return within;
    }
};

template <class Case>
Part& add_inside(Plan& plan, const std::string& label, const SceneDescription& scene, Start start,
                 const std::vector<glm::dvec3>& points, const glm::dvec3& middle, double around, uint64_t paths) {
    Part& part = plan.add(label, scene, Case{{start}}, points, paths);
    part.frame_numbers = [=](const glm::dvec3& center, double factor, std::vector<double>& numbers) {
        const glm::dvec3 m = (middle - center) * factor;
        numbers = {m.x, m.y, m.z, around * factor};
    };
    return part;
}

template <class Case>
void plan_planes(Plan& plan, Start start, uint64_t full, uint64_t quick) {
    for (const double scale : {1.0, 1e-5})
        for (const PlatonicSolid kind : platonic_solids)
            for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)}) {
                const SolidObject solid = solid_object(kind, glm::dvec3(0), scale, rotation);
                SceneDescription scene = empty_scene();
                add_object(scene, solid);
                std::vector<glm::dvec3> points = mesh_points(triangulated_solid(solid));
                const auto edges = edge_points(solid);
                points.insert(points.end(), edges.begin(), edges.end());
                add_inside<Case>(plan, platonic_name(kind) + std::string(scale == 1 ? "" : " at 1e-5"), scene, start,
                                 points, glm::dvec3(0), 0.25 * scale * platonic_shape(kind).inradius,
                                 plan.rays(full, quick));
            }
}

template <class Case>
void plan_meshes(Plan& plan, Start start, uint64_t full, uint64_t quick) {
    for (const double scale : {1.0, 1e-5})
        for (InsideOf body : closed_meshes()) {
            for (glm::dvec3& v : body.mesh.vertices) v *= scale;
            SceneDescription scene = empty_scene();
            add_object(scene, body.mesh);
            add_inside<Case>(plan, body.name + std::string(scale == 1 ? "" : " at 1e-5"), scene, start,
                             mesh_points(body.mesh), body.middle * scale, body.around * scale, plan.rays(full, quick));
        }
}

}  // namespace cistula::verify::mirrors
