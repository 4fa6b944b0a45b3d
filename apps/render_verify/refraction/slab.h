// A ray through two parallel faces leaves in its original direction, displaced by h s (1 - c / g): thickness h, sine
// and cosine of incidence s and c, g = sqrt(n^2 - s^2).
#pragma once

#include "apps/render_verify/refraction/lines.h"
#include "apps/render_verify/refraction/reversibility.h"
#include "apps/render_verify/scenes.h"

namespace cistula::verify::refraction {

inline constexpr double slab_indices[] = {1.0625, 1.33, 1.5, 2.5};

/// Adds parts with cubes of side 2. Points: the centers of the faces, then the center. Numbers: the index, half of the
/// side.
template <class Functor>
void plan_slabs(Plan& plan, const std::vector<Shape>& shapes, const std::vector<glm::dvec3>& rotations) {
    for (const double index : slab_indices)
        for (const Shape shape : shapes)
            for (const glm::dvec3& turn : rotations) {
                SceneDescription scene = empty_scene();
                const glm::dvec3 center(3, -7, 5);
                add_solid(scene, shape, solid_object(PlatonicSolid::cube, center, std::sqrt(3.0), turn),
                          add_material(scene, glass(index)));
                std::vector<glm::dvec3> points;
                for (const auto& face : platonic_shape(PlatonicSolid::cube).faces)
                    points.push_back(center + Rotation(turn)(face.normal));
                points.push_back(center);
                Part& part =
                    plan.add("index " + std::to_string(index), scene, Functor(), points, plan.rays(200000, 2000));
                part.frame_numbers = [index](const glm::dvec3&, double factor, std::vector<double>& numbers) {
                    numbers = {index, factor};
                };
            }
}

/// A ray from outside through a face, and where it leaves.
template <class Real>
struct SlabRay {
    Lines<Real> lines;
    Vec3<double> normal, to;  // outward at the face of entry; direction after the cube
    bool through;             // entered one face and left by the opposite one
};
template <class Real, class Intersector>
CISTULA_HD inline void pass_slab(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                                 SlabRay<Real>& ray) {
    Draw draw = setup.draw(i);
    const uint32_t face = draw.below(6);
    const Vec3<double> middle = setup.points[6];
    ray.normal = normalized(setup.points[face] - middle);
    // Aimed at a place near the middle of the face, at a sine of 15/16 at most.
    Vec3<double> tangent = in_ball(draw) * 0.9375;
    tangent -= dot(tangent, ray.normal) * ray.normal;
    const Vec3<double> way = tangent - square_root(1 - dot(tangent, tangent)) * ray.normal;
    const Vec3<double> target = setup.points[face] - tangent * (setup.numbers[1] * 0.5);
    ray.to = Vec3<double>(Vec3<Real>(way));
    trace(setup, intersector, ray_from(Vec3<Real>(target - way * (setup.numbers[1] * 0.5)), Vec3<Real>(way)),
          ray.lines);
    const Lines<Real>& lines = ray.lines;
    ray.through = lines.whole() && lines.count == 3 && lines.first[1].found() &&
                  magnitude(dot(normal_at(setup.scene, lines.first[1]), Vec3<Real>(ray.normal))) > Real(0.5);
}

/// The direction after a slab equals that before. Both faces have the same normal, bit for bit, so this is
/// reversibility once more, with n < 1 on the way out and the same bound.
struct SlabParallel {
    static constexpr const char* name = "refraction/slab/parallel";
    static constexpr const char* exact = "the ray leaves as it came";
    static constexpr Bound bound = at_most(4.5, "u x condition");
    static constexpr bool needs_witness = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        SlabRay<Real> ray;
        pass_slab(setup, intersector, i, ray);
        tally.expect(ray.lines.flags == 0 && ray.lines.count >= 3);
        if (!ray.through) return;  // left by a side
        tally.witness(true);
        const Condition condition = condition_of(ray.to, ray.normal, 1, setup.numbers[0]);
        const Vec3<double> off = Vec3<double>(ray.lines.direction[2]) - ray.to;
        tally.measure(length(off) / (double(RealTraits<Real>::unit) * condition.value));
    }
    static void plan(Plan& plan) {
        plan_slabs<SlabParallel>(plan, {Shape::planes}, {{0, 0, 0}, {20, 35, 50}});
        // A mesh's normals come from its corners; both faces have the same one only if perpendicular to an axis.
        plan_slabs<SlabParallel>(plan, {Shape::triangles}, {{0, 0, 0}});
    }
};

/// In u M. A point on a ray is rounded in three coordinates: sqrt(3). Its distance from the plane is that of t, a
/// difference of two numbers below sqrt(3) M with four roundings in all, 7; it moves the exit by no more than itself,
/// and there are two planes: 14. The two points: 3.5. The direction within, 2 u across (any-angle) over a way of at
/// most 2 sqrt(3) M: 7. That of the first line in the reference, s and c in double for double: 4. The plane's normal
/// and offset, rounded: 2 sqrt(3) u M each, 7. In all 36.
struct SlabDisplacement {
    static constexpr const char* name = "refraction/slab/displacement";
    static constexpr const char* exact = "moved aside by h s (1 - c/g)";
    static constexpr Bound bound = at_most(36, "u M");
    static constexpr bool needs_witness = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        SlabRay<Real> ray;
        pass_slab(setup, intersector, i, ray);
        tally.expect(ray.lines.flags == 0 && ray.lines.count >= 3);
        if (!ray.through) return;
        tally.witness(true);
        const double n = setup.numbers[0], c = -dot(ray.to, ray.normal), thickness = 2 * setup.numbers[1];
        const Vec3<double> tangent = ray.to + c * ray.normal;
        const double g = square_root((n - 1) * (n + 1) + c * c), expected = thickness * length(tangent) * (1 - c / g);
        const Vec3<double> way = Vec3<double>(ray.lines.origin[2]) - Vec3<double>(ray.lines.origin[0]);
        const Vec3<double> aside = cross(way, ray.to);
        tally.measure(magnitude(length(aside) - expected) / double(RealTraits<Real>::unit * setup.extent()));
    }
    static void plan(Plan& plan) { plan_slabs<SlabDisplacement>(plan, {Shape::planes}, {{0, 0, 0}, {20, 35, 50}}); }
};

}  // namespace cistula::verify::refraction
