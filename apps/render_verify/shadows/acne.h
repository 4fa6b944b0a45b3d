// No face and no convex body shadows itself: a face toward a light is fully lit, bit for bit.
#pragma once

#include "apps/render_verify/shadows/local_light.h"

namespace cistula::verify::shadows {

/// Rays at a convex body from all around, with one light each. Numbers: the body's center and radius.
struct LitInFull {
    uint32_t solid;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<double> middle(setup.numbers[0], setup.numbers[1], setup.numbers[2]);
        const double radius = setup.numbers[3], extent = double(setup.extent());
        const double away = min_or_second(2.5 * radius, 1.95 * extent - length(middle));
        const Vec3<double> from = on_sphere(draw);
        const Vec3<double> at = in_ball(draw);
        const Vec3<Real> origin(middle + from * away), target(middle + at * (0.9 * radius));
        const Ray<Real> ray = ray_from(origin, normalized(target - origin));
        const Hit<Real> hit = intersector.closest(ray);
        if (!hit.found() || key_solid(hit.key) != solid) return;
        const uint32_t light = draw.below(setup.scene.lights.size);
        const Surface<Real> surface = surface_at<Real, All>(setup.scene, ray, hit);
        const LocalLight lit = local_light(setup, intersector, ray, hit, surface, light);
        const LocalLight open = local_light(setup, Unshadowed(), ray, hit, surface, light);
        // Where the light is clearly over or under the face: beyond what counts as in its plane (16 u M), the start of
        // the line (8 u M over the face) and the rounding of a dot product (5 u of the distance), all twice.
        const Vec3<double> way = Vec3<double>(setup.scene.lights[light].position) - Vec3<double>(surface.point);
        const double over = dot(Vec3<double>(surface.normal), way), distance = length(way);
        const double doubt = double(RealTraits<Real>::unit) * (48 * extent + 10 * distance);
        tally.witness(lit.shadow_rays != 0 && over < distance * 0x1p-6);
        tally.expect(lit == open && lit.flags == 0 &&
                     (over > doubt ? lit.radiance[0] > 0 : over >= -doubt || lit.dark()));
    }
};

/// Eight lights around a body, four far ones, and twelve that graze its faces: in the frame the lowest is 2^-18 of the
/// radius over the plane of a face.
inline void add_lights_around(SceneDescription& scene, const SolidObject& body) {
    const PlatonicShape& shape = platonic_shape(body.solid);
    const Rotation turned(body.rotation);
    for (uint32_t k = 0; k < 12; ++k) {
        const double z = (2.0 * k + 1) / 12 - 1, r = std::sqrt(1 - z * z), a = 2.4 * k;
        add_light(scene, body.center +
                             glm::dvec3(r * std::cos(a), r * std::sin(a), z) * (body.radius * (k % 3 ? 3.0 : 100.0)));
    }
    for (uint32_t k = 0; k < 12; ++k) {
        const auto& face = shape.faces[k % shape.faces.size()];
        const glm::dvec3 along_face = shape.vertices[face.vertices[k % 3]] - face.normal * shape.inradius;
        const double height = shape.inradius + std::ldexp(1.0, int(k % 4) * 5 - 18);
        add_light(scene, body.center + turned(face.normal * height + along_face * (k % 2 ? 0.5 : 3.0)) * body.radius);
    }
}

/// The object at a placement: a solid of planes, its triangles, or a square that faces up before rotation.
enum class Body { planes, triangles, sheet };

template <class Functor>
void plan_acne(Plan& plan, Body body, const std::vector<double>& offsets, bool far_from_the_middle) {
    const uint64_t rays = plan.rays(400'000, 2000);
    const auto tilts = {glm::dvec3(0), glm::dvec3(0x1p-10, 0, 0), glm::dvec3(45, 0, 0), glm::dvec3(17, 41, 73),
                        glm::dvec3(89.99, 0, 45)};
    for (const double offset : offsets)
        for (const glm::dvec3& tilt : tilts)
            for (const PlatonicSolid kind : {PlatonicSolid::cube, PlatonicSolid::dodecahedron}) {
                const SolidObject solid = solid_object(kind, glm::dvec3(1, -0.7, 0.3) * offset, 1, tilt);
                SceneDescription scene = lit_scene();
                if (body == Body::sheet) {
                    const uint32_t cells = kind == PlatonicSolid::cube ? 1 : 8;
                    add_object(scene, square(0.8, platonic_shape(kind).inradius, cells, false, tilt, solid.center));
                } else {
                    add_solid(scene, body == Body::planes ? Shape::planes : Shape::triangles, solid);
                }
                // Something at the other end makes the scene as large as the offset.
                if (far_from_the_middle) add_solid(scene, Shape::planes, solid_object(PlatonicSolid::cube));
                add_lights_around(scene, solid);
                char where[96];
                std::snprintf(where, sizeof where, ", offset %g, tilts %g %g %g", offset, tilt.x, tilt.y, tilt.z);
                Part& part =
                    plan.add(platonic_name(kind) + std::string(where), std::move(scene), Functor{{0}}, {}, rays);
                part.frame_numbers = [solid](const glm::dvec3& center, double factor, std::vector<double>& numbers) {
                    const glm::dvec3 middle = (solid.center - center) * factor;
                    numbers = {middle.x, middle.y, middle.z, solid.radius * factor};
                };
            }
}

/// Offsets of solids in scene units, which scene coordinates take away.
inline const std::vector<double> acne_offsets = {0, 1, 1e3, 1e6};

struct AcnePlanes : LitInFull {
    static constexpr const char* name = "shadows/acne/planes";
    static constexpr const char* exact = "a convex solid lights up in full, tilts x offsets 0 to 1e6";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_acne<AcnePlanes>(plan, Body::planes, acne_offsets, false); }
};

struct AcneTriangles : LitInFull {
    static constexpr const char* name = "shadows/acne/triangles";
    static constexpr const char* exact = "a convex mesh lights up in full, tilts x offsets 0 to 1e6";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_acne<AcneTriangles>(plan, Body::triangles, acne_offsets, false); }
};

struct AcneSheets : LitInFull {
    static constexpr const char* name = "shadows/acne/sheets";
    static constexpr const char* exact = "a square lights up in full, tilts x offsets 0 to 1e6";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_acne<AcneSheets>(plan, Body::sheet, acne_offsets, false); }
};

/// So far from the middle of its scene, whose size is that distance, that the body is 2^-10 to 2^-20 of it.
struct AcneFarPlanes : LitInFull {
    static constexpr const char* name = "shadows/acne/far-from-the-middle/planes";
    static constexpr const char* exact = "the same of a solid 1e3 to 1e6 radii from the middle of its scene";
    static constexpr Bound bound = no_failures("pixels");
    static void plan(Plan& plan) { plan_acne<AcneFarPlanes>(plan, Body::planes, {1e3, 1e4, 1e5, 1e6}, true); }
};

struct AcneFarTriangles : LitInFull {
    static constexpr const char* name = "shadows/acne/far-from-the-middle/triangles";
    static constexpr bool float_warns = true;
    static constexpr const char* exact = "the same of a mesh 1e3 to 1e5 radii from the middle of its scene";
    static constexpr Bound bound = no_failures("pixels");
    static void plan(Plan& plan) { plan_acne<AcneFarTriangles>(plan, Body::triangles, {1e3, 1e4, 1e5}, true); }
};

/// A mesh of a dozen ulps of its coordinates.
struct AcneTinyTriangles : LitInFull {
    static constexpr const char* name = "shadows/acne/far-from-the-middle/tiny-triangles";
    static constexpr bool float_warns = true;
    static constexpr const char* exact = "the same of a mesh 1e6 radii from the middle of its scene";
    static constexpr Bound bound = no_failures("pixels");
    static void plan(Plan& plan) { plan_acne<AcneTinyTriangles>(plan, Body::triangles, {1e6}, true); }
};

/// The facets of a coarse sphere that the light just reaches are fully lit, those that it just misses are dark: facets
/// cast no jagged shadows on one another.
struct Terminator : LitInFull {
    static constexpr const char* name = "shadows/terminator";
    static constexpr const char* exact = "facets of a coarse sphere are lit by their own half-space alone";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static void plan(Plan& plan) {
        for (const uint32_t triangles : {24u, 80u, 360u, 1500u})
            for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)}) {
                SceneDescription scene = lit_scene();
                TrianglesObject sphere = bumpy_sphere(triangles, 0);
                const Rotation turned(rotation);
                for (glm::dvec3& p : sphere.vertices) p = turned(p);
                add_object(scene, sphere);
                for (uint32_t k = 0; k < 16; ++k) {
                    const double a = 0.39 * k, far = k % 4 == 3 ? 1000 : 1.25 + k;
                    add_light(scene, glm::dvec3(std::cos(a), std::sin(a), k % 2 ? 0.1 * k : 0.0) * far);
                }
                Part& part = plan.add(std::to_string(triangles) + " triangles", std::move(scene), Terminator{{0}}, {},
                                      plan.rays(500'000, 8000));
                part.frame_numbers = [](const glm::dvec3& center, double factor, std::vector<double>& numbers) {
                    const glm::dvec3 middle = -center * factor;
                    numbers = {middle.x, middle.y, middle.z, factor};
                };
            }
    }
};

}  // namespace cistula::verify::shadows
