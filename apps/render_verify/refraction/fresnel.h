// Refracted direction and Fresnel reflectance at angles where their formulas lose digits, compared with 113-bit
// results.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/crossings.h"
#include "apps/render_verify/refraction/quad.h"
#include "apps/render_verify/scenes.h"
#include "cistula/shading/interface.h"

namespace cistula::verify::refraction {

/// A random pair of indices at least 2^-10 apart, in either order.
inline IndexPair drawn_pair(Draw& draw) {
    IndexPair pair{1 + 1.5 * draw.unit<double>(), 1};
    const int kind = draw.between(0, 3);
    if (kind == 0) pair.from = 1;
    pair.to = pair.from * (kind == 1 ? 1 + draw.unit<double>() * 0x1p-6 + 0x1p-10 : 1.0625 + 1.5 * draw.unit<double>());
    const bool swap = draw.one_in(2);
    return swap ? IndexPair{pair.to, pair.from} : pair;
}

/// Adds a part of rays whose records `make` appends.
template <class Functor, class Make>
void plan_records(Plan& plan, uint64_t seed, uint64_t full, uint64_t quick, const Make& make) {
    Part& part = plan.add("records", empty_scene(), Functor(), {}, plan.rays(full, quick));
    for (uint64_t i = 0; i < part.count; ++i) {
        Draw draw(i, seed);
        make(draw, part.numbers);
    }
}

/// Bound in ulps for results computed one precision up and rounded once. For float that is double: n - 1 has a relative
/// error of 2^-53 / |n - 1| <= 2^-43, which the square doubles; g^2, at least 2^-14 here, one of 2^-39 at most; every
/// further step adds about 2^-52. Beside the half ulp of the last rounding all of these are below 2^-13 of an ulp, and
/// less in double; the bound allows 2^-10.
inline constexpr double rounded_once = 0.5 + 0x1p-10;

struct FresnelNormal {
    static constexpr const char* name = "refraction/fresnel/normal-incidence";
    static constexpr const char* exact = "((n - 1)/(n + 1))^2, rounded once; the direction unchanged";
    static constexpr Bound bound = at_most(rounded_once, "ulps");
    static constexpr bool own_traversal = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Refraction<Real> found = refracted(record.direction(), record.normal(), record.from(), record.to());
        tally.expect(!found.total && found.direction == record.direction());
        tally.measure(record.reflectance_off(found.reflectance));
    }
    static void plan(Plan& plan) {
        plan_records<FresnelNormal>(plan, 1, 100000, 4000, [](Draw& draw, std::vector<double>& numbers) {
            const IndexPair index = drawn_pair(draw);
            const Vec3<double> normal = axis_normal(draw);
            const size_t first = numbers.size();
            add_records(-normal, normal, index.from, index.to, numbers);
            // The closed form instead of the general one.
            const Quad n = Quad(index.to) / Quad(index.from), amplitude = (n - 1) / (n + 1),
                       share = amplitude * amplitude;
            for (const size_t at : {first + record_reflectance, first + record_size + record_reflectance}) {
                numbers[at] = double(share);
                numbers[at + 1] = double(share - Quad(double(share)));
            }
        });
    }
};

struct FresnelGrazing {
    static constexpr const char* name = "refraction/fresnel/grazing";
    static constexpr const char* exact = "all is reflected at cosine 0; the share and its rounding from 2^-60 up";
    static constexpr Bound bound = at_most(rounded_once, "ulps");
    static constexpr bool own_traversal = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Vec3<Real> normal = record.normal(), direction = record.direction();
        const Refraction<Real> found = refracted(direction, normal, record.from(), record.to());
        tally.expect(found.total == record.total());
        tally.measure(record.reflectance_off(found.reflectance));
        // A cosine that rounding made negative counts as 0.
        for (const Real cosine : {Real(0), -RealTraits<Real>::unit}) {
            Vec3<Real> along_face = direction;
            for (int k = 0; k < 3; ++k)
                if (normal[k] != Real(0)) along_face[k] = -cosine * normal[k];
            const Refraction<Real> flat = refracted(along_face, normal, record.from(), record.to());
            tally.expect(flat.total == (record.from() > record.to()) && flat.reflectance == Real(1));
        }
    }
    static void plan(Plan& plan) {
        plan_records<FresnelGrazing>(plan, 2, 100000, 4000, [](Draw& draw, std::vector<double>& numbers) {
            const IndexPair index = drawn_pair(draw);
            const Vec3<double> normal = axis_normal(draw);
            const double cosine = magnitude(draw.scaled<double>(-60, -1));
            add_records(incoming(normal, cosine, std::sqrt((1 - cosine) * (1 + cosine)), draw), normal, index.from,
                        index.to, numbers);
        });
    }
};

/// Equal indices: nothing is reflected or refracted, g = c and D = 0 to the last bit.
struct FresnelEqual {
    static constexpr const char* name = "refraction/fresnel/equal-indices";
    static constexpr const char* exact = "no reflection, no bend, at any angle";
    static constexpr Bound bound = no_failures("rays");
    static constexpr bool own_traversal = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const Vec3<Real> normal(on_sphere(draw));
        const Vec3<double> tangent = normalized(cross(Vec3<double>(normal), on_sphere(draw)));
        const double cosine = magnitude(draw.scaled<double>(-20, -1));
        const Vec3<Real> direction(square_root(1 - cosine * cosine) * tangent - cosine * Vec3<double>(normal));
        const double index = 1 + draw.below(1024) * 0x1p-8;
        const Refraction<Real> found = refracted(direction, normal, index, index);
        // A material that is not clear needs no refraction.
        Material<Real> material = Material<Real>();
        material.reflection = Real(0.25);
        material.transmission = Real(0.5);
        material.tint = Vec3<Real>(Real(1), Real(0.5), Real(0));
        material.fresnel = 1;
        material.transparency = Transparency::partial;
        const InterfaceSplit<Real> split = split_at<Real, Effects<all_effects>>(
            setup.scene, material, direction, normal, InteriorList(), InteriorList(), false);
        tally.expect(!found.total && found.reflectance == Real(0) && found.direction == renormalized(direction) &&
                     !split.bends && split.through == direction && split.reflection == Real(0) &&
                     split.filter == material.tint * Real(0.75));
    }
    static void plan(Plan& plan) {
        plan.add("any angle", empty_scene(), FresnelEqual(), {}, plan.rays(1000000, 10000));
    }
};

/// At any other angle. The direction's components are rounded once, then multiplied by one factor, u each: 2 u across
/// it. The factor sets the length: the square's three roundings reach it halved, 1.5 u, and its own is another u. 2 u
/// + 2.5 u in all.
struct AnyAngle {
    static constexpr const char* name = "refraction/fresnel/any-angle";
    static constexpr const char* exact = "Fresnel's share, rounded once; Snell's direction within 4.5 u";
    static constexpr Bound bound = at_most(rounded_once, "ulps");
    static constexpr bool own_traversal = true;

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        const Record<Real> record(setup, i);
        const Refraction<Real> found = refracted(record.direction(), record.normal(), record.from(), record.to());
        tally.expect(found.total == record.total());
        if (found.total || record.total()) return;
        tally.measure(record.reflectance_off(found.reflectance));
        tally.expect(record.through_off(found.direction) <= 4.5);
    }
    static void plan(Plan& plan) {
        plan_records<AnyAngle>(plan, 3, 200000, 8000, [](Draw& draw, std::vector<double>& numbers) {
            const IndexPair index = drawn_pair(draw);
            const Vec3<double> normal = on_sphere(draw);
            const double n = index.to / index.from, critical = n < 1 ? std::sqrt((1 - n) * (1 + n)) : 0;
            const double cosine = critical + (1 - critical) * (0x1p-10 + (1 - 0x1p-10) * draw.unit<double>());
            add_records(incoming(normal, cosine, std::sqrt((1 - cosine) * (1 + cosine)), draw), normal, index.from,
                        index.to, numbers);
        });
    }
};

}  // namespace cistula::verify::refraction
