// A camera inside a solid must see what a ray from outside sees as it continues from there: the same media, next face
// and refraction.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/refraction/lines.h"
#include "apps/render_verify/scenes.h"
#include "cistula/transport/pixel.h"

namespace cistula::verify::refraction {

struct CameraInside {
    static constexpr const char* name = "refraction/camera-inside";
    static constexpr const char* exact = "media, next face and next direction of a ray from outside, bit for bit";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> target(in_ball(draw) * 1.0), origin(on_sphere(draw) * (2 * double(setup.extent())));
        Lines<Real> lines;
        trace(setup, intersector, ray_from(origin, normalized(target - origin)), lines);
        if (lines.count < 2) return;
        const int line = int(draw.below(uint32_t(lines.count)));
        const Hit<Real> ahead = lines.first[line];
        const Vec3<Real> direction = lines.direction[line];
        // Well between two faces.
        const Real gone = ahead.found() ? ahead.t * Real(0.25 + 0.5 * draw.unit<double>()) : Real(0.5);
        if (!(gone > Real(0x1p-7)) || edge_ahead(setup, intersector, lines, line)) return;
        const Vec3<double> camera = along(Vec3<double>(lines.origin[line]), double(gone), Vec3<double>(direction));
        InteriorList around;
        bool same = camera_solids(setup.scene, intersector, camera, around);
        for (uint32_t solid = 0; solid < setup.scene.solids.size; ++solid)
            same = same && around.count(solid) == lines.media[line].count(solid);
        Ray<Real> view = ray_from(Vec3<Real>(camera), direction);
        view.media = around;
        Lines<Real> seen;
        trace(setup, intersector, view, seen);
        same = same && seen.flags == 0 && seen.first[0].key == ahead.key;
        // A face that is passed without shading does not start a new line.
        if (line + 1 < lines.count && seen.count > 1 && same)
            same = seen.direction[1] == lines.direction[line + 1] && seen.index[1] == lines.index[line + 1];
        tally.expect(same);
        tally.witness(!around.empty());
    }

    /// Whether lines beside this one, farther away than rounding moves it, hit something else: an edge or a silhouette.
    template <class Real, class Intersector>
    CISTULA_HD static bool edge_ahead(const Setup<Real>& setup, const Intersector& intersector,
                                      const Lines<Real>& lines, int line) {
        Vec3<Real> origin = lines.origin[line];
        const Real beside = Real(256) * RealTraits<Real>::unit * setup.extent();
        for (int k = 0; k < 6; ++k) {
            Ray<Real> ray = ray_from(origin, lines.direction[line]);
            ray.origin[k / 2] += k % 2 != 0 ? beside : -beside;
            ray.media = lines.media[line];
            // Not from the face itself, which lines on its wrong side would hit: from a little farther on.
            ray.origin = along(ray.origin, min_or_second(lines.first[line].t * Real(0.125), Real(0.0625)),
                               lines.direction[line]);
            if (intersector.closest(ray).key != lines.first[line].key) return true;
        }
        return false;
    }

    static void plan(Plan& plan) {
        const auto add = [&](const char* label, const SceneDescription& scene) {
            plan.add(label, scene, CameraInside(), {}, plan.rays(200000, 1500));
        };
        for (const Shape shape : {Shape::planes, Shape::triangles}) {
            SceneDescription nested = empty_scene(), overlapping = empty_scene();
            const double indices[] = {1.5, 1.33, 2};
            for (int k = 0; k < 3; ++k) {
                const PlatonicSolid kind = platonic_solids[4 - k];
                const glm::dvec3 turn(10 * k, 20, 30 + k);
                add_solid(nested, shape, solid_object(kind, {}, 1.2 / (1 << k), turn),
                          add_material(nested, glass(indices[k])));
                add_solid(overlapping, shape, solid_object(kind, {0.375 * (k - 1), 0.125 * k, 0}, 0.75, turn),
                          add_material(overlapping, glass(indices[k])));
            }
            add(shape == Shape::planes ? "nested planes" : "nested meshes", nested);
            add(shape == Shape::planes ? "overlapping planes" : "overlapping meshes", overlapping);
        }
        SceneDescription hollow = empty_scene(), spiked = empty_scene();
        add_object(hollow, torus(0.8, 0.3, 24, 12), add_material(hollow, glass(1.5)));
        add_solid(hollow, Shape::planes, solid_object(PlatonicSolid::icosahedron, {0.8, 0, 0}, 0.4),
                  add_material(hollow, glass(1.33)));
        add_object(spiked, star(), add_material(spiked, glass(1.25)));
        add("a torus with a solid", hollow);
        add("a star", spiked);
    }
};

}  // namespace cistula::verify::refraction
