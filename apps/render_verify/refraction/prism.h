// A prism deviates light least when the path is symmetric.
#pragma once

#include "apps/render_verify/refraction/lines.h"
#include "apps/render_verify/refraction/quad.h"
#include "apps/render_verify/scenes.h"

namespace cistula::verify::refraction {

/// Two faces of a solid at one of its edges, and an index for which light passes symmetrically.
struct Prism {
    PlatonicSolid solid;
    double index;
};
inline constexpr Prism prisms[] = {{PlatonicSolid::tetrahedron, 1.5},
                                   {PlatonicSolid::cube, 1.3},
                                   {PlatonicSolid::octahedron, 1.15},
                                   {PlatonicSolid::dodecahedron, 1.1},
                                   {PlatonicSolid::icosahedron, 1.04}};

/// In u, of the cosine of the deviation. Rounded normals change the angle between the faces by 2 u and the least
/// deviation by n cos(A/2)/c - 1 <= 1.5 of that: 3. Inside the direction is off by 2 u across, and at the exit by g/c
/// <= 2.5 of it, 5; for its length, 3 u, by s D/(n^2 c) <= 1.2 of that, 3.5; that of the ray inside, 2.5 u, by s D/c
/// <= 2.2, 5.5; its own rounding 2: 19 u of angle, by the sine of the deviation, at most 0.77: 15. Lengths of the
/// two, 5.5 u, by its cosine, at most 0.8: 4.5. The reference and the measured product, in double: 4. In all 23.5.
struct PrismDeviation {
    static constexpr const char* name = "refraction/prism/minimum-deviation";
    static constexpr const char* exact = "2 asin(n sin(A/2)) - A on the symmetric way, and no less beside it";
    static constexpr Bound bound = at_most(23.5, "u");
    static constexpr bool needs_witness = true;

    /// Numbers: unit directions in, out and along the edge; the point of entry of the symmetric path; the cosine of the
    /// deviation; a length.
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        const auto vector = [&](uint32_t at) {
            return Vec3<double>(setup.numbers[at], setup.numbers[at + 1], setup.numbers[at + 2]);
        };
        const Vec3<double> in = vector(0), out = vector(3), edge = vector(6), entry = vector(9);
        const double least_cosine = setup.numbers[12], reach = setup.numbers[13];
        Draw draw = setup.draw(i);
        const bool symmetric = draw.one_in(2);
        const double turn = symmetric ? 0.0 : draw.sign() * magnitude(draw.scaled<double>(-24, -7));
        const double sideways = draw.centered<double>(0.25 * reach);
        const Vec3<Real> way(normalized(in + turn * cross(edge, in)));
        const Vec3<double> from = entry + sideways * edge - Vec3<double>(way) * (0.5 * reach);
        Lines<Real> lines;
        trace(setup, intersector, ray_from(Vec3<Real>(from), way), lines);
        tally.expect(lines.whole() && lines.count == 3);
        if (lines.count != 3) return;
        const Vec3<double> left(lines.direction[2]), came(way);
        const double unit = double(RealTraits<Real>::unit), cosine = dot(left, came);
        tally.expect(dot(left, out) > 0.99);
        tally.measure(max_or_second(cosine - least_cosine, 0.0) / unit);
        if (symmetric) tally.measure(magnitude(cosine - least_cosine) / unit);
        tally.witness(turn != 0 && cosine < least_cosine);
    }

    static void plan(Plan& plan) {
        for (const Prism& prism : prisms)
            for (const glm::dvec3& turn : {glm::dvec3(0), glm::dvec3(31, 47, 11)}) {
                SceneDescription scene = empty_scene();
                const SolidObject solid = solid_object(prism.solid, {}, 1, turn);
                add_solid(scene, Shape::planes, solid, add_material(scene, glass(prism.index)));
                Part& part = plan.add(platonic_name(prism.solid), scene, PrismDeviation(), {}, plan.rays(200000, 2000));
                part.frame_numbers = [solid, prism](const glm::dvec3& center, double factor,
                                                    std::vector<double>& numbers) {
                    find(solid, prism.index, center, factor, numbers);
                };
            }
    }

  private:
    static void find(const SolidObject& solid, double index, const glm::dvec3& center, double factor,
                     std::vector<double>& numbers) {
        const PlatonicShape& shape = platonic_shape(solid.solid);
        const Rotation rotation(solid.rotation);
        const auto& edge = shape.edges[0];
        const auto normal_of = [&](uint32_t id) {
            for (const auto& face : shape.faces)
                if (face.id == id) return rotation(face.normal);
            return glm::dvec3(0);
        };
        const glm::dvec3 first = normal_of(edge.faces[0]), second = normal_of(edge.faces[1]);
        const glm::dvec3 a = rotation(shape.vertices[edge.vertices[0]]), b = rotation(shape.vertices[edge.vertices[1]]);
        // The angle between the normals is 180 degrees less A: half of it has the cosine sin(A/2).
        Quad product = 0;
        for (int k = 0; k < 3; ++k) product += Quad(first[k]) * Quad(second[k]);
        const Quad half_sine = root((1 + product) / 2), half_cosine = root((1 - product) / 2);
        // Snell at the face: sin of incidence n sin(A/2); the deviation is twice that angle less A.
        const Quad s = Quad(index) * half_sine, c = root((1 - s) * (1 + s));
        const Quad half_turn_cosine = c * half_cosine + s * half_sine;
        const Quad cosine = 2 * half_turn_cosine * half_turn_cosine - 1;
        const glm::dvec3 within = normalized(second - first);  // across the plane that halves the prism
        const glm::dvec3 along_first = normalized(within - dot(within, first) * first);
        const glm::dvec3 along_second = normalized(within - dot(within, second) * second);
        const glm::dvec3 in =
            normalized(along_first * (index * length(within - dot(within, first) * first)) - double(c) * first);
        const glm::dvec3 out =
            normalized(along_second * (index * length(within - dot(within, second) * second)) + double(c) * second);
        // The symmetric path, a little inside the middle of the edge, back to the first face.
        const glm::dvec3 inward = -normalized(first + second);
        const double apothem = length(a - b) * 0.125;
        const glm::dvec3 through = 0.5 * (a + b) + inward * apothem;
        const double back = (shape.inradius - dot(first, through)) / dot(first, within);
        const glm::dvec3 entry = ((through + back * within) * solid.radius + solid.center - center) * factor;
        const glm::dvec3 along = normalized(b - a);
        for (const glm::dvec3& v : {in, out, along, entry}) numbers.insert(numbers.end(), {v.x, v.y, v.z});
        numbers.insert(numbers.end(), {double(cosine), length(b - a) * solid.radius * factor});
    }
};

}  // namespace cistula::verify::refraction
