// The eight flips of axes, with and without swapping x and y: rays and their images at symmetric scenes give equal
// hits.
#pragma once

#include "apps/render_verify/crossings.h"
#include "apps/render_verify/metamorphic/films.h"

namespace cistula::verify::metamorphic {

/// The image of a vector. Bit 3: swap x and y; bits 0 to 2: flip axes after that.
template <class Real>
CISTULA_HD Vec3<Real> mapped(const Vec3<Real>& p, uint32_t map) {
    const Vec3<Real> q = (map & 8u) != 0 ? Vec3<Real>(p.y, p.x, p.z) : p;
    return {(map & 1u) != 0 ? -q.x : q.x, (map & 2u) != 0 ? -q.y : q.y, (map & 4u) != 0 ? -q.z : q.z};
}

/// Crossings of a line with a solid: t and kind of the first ones, and their number.
template <class Real>
struct LineCrossings {
    static constexpr uint32_t most = 8;
    Real t[most];
    CrossingKind kind[most];
    uint32_t count = 0;

    template <class Intersector>
    CISTULA_HD LineCrossings(const Intersector& intersector, Ray<Real> ray) {
        ray.accept_both_sides();
        for (; count < most; ++count) {
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found()) return;
            t[count] = hit.t;
            kind[count] = key_kind(hit.key);
            ray.media.add(key_solid(hit.key), media_change(kind[count]));
            ray.after = {hit.t, hit.key};
        }
    }
    CISTULA_HD bool same(const LineCrossings& other, bool times) const {
        if (count != other.count) return false;
        for (uint32_t i = 0; i < count; ++i)
            if (kind[i] != other.kind[i] || (times && t[i] != other.t[i])) return false;
        return true;
    }
};

/// Rays at a solid about the origin, from outside and from inside, and at what they become. `maps`: 8, or 16 with the
/// swap. Targets are corners and points of edges, from inside as they are, from outside scattered: there an edge that
/// is met exactly at the silhouette is a hit or none by which side owns it.
template <bool times>
struct Flips {
    uint32_t maps;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const bool from_inside = draw.one_in(2);
        Vec3<Real> target = setup.point(i % setup.points.size);
        const Vec3<double> start = from_inside ? in_ball(draw) * 0.4 : on_sphere(draw) * 1.9;
        const Vec3<Real> origin(start);
        if (!from_inside) target = target * draw.centered<Real>(Real(2));
        const Vec3<Real> way = target - origin;
        Ray<Real> ray = ray_from(origin, times || draw.one_in(2) ? normalized(way) : way);
        if (from_inside) ray.media.add(0, 1);
        const LineCrossings<Real> expected(intersector, ray);
        tally.witness(expected.count > 1);
        for (uint32_t map = 1; map < maps; ++map) {
            Ray<Real> turned = ray;
            turned.origin = mapped(ray.origin, map);
            turned.direction = mapped(ray.direction, map);
            tally.expect(LineCrossings<Real>(intersector, turned).same(expected, times));
        }
    }
};

/// Number of maps to test for a solid: 8, or 16 with the swap. The tetrahedron has none of the flips and is left out.
inline uint32_t maps_of(PlatonicSolid kind) {
    return kind == PlatonicSolid::cube || kind == PlatonicSolid::octahedron ? 16 : 8;
}
/// Corners on multiples of 2^-10: their flips, and those of the frame's center, are exact.
inline TrianglesObject on_grid(TrianglesObject mesh) {
    for (glm::dvec3& p : mesh.vertices)
        for (int axis = 0; axis < 3; ++axis) {
            const double size = std::floor(std::abs(p[axis]) * 0x1p10 + 0.5) * 0x1p-10;
            p[axis] = p[axis] < 0 ? -size : size;
        }
    return mesh;
}
template <class Case>
void plan_flips(Plan& plan, Shape shape) {
    for (const PlatonicSolid kind : platonic_solids) {
        if (kind == PlatonicSolid::tetrahedron) continue;
        SceneDescription scene = empty_scene();
        scene.frame = FrameOfReference();
        const SolidObject solid = solid_object(kind);
        std::vector<glm::dvec3> points = edge_points(solid);
        if (shape == Shape::planes) {
            add_object(scene, solid);
        } else {
            const TrianglesObject mesh = on_grid(triangulated_solid(solid));
            add_object(scene, mesh);
            points = mesh.vertices;
            for (const auto& edge : platonic_shape(kind).edges)
                for (int k = 1; k < 16; ++k)
                    points.push_back(mesh.vertices[edge.vertices[0]] * (1 - k / 16.0) +
                                     mesh.vertices[edge.vertices[1]] * (k / 16.0));
        }
        plan.add(platonic_name(kind), scene, Case{{maps_of(kind)}}, points, plan.rays(1'000'000, 12'000));
    }
}

struct FlipsOfPlanes : Flips<true> {
    static constexpr const char* name = "metamorphic/flips/planes";
    static constexpr const char* exact = "crossings and their t for flipped axes and x, y swapped";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_flips<FlipsOfPlanes>(plan, Shape::planes); }
};

struct FlipsOfTriangles : Flips<false> {
    static constexpr const char* name = "metamorphic/flips/triangles";
    static constexpr const char* exact = "number and kind of the crossings for flipped axes and x, y swapped";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_flips<FlipsOfTriangles>(plan, Shape::triangles); }
};

/// Mirrors, glass and lights on solids of planes: dot is symmetric in x and y, so that a flipped scene has the mirrored
/// image to the bit. Not so with triangles, whose shear has an order of axes.
struct FlippedImages {
    static constexpr const char* name = "metamorphic/flips/images";
    static constexpr const char* exact = "sums and Z of mirrored pixels, in scenes of planes";
    static constexpr Bound bound = no_failures("pixels");
    static constexpr bool needs_witness = true;

    static SceneDescription scene_of(bool swappable) {
        SceneDescription scene = empty_scene();
        scene.ambient = {0.1, 0.2, 0.3};
        scene.background = {0.2, 0.1, 0.4};
        scene.frame = FrameOfReference{{0, 0, 0}, -3, {}};
        MaterialDescription glass;
        glass.reflection = 0.2;
        glass.transmission = 0.7;
        glass.tint = {1, 0.5, 0.25};
        glass.index = 1.5;
        glass.fresnel = true;
        glass.absorption = {0.1, 0.2, 0.3};
        glass.specular = 0.5;
        MaterialDescription mirror;
        mirror.color = {0.9, 0.6, 0.3};
        mirror.reflection = 0.5;
        mirror.specular = 0.4;
        const int clear = add_material(scene, glass), shiny = add_material(scene, mirror);
        const PlatonicSolid round = swappable ? PlatonicSolid::octahedron : PlatonicSolid::icosahedron;
        const PlatonicSolid other = swappable ? PlatonicSolid::cube : PlatonicSolid::dodecahedron;
        add_object(scene, solid_object(PlatonicSolid::cube, {0, 0, -6}, 8), shiny);  // the ground
        add_object(scene, solid_object(round, {0.5, 0.25, 0.375}, 1.25), clear);
        add_object(scene, solid_object(other, {-1.5, 1.75, 0.125}, 1), shiny);
        add_object(scene, solid_object(other, {-1.25, -1.5, 0.25}, 1.125), clear);
        LightDescription& seen = add_light(scene, {2, -1.5, 2.5});
        seen.radius = 0.25;
        seen.falloff = true;
        seen.glow = glm::dvec3(0.9);
        seen.color = {4, 3, 2};
        add_light(scene, {-3, 2, 4});
        return scene;
    }
    static SceneDescription mapped_scene(SceneDescription scene, uint32_t map) {
        for (ObjectDescription& object : scene.objects) {
            auto& solid = std::get<SolidObject>(object.shape);
            solid.center = mapped(solid.center, map);
        }
        for (LightDescription& light : scene.lights) light.position = mapped(light.position, map);
        scene.camera.position = mapped(scene.camera.position, map);
        scene.camera.target = mapped(scene.camera.target, map);
        scene.camera.up = mapped(scene.camera.up, map);
        return scene;
    }

    static void render(Stage& stage, Tally& tally) {
        const int width = stage.quick ? 48 : 320, height = stage.quick ? 32 : 200;
        for (const bool swappable : {false, true}) {
            SceneDescription scene = scene_of(swappable);
            // In the plane of x and z the axes of the camera are exact when x and y are swapped.
            scene.camera.position = swappable ? glm::dvec3(5, 0, 2.5) : glm::dvec3(4.5, -3.25, 2.5);
            const FrameSettings settings = frame_of(width, height, 1, 6);
            const Film expected = stage.render(scene, settings);
            tally.witness(shows_something(expected));
            for (uint32_t map = 1; map < (swappable ? 16u : 8u); ++map) {
                const Film found = stage.render(mapped_scene(scene, map), settings);
                // Each flip, and the swap, turns the picture's right into its left.
                const bool turned = ((map & 1u) + (map >> 1 & 1u) + (map >> 2 & 1u) + (map >> 3 & 1u)) % 2 != 0;
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        const PixelRecord& a = expected.pixels[size_t(y * width + x)];
                        PixelRecord b = found.pixels[size_t(y * width + (turned ? width - 1 - x : x))];
                        const Vec3<float> normal = mapped(Vec3<float>(a.normal[0], a.normal[1], a.normal[2]), map);
                        bool same = true;
                        for (int c = 0; c < 3; ++c) same &= b.normal[c] == normal[c], b.normal[c] = a.normal[c];
                        tally.place = place_of(swappable, map, size_t(y * width + x));
                        tally.expect(same && found.flags == 0 && same_pixel(a, b));
                    }
            }
        }
    }
};

}  // namespace cistula::verify::metamorphic
