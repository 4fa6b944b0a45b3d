// Faces shared by bodies, hit at any slant: a line is refracted or reflected there once, and the next face is far away.
#pragma once

#include <algorithm>

#include "apps/render_verify/case.h"
#include "apps/render_verify/refraction/bodies.h"

namespace cistula::verify::refraction {

/// A face where several bodies begin or end.
struct SharedFace {
    std::vector<Body> bodies;
    double at;
};
inline std::vector<SharedFace> shared_faces() {
    return {{{{0, 2, 1.5}, {2, 4, 1.33}}, 2},
            {{{0, 4, 1.5}, {0, 2, 1.33}}, 0},
            {{{0, 4, 1.5}, {2, 4, 1.33}}, 4},
            {{{0, 6, 1.33}, {1, 3, 1.5}, {3, 5, 2}}, 3},
            {{{0, 3, 1.5}, {1, 3, 1.33}, {2, 3, 2}}, 3}};
}

/// Rays that start a little before the face, at its center. Numbers: the position of x = y = z = 0 and the three axes,
/// the face, the direction through it (1 or -1), the indices before and behind it, the solids before it as bits.
struct Grazing {
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        const Span<double>& numbers = setup.numbers;
        const auto at = [&](double x, double y, double z) { return placed(numbers, x, y, z); };
        const double face = numbers[12], onward = numbers[13], before = numbers[14], behind = numbers[15];
        const uint32_t solids = uint32_t(numbers[16]);
        Draw draw = setup.draw(i);
        const auto [y, z] = place_on_face(draw, 0.2);
        // A cosine between 1 and 2^-8 before the face or behind it.
        const double cosine = (0.5 + 0.5 * draw.unit<double>()) / (1 << draw.between(0, 7));
        double sine = square_root(1 - cosine * cosine);
        if (draw.one_in(2) && sine * behind < before) sine = sine * behind / before;
        const double beyond = sine * before / behind;
        if (magnitude(beyond - 1) < 0x1p-16) return;  // nearer to the critical angle cosines are less
        const double slope = square_root(1 - sine * sine), back = 0.05 + 0.1 * draw.unit<double>();
        const Vec3<double> aside = on_sphere(draw);
        const double across = sine / square_root(aside.y * aside.y + aside.z * aside.z);
        const Vec3<Real> target(at(face, y, z));
        const Vec3<Real> origin(
            at(face - back * slope * onward, y - back * across * aside.y, z - back * across * aside.z));
        Ray<Real> ray = ray_from(origin, normalized(target - origin));
        surround(ray, solids);
        Lines<Real> lines;
        trace(setup, intersector, ray, lines);
        bool good = lines.flags == 0 && lines.count >= 2 && lines.index[0] == before &&
                    lines.index[1] == (beyond > 1 ? before : behind);
        // The middle of a face is at least 0.5 away from what else there is.
        good = good && apart(setup, lines.origin[1], target) < 0.01;
        if (good && lines.count > 2) good = apart(setup, lines.origin[2], lines.origin[1]) > 0.1;
        tally.witness(beyond > 1);
        tally.expect(good);
    }

    /// Adds the parts; `changed`: bodies are moved by an ulp or not at all.
    template <class Functor>
    static void plan_faces(Plan& plan, bool changed) {
        uint64_t number = 0;
        for (const Form form : {Form::cubes, Form::wide_boxes, Form::both})
            for (const SharedFace& shared : shared_faces()) {
                std::vector<Body> bodies = shared.bodies;
                std::sort(bodies.begin(), bodies.end());
                do {
                    for (const glm::dvec3& turn : {glm::dvec3(0), glm::dvec3(20, 35, 50)})
                        for (const double onward : {1.0, -1.0}) {
                            double index[2] = {1, 1};
                            uint32_t around[2] = {0, 0};
                            for (uint32_t k = 0; k < bodies.size(); ++k)
                                for (int side = 0; side < 2; ++side) {
                                    const double x = shared.at + (side == 0 ? -0.5 : 0.5) * onward;
                                    if (!(bodies[k].begin < x && x < bodies[k].end)) continue;
                                    index[side] = bodies[k].index, around[side] |= 1u << k;
                                }
                            if (index[0] == index[1]) continue;  // a body of higher priority around it
                            Part& part = plan.add(label(form, onward > 0 ? "onward" : "back", bodies, turn),
                                                  scene_of(bodies, form, turn), Functor(), {}, plan.rays(4000, 50));
                            part.frame_numbers = [=, at = shared.at, before = index[0], behind = index[1],
                                                  solids = around[0]](const glm::dvec3& center, double factor,
                                                                      std::vector<double>& numbers) {
                                place_numbers(turn, center, factor, numbers);
                                numbers.insert(numbers.end(), {at, onward, before, behind, double(solids)});
                            };
                            if (changed)
                                part.edit([seed = number++, scene = part.scene](auto& compiled) {
                                    move_bodies(compiled, scene, seed);
                                });
                        }
                } while (std::next_permutation(bodies.begin(), bodies.end()));
            }
    }

  private:
    /// Distance of two points in scene units.
    template <class Real>
    CISTULA_HD static double apart(const Setup<Real>& setup, const Vec3<Real>& a, const Vec3<Real>& b) {
        return length(Vec3<double>(a) - Vec3<double>(b)) / setup.factor;
    }
};

struct GrazingShared : Grazing {
    static constexpr const char* name = "refraction/media/grazing";
    static constexpr const char* exact = "at any slant down to 1/256 a shared face bends a line once, or mirrors it";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_faces<GrazingShared>(plan, false); }
};
struct GrazingMoved : Grazing {
    static constexpr const char* name = "refraction/media/within-rounding/grazing";
    static constexpr const char* exact = "the same where shared faces are ulps apart, or one in the other";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool needs_witness = true;
    static void plan(Plan& plan) { plan_faces<GrazingMoved>(plan, true); }
};

}  // namespace cistula::verify::refraction
