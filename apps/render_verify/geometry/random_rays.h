// Random rays: all intersectors must find the same hits.
#pragma once

#include "apps/render_verify/geometry/fans.h"
#include "apps/render_verify/geometry/upright_solids.h"

namespace cistula::verify::geometry {

inline TrianglesObject moved(TrianglesObject mesh, const glm::dvec3& center, const glm::dvec3& scale) {
    for (glm::dvec3& v : mesh.vertices) v = center + v * scale;
    return mesh;
}

/// A random point for plans; drawn on the host, equal everywhere.
inline glm::dvec3 drawn(Draw& draw, double half) {
    const double x = draw.centered(half), y = draw.centered(half), z = draw.centered(half);
    return {x, y, z};
}

struct RandomRays {
    static constexpr const char* name = "geometry/random-rays";
    static constexpr const char* exact =
        "t, u, v and key of three crossings: those of a plain loop over all primitives";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool compared = true;

    static void plan(Plan& plan) {
        const uint64_t rays = plan.rays(1'700'000, 8000);  // six scenes
        Draw draw(0, 7);
        const auto add = [&](const char* label, const SceneDescription& scene) {
            std::vector<glm::dvec3> points;
            for (const ObjectDescription& object : scene.objects) {
                const auto* solid = std::get_if<SolidObject>(&object.shape);
                const auto* mesh = std::get_if<TrianglesObject>(&object.shape);
                const std::vector<glm::dvec3> more = solid ? edge_points(*solid) : mesh->vertices;
                points.insert(points.end(), more.begin(), more.end());
            }
            plan.add(label, scene, RandomRays{}, points, rays);
        };
        SceneDescription soup = empty_scene();
        add_object(soup, triangle_soup(1500, 0.4, 1));
        add("triangle soup", soup);
        SceneDescription slivers = empty_scene();
        add_object(slivers, moved(triangle_soup(400, 0.8, 2), glm::dvec3(0), {1, 1e-6, 1}));
        add_object(slivers, moved(triangle_soup(400, 1, 3), glm::dvec3(0.1), {1e-7, 1, 1e-4}));
        add("slivers", slivers);
        SceneDescription closed = empty_scene();
        add_object(closed, bumpy_sphere(1000));
        add_object(closed, moved(torus(1, 0.4, 24, 16), glm::dvec3(0), glm::dvec3(0.6)));
        add_object(closed, moved(star(), {0.7, 0, 0}, glm::dvec3(0.8)));
        add_object(closed, lens(31, {0, 0, 0.5}, 0.25));
        add("closed meshes", closed);
        SceneDescription nested = empty_scene();
        for (int k = 0; k < 5; ++k)
            add_object(nested, solid_object(platonic_solids[k], glm::dvec3(0), 1.0 / (1 + k * k), drawn(draw, 180)));
        for (int k = 0; k < 3; ++k)
            add_solid(nested, Shape::triangles, solid_object(PlatonicSolid::cube, glm::dvec3(0.02 * k), 0.8 - 0.2 * k));
        add("nested solids", nested);
        SceneDescription many = empty_scene();
        for (int k = 0; k < 60; ++k) {
            const glm::dvec3 center = drawn(draw, 2), turn = k % 3 ? drawn(draw, 180) : glm::dvec3(0);
            add_object(many, solid_object(platonic_solids[k % 5], center, 0.05 + 0.5 * draw.unit<double>(), turn));
        }
        add("many solids", many);
        SceneDescription touching = empty_scene();
        const double side = 2 / std::sqrt(3.0);
        for (int k = 0; k < 27; ++k)
            add_solid(touching, k % 2 ? Shape::planes : Shape::triangles,
                      solid_object(PlatonicSolid::cube, {side * (k % 3), side * (k / 3 % 3), side * (k / 9)}));
        TrianglesObject floor;
        floor.vertices = {{-2, -2, -1}, {4, -2, -1}, {4, 4, -1}, {-2, 4, -1}};
        floor.triangles = {{0, 1, 2}, {0, 2, 3}};
        add_object(touching, floor);
        add("touching cubes", touching);
    }

    template <class Real, class Intersector>
    CISTULA_HD uint64_t fingerprint(const Setup<Real>& setup, const Intersector& intersector, uint64_t i) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        const double far = draw.one_in(5) ? 0.9 : 1.9;
        const Vec3<Real> origin(on_sphere(draw) * (far * extent));
        const uint32_t kind = draw.below(4);
        const Vec3<Real> vertex = setup.point(draw.below(setup.points.size)),
                         other = setup.point(draw.below(setup.points.size));
        Vec3<Real> target = draw.in_cube(setup.extent());
        if (kind == 0) target = vertex;
        if (kind == 1) target = along(vertex, draw.unit<Real>(), other - vertex);
        Ray<Real> ray = aimed(setup, draw, origin, target);
        if (draw.one_in(16)) {
            ray.direction = Vec3<Real>(Real(0));
            const int axis = draw.between(0, 2);
            ray.direction[axis] = Real(draw.sign());
            ray.origin = target;
            ray.origin[axis] = Real(-1.25) * setup.extent() * ray.direction[axis];
        }
        uint64_t word = 0;
        for (int crossing = 0; crossing < 3; ++crossing) {
            const Hit<Real> hit = intersector.closest(ray);
            word = parity::mixed(word ^ hit.key);
            word = parity::mixed(word ^ bits(hit.t));
            word = parity::mixed(word ^ bits(hit.u));
            word = parity::mixed(word ^ bits(hit.v));
            word = parity::mixed(word ^ (2 * uint64_t(hit.slot) + uint64_t(hit.enters)));
            if (!hit.found()) break;
            const int change = media_change(key_kind(hit.key));
            if (change != 0) ray.media.add(key_solid(hit.key), change);
            ray.after = {hit.t, hit.key};
        }
        return word;
    }

  private:
    template <class Real>
    CISTULA_HD static uint64_t bits(Real x) {
        return uint64_t(bits_as<typename parity::Layout<Real>::Bits>(x));
    }
};

}  // namespace cistula::verify::geometry
