// Lights on faces, edges and corners: half-spaces decide, no comparison of nearly equal distances.
#pragma once

#include "apps/render_verify/shadows/local_light.h"

namespace cistula::verify::shadows {

inline constexpr int glass_halvings = 2;

/// A light on a corner, an edge or a face of a solid, with the faces on which it lies as bits, by construction.
struct OnSolid {
    glm::dvec3 place;  // for the solid at the origin with radius 1, not rotated
    uint32_t faces;
};

inline std::vector<OnSolid> places_on(const PlatonicShape& shape) {
    const auto faces_of = [&](uint32_t vertex) {
        uint32_t bits = 0;
        for (uint32_t f = 0; f < shape.faces.size(); ++f)
            for (const uint32_t v : shape.faces[f].vertices) bits |= uint32_t(v == vertex) << f;
        return bits;
    };
    std::vector<OnSolid> places;
    for (uint32_t v = 0; v < shape.vertices.size(); v += 3) places.push_back({shape.vertices[v], faces_of(v)});
    for (uint32_t e = 0; e < shape.edges.size(); e += 3) {
        const auto& edge = shape.edges[e];
        const double s = (e % 15 + 1) / 16.0;
        const glm::dvec3 &a = shape.vertices[edge.vertices[0]], &b = shape.vertices[edge.vertices[1]];
        places.push_back({a + s * (b - a), faces_of(edge.vertices[0]) & faces_of(edge.vertices[1])});
    }
    for (uint32_t f = 0; f < shape.faces.size(); f += 3)
        places.push_back({shape.faces[f].normal * shape.inradius + 0.25 * (shape.vertices[shape.faces[f].vertices[1]] -
                                                                           shape.faces[f].normal * shape.inradius),
                          uint32_t(1) << f});
    return places;
}

/// Shadow rays from random points. Numbers: for each light and solid the faces on which the light lies; then the planes
/// of each solid.
struct HalfSpaces {
    uint32_t solids, faces, lights;
    bool glass;

    CISTULA_HD double height(const Span<double>& numbers, uint32_t s, uint32_t f, const Vec3<double>& p) const {
        const uint32_t k = lights * solids + 4 * (s * faces + f);
        return dot(Vec3<double>(numbers[k], numbers[k + 1], numbers[k + 2]), p) - numbers[k + 3];
    }

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent()), unit = double(RealTraits<Real>::unit);
        const uint32_t light = draw.below(lights);
        const Vec3<double> at(setup.scene.lights[light].position);
        const Vec3<double> somewhere = in_ball(draw) * (1.9 * extent);
        const double nearer = draw.one_in(2) ? 1 : parity::two_to<double>(-draw.between(0, 10));
        const Vec3<Real> origin(at + (somewhere - at) * nearer);
        // A point this close to a plane is on neither side for sure: normal, dot product, distance and the corners of
        // triangles round by 11 u M together, and a face's plane by ten times its corners' u M at the scene's far end.
        const double doubt = 64 * unit * extent;
        ShadowRay<Real> shadow = shadow_ray(setup, origin, light);
        int crossed = 0;
        for (uint32_t s = 0; s < solids; ++s) {
            const uint32_t incident = uint32_t(setup.numbers[light * solids + s]);
            double over_incident = -1e300, over = -1e300;
            for (uint32_t f = 0; f < faces; ++f) {
                const double h = height(setup.numbers, s, f, Vec3<double>(origin));
                over = max_or_second(over, h);
                if (incident >> f & 1u) over_incident = max_or_second(over_incident, h);
            }
            if (magnitude(over_incident) <= doubt || magnitude(over) <= doubt) return;
            if (over_incident > 0) continue;
            if (over < 0)
                shadow.ray.media.add(s, 1);
            else
                ++crossed;
        }
        const Vec3<Real> found = intersector.template transmittance<All>(shadow);
        const Real expected = crossed == 0 ? Real(1)
                              : glass      ? parity::two_to<Real>(-glass_halvings * crossed)
                                           : Real(0);
        tally.witness(crossed != 0);
        tally.expect(found == Vec3<Real>(expected));
    }
};

/// Appends the numbers that HalfSpaces needs to a part.
inline void add_half_spaces(Part& part, const std::vector<SolidObject>& solids,
                            const std::vector<std::vector<OnSolid>>& on) {
    part.frame_numbers = [solids, on](const glm::dvec3& center, double factor, std::vector<double>& numbers) {
        for (size_t k = 0; k < on[0].size(); ++k)
            for (size_t s = 0; s < solids.size(); ++s) numbers.push_back(on[s][k].faces);
        for (const SolidObject& solid : solids) add_planes(solid, center, factor, numbers);
    };
}

inline MaterialDescription glass_or_opaque(const SceneDescription& scene, bool glass) {
    MaterialDescription material = scene.materials[0];
    material.transmission = glass ? std::ldexp(1.0, -glass_halvings) : 0;
    return material;
}

template <class Functor>
void plan_lights_on(Plan& plan, Shape shape) {
    const uint64_t rays = plan.rays(300'000, 1000);
    for (const PlatonicSolid kind : platonic_solids)
        for (const bool glass : {false, true})
            for (const glm::dvec3& rotation : {glm::dvec3(0), glm::dvec3(31, 47, 11)})
                for (const Placement& placement : placements()) {
                    // A light given by scene units lies on a plane to within their rounding; where that is more than
                    // the frame's, only a solid's own edge lights are sure to.
                    if (placement.center != glm::dvec3(0)) continue;
                    PlacedSolid placed = placed_solid(kind, shape, placement, rotation);
                    placed.scene.materials[0] = glass_or_opaque(placed.scene, glass);
                    const std::vector<OnSolid> on = places_on(platonic_shape(kind));
                    const Rotation turned(rotation);
                    for (const OnSolid& light : on)
                        add_light(placed.scene, placed.solid.center + turned(placed.solid.radius * light.place));
                    Part& part =
                        plan.add(placed.label + (glass ? ", glass" : ", opaque"), placed.scene,
                                 Functor{{1, uint32_t(platonic_shape(kind).faces.size()), uint32_t(on.size()), glass}},
                                 {}, rays);
                    add_half_spaces(part, {placed.solid}, {on});
                }
}

struct LightsOnPlanes : HalfSpaces {
    static constexpr const char* name = "shadows/lights-on-solids/planes";
    static constexpr const char* exact = "lights on corners, edges, faces of a solid: verdicts by half-spaces";
    static constexpr Bound bound = no_failures("shadow rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) {
        plan_lights_on<LightsOnPlanes>(plan, Shape::planes);
        // Edge lights of solids far from the origin of their scene units, at 1e6 and 1e-6.
        for (const PlatonicSolid kind : platonic_solids)
            for (const bool glass : {false, true})
                for (const Placement& placement : {placements()[1], placements()[2]}) {
                    PlacedSolid placed = placed_solid(kind, Shape::planes, placement, {31, 47, 11});
                    SceneDescription scene = empty_scene();
                    scene.materials[0] = glass_or_opaque(scene, glass);
                    placed.solid.edge_lights.count = 3;
                    add_solid(scene, Shape::planes, placed.solid);
                    const PlatonicShape& shape = platonic_shape(kind);
                    std::vector<OnSolid> on;
                    for (const auto& edge : shape.edges)
                        for (int k = 0; k < 3; ++k) {
                            OnSolid light{};
                            for (uint32_t f = 0; f < shape.faces.size(); ++f)
                                light.faces |=
                                    uint32_t(shape.faces[f].id == edge.faces[0] || shape.faces[f].id == edge.faces[1])
                                    << f;
                            on.push_back(light);
                        }
                    Part& part = plan.add(placed.label + ", edge lights", scene,
                                          LightsOnPlanes{{1, uint32_t(shape.faces.size()), uint32_t(on.size()), glass}},
                                          {}, plan.rays(300'000, 1000));
                    add_half_spaces(part, {placed.solid}, {on});
                }
    }
};

struct LightsOnTriangles : HalfSpaces {
    static constexpr const char* name = "shadows/lights-on-solids/triangles";
    static constexpr const char* exact = "lights on corners, edges, faces of a mesh: verdicts by half-spaces";
    static constexpr Bound bound = no_failures("shadow rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_lights_on<LightsOnTriangles>(plan, Shape::triangles); }
};

}  // namespace cistula::verify::shadows
