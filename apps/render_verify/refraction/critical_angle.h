// Total or not: decided as the exact value of g^2 = (n - 1)(n + 1) + c^2 of the rounded direction and normal says, in
// steps of 2^-22 of the sine over the critical angle; in double, of 2^-54 too. Zero is total.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/refraction/lines.h"
#include "apps/render_verify/refraction/quad.h"
#include "apps/render_verify/scenes.h"

namespace cistula::verify::refraction {

inline constexpr IndexPair critical_pairs[] = {{1.5, 1}, {1.5, 1.33}, {1.33, 1}, {2, 1}, {2.417, 1.5}};

/// Appends records at the critical sine times 1 + k step for |k| in [1, most], about normals along axes and others.
inline void sweep_records(const IndexPair& index, double step, int most, bool axes, uint64_t seed,
                          std::vector<double>& numbers) {
    for (int k = -most; k <= most; ++k) {
        if (k == 0) continue;
        Draw draw(uint64_t(k + most), seed);
        const Quad sine = Quad(index.to) / Quad(index.from) * (1 + Quad(k) * Quad(step));
        const Quad cosine = root((1 - sine) * (1 + sine));
        const Vec3<double> normal = axes ? axis_normal(draw) : on_sphere(draw);
        const Vec3<double> direction = incoming(normal, double(cosine), double(sine), draw);
        const Quad g2 = add_records(direction, normal, index.from, index.to, numbers);
        // Along an axis the cosine is rounded once, so that the order of steps must show: the reference itself is
        // right.
        if (axes && step >= 0x1p-22 && (g2 > 0) == (k > 0)) throw std::runtime_error("the reference decides wrongly");
    }
}

struct CriticalAngle {
    static constexpr const char* name = "refraction/critical-angle";
    static constexpr const char* exact = "total reflection where 113 bits say so, in steps of 2^-22 and 2^-54";
    static constexpr Bound bound = no_failures("decisions");
    static constexpr bool own_traversal = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Refraction<Real> found = refracted(record.direction(), record.normal(), record.from(), record.to());
        tally.expect(found.total == record.total() && (!found.total || found.reflectance == Real(1)));
    }

    static void plan(Plan& plan) {
        const int most = int(plan.rays(20000, 400));
        for (const IndexPair& index : critical_pairs)
            for (const double step : {0x1p-22, 0x1p-54})
                for (const bool axes : {true, false}) {
                    std::vector<double> numbers;
                    sweep_records(index, step, most, axes, uint64_t(index.from * 1e6 + axes), numbers);
                    Part& part = plan.add(std::to_string(index.from) + " to " + std::to_string(index.to) +
                                              (step == 0x1p-22 ? ", steps of 2^-22" : ", steps of 2^-54"),
                                          empty_scene(), CriticalAngle(), {}, uint64_t(2 * most));
                    part.numbers = std::move(numbers);
                }
    }
};

/// Total reflection in the ray tree: from inside a cube in a larger one, with faces perpendicular to the axes and exact
/// normals.
struct CriticalAngleTraced {
    static constexpr const char* name = "refraction/critical-angle/traced";
    static constexpr const char* exact = "the ray tree mirrors or bends as 113 bits say, in steps of 2^-22";
    static constexpr Bound bound = no_failures("rays");

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        const Record<Real> record(setup, i);
        Draw draw = setup.draw(i);
        // From close to the face that lies against the normal, about its middle.
        const double inner = 0.5 * setup.factor, gap = draw.unit<double>() * 0.125 + 0.0625;
        const Vec3<double> beside = draw.in_cube<double>(0.25);
        Vec3<Real> origin;
        for (int k = 0; k < 3; ++k)
            origin[k] =
                Real(inner * (record.normal()[k] == Real(0) ? beside[k] : -double(record.normal()[k]) * (1 - gap)));
        const Ray<Real> ray = inside(inside(ray_from(origin, record.direction()), 0), 1);
        Lines<Real> lines;
        trace(setup, intersector, ray, lines);
        tally.expect(lines.flags == 0 && lines.count >= 2 && lines.index[0] == record.from() &&
                     lines.index[1] == (record.total() ? record.from() : record.to()));
        tally.witness(record.total());
    }
    static constexpr bool needs_witness = true;

    static void plan(Plan& plan) {
        const int most = int(plan.rays(20000, 200));
        for (const IndexPair& index : critical_pairs)
            for (const Shape shape : {Shape::planes, Shape::triangles}) {
                SceneDescription scene = empty_scene();
                const double radius = std::sqrt(3.0);  // half diagonal of a cube of side 2
                add_solid(scene, shape, solid_object(PlatonicSolid::cube, {}, radius),
                          add_material(scene, glass(index.to)));
                add_solid(scene, shape, solid_object(PlatonicSolid::cube, {}, radius / 2),
                          add_material(scene, glass(index.from)));
                Part& part = plan.add(std::to_string(index.from) + " to " + std::to_string(index.to), scene,
                                      CriticalAngleTraced(), {}, uint64_t(2 * most));
                sweep_records(index, 0x1p-22, most, true, uint64_t(index.to * 1e6), part.numbers);
            }
    }
};

}  // namespace cistula::verify::refraction
