// Scenes made in memory for tests, and random numbers for them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "cistula/traversal/brute.h"
#include "scene/compile/compiled_scene.h"
#include "scene/description/platonic.h"
#include "scene/description/rotation.h"

namespace cistula::test {

using glm::dvec3;

inline constexpr PlatonicSolid platonic_solids[] = {PlatonicSolid::tetrahedron, PlatonicSolid::cube,
                                                    PlatonicSolid::octahedron, PlatonicSolid::dodecahedron,
                                                    PlatonicSolid::icosahedron};

/// A random generator with the same numbers on every machine: the standard's engine with our own conversions.
class Random {
  public:
    explicit Random(uint64_t seed) : engine_(seed) {}
    uint64_t bits() { return engine_(); }
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    uint32_t below(uint32_t n) { return static_cast<uint32_t>((engine_() >> 32) * n >> 32); }
    dvec3 in_cube(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
    dvec3 direction() {
        for (;;) {
            const dvec3 p = in_cube(1);
            const double square = dot(p, p);
            if (square <= 1 && square > 0x1p-20) return p / square_root(square);
        }
    }

  private:
    std::mt19937_64 engine_;
};

// ---- descriptions

inline std::string numbered(std::string prefix, size_t number) {
    return prefix.append(std::to_string(number));
}

inline int add_material(SceneDescription& scene, double reflection = 0, double transmission = 0,
                        const dvec3& tint = dvec3(1), double index = 1) {
    MaterialDescription material;
    material.name = numbered("m", scene.materials.size());
    material.reflection = reflection;
    material.transmission = transmission;
    material.tint = tint;
    material.index = index;
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

inline void add_object(SceneDescription& scene, decltype(ObjectDescription::shape) shape, int material) {
    if (scene.materials.empty()) add_material(scene);
    ObjectDescription object;
    object.name = numbered("o", scene.objects.size());
    object.place = numbered("/objects/", scene.objects.size());
    object.material = material;
    object.shape = std::move(shape);
    scene.objects.push_back(std::move(object));
}

inline void add_solid(SceneDescription& scene, PlatonicSolid solid, const dvec3& center = dvec3(0), double radius = 1,
                      const dvec3& rotation = dvec3(0), int material = 0) {
    SolidObject object;
    object.solid = solid;
    object.center = center;
    object.radius = radius;
    object.rotation = rotation;
    add_object(scene, object, material);
}

/// A Platonic solid as a closed mesh that keeps its triangles.
inline TrianglesObject solid_mesh(PlatonicSolid solid, const dvec3& center = dvec3(0), double radius = 1,
                                  const dvec3& rotation = dvec3(0)) {
    const Rotation turned(rotation);
    TrianglesObject mesh;
    for (const dvec3& p : platonic_shape(solid).vertices) mesh.vertices.push_back(center + turned(radius * p));
    mesh.triangles = triangulated(platonic_shape(solid));
    mesh.keep_triangles = true;
    return mesh;
}

inline void add_light(SceneDescription& scene, const dvec3& position) {
    LightDescription light;
    light.position = position;
    light.place = numbered("/lights/", scene.lights.size());
    scene.lights.push_back(light);
}

template <class Real>
std::unique_ptr<CompiledScene<Real>> compile(const SceneDescription& scene, bool tree = false, int quality = 1) {
    std::unique_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(scene);
    if (tree) build_primitive_tree(*compiled, quality);
    return compiled;
}

// ---- compiled scenes, made by hand for what no description gives, such as triangles that are not finite

template <class Real>
using Triangle = std::array<Vec3<Real>, 3>;

/// Adds a solid of these triangles, eight to a cluster in their order.
template <class Real>
void add_clusters(CompiledScene<Real>& scene, const std::vector<Triangle<Real>>& triangles, SolidKind kind) {
    uint32_t number = 0;
    for (const auto& cluster : scene.clusters) number += cluster.count;
    if (scene.materials.empty()) scene.materials.emplace_back();
    const auto solid = static_cast<uint32_t>(scene.solids.size());
    Solid record{};
    record.kind = kind;
    record.first_triangle = number;
    scene.solids.push_back(record);
    for (size_t first = 0; first < triangles.size(); first += cluster_lanes) {
        Cluster<Real> cluster{};
        cluster.solid = solid;
        for (size_t i = first; i < triangles.size() && i < first + cluster_lanes; ++i, ++cluster.count) {
            cluster.triangle[cluster.count] = number++;
            for (int c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis) cluster.corner[c][axis][cluster.count] = triangles[i][c][axis];
        }
        scene.clusters.push_back(cluster);
    }
}

/// The corners of all triangles of a compiled scene, in the order of its clusters.
template <class Real>
std::vector<Triangle<Real>> all_triangles(const CompiledScene<Real>& scene) {
    std::vector<Triangle<Real>> triangles;
    for (const auto& cluster : scene.clusters)
        for (uint32_t lane = 0; lane < cluster.count; ++lane) {
            Triangle<Real> t;
            for (int c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis) t[size_t(c)][axis] = cluster.corner[c][axis][lane];
            triangles.push_back(t);
        }
    return triangles;
}

// ---- rays

template <class Real>
Ray<Real> ray_from(const Vec3<Real>& origin, const Vec3<Real>& direction) {
    Ray<Real> ray;
    ray.origin = origin;
    ray.direction = direction;
    return ray;
}

/// Passes a crossing: the ray continues straight on.
template <class Real>
void pass(Ray<Real>& ray, const Hit<Real>& hit) {
    if (key_kind(hit.key) != CrossingKind::sheet)
        ray.media.add(key_solid(hit.key), key_kind(hit.key) == CrossingKind::enter ? 1 : -1);
    ray.after = {hit.t, hit.key};
}

/// Starts a new line on a face as the ray tree does.
template <class Real>
Ray<Real> spawn(const Vec3<Real>& origin, const Vec3<Real>& direction, const Hit<Real>& hit,
                const InteriorList& media) {
    Ray<Real> ray = ray_from(origin, direction);
    ray.from_solid = key_solid(hit.key);
    ray.from_face = key_face(hit.key);
    ray.media = media;
    return ray;
}

/// Length of a line inside a Platonic solid about the origin whose planes are moved inward by `margin`.
inline double chord(const Polyhedron& shape, const Rotation& rotation, double radius, double margin,
                    const dvec3& origin, const dvec3& direction) {
    double enter = -1e300, leave = 1e300;
    for (const auto& face : shape.faces) {
        const dvec3 n = rotation(face.normal);
        const double nd = dot(n, direction), rest = shape.inradius * radius - margin - dot(n, origin);
        if (nd == 0 && rest <= 0) return 0;
        if (nd < 0) enter = max_or_second(enter, rest / nd);
        if (nd > 0) leave = min_or_second(leave, rest / nd);
    }
    return leave - enter;
}

struct Count {
    int enters = 0, leaves = 0, sheets = 0;
};

/// Follows a line through all crossings until nothing is hit; a line that starts on no face hits all. Crossings must
/// come in increasing order of (t, key), and end.
template <class Real, class Intersector>
Count cross_all(const Intersector& intersector, Ray<Real> ray) {
    Count count;
    if (ray.from_solid == no_solid && ray.fresh()) ray.accept_both_sides();
    for (int i = 0; i < 100000; ++i) {
        const Hit<Real> hit = intersector.closest(ray);
        if (!hit.found()) return count;
        if (!ray.after.before(hit.t, hit.key)) break;
        const CrossingKind kind = key_kind(hit.key);
        ++(kind == CrossingKind::enter ? count.enters : kind == CrossingKind::leave ? count.leaves : count.sheets);
        pass(ray, hit);
    }
    ADD_FAILURE() << "crossings do not advance or do not end";
    return count;
}

/// Adds visible lights that give no light: `count` on every edge of every solid, and others on a spiral around the
/// contents of scenes/benchmark.json.
inline void add_edge_lights(SceneDescription& scene, int count) {
    for (ObjectDescription& object : scene.objects)
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) {
            solid->edge_lights.count = count;
            solid->edge_lights.color = glm::dvec3{0};
            solid->edge_lights.glow = glm::dvec3{1};
            solid->edge_lights.radius = 0.05;
        }
}

inline void add_visible_lights(SceneDescription& scene, int count) {
    for (int i = 0; i < count; ++i) {
        const double turn = 0.3 * double(scene.lights.size());
        LightDescription light;
        light.position = {4.5 * std::cos(turn), 4.5 * std::sin(turn), turn / 6};
        light.color = glm::dvec3{0};
        light.glow = glm::dvec3{1};
        light.radius = 0.05;
        scene.lights.push_back(light);
    }
}

}  // namespace cistula::test
