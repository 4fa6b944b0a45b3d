// Textures at the borders of cells, and far from their origin.
#pragma once

#include "apps/render_verify/crossings.h"
#include "apps/render_verify/scenes.h"
#include "cistula/shading/surface.h"

namespace cistula::verify::metamorphic {

/// i modulo n, for integers.
CISTULA_HD inline uint32_t modulo(int64_t i, int64_t n) {
    const int64_t r = i % n;
    return uint32_t(r < 0 ? r + n : r);
}
/// The floor of x, for |x| up to 2^53.
CISTULA_HD inline int64_t whole_below(double x) {
    return int64_t(floor_of(x));
}

struct Texels {
    Span<Vec3<float>> texels;
};

/// Cells of a checkerboard, exact: they and the repeats are powers of two, so that no product is rounded.
struct CellBorders {
    static constexpr const char* name = "metamorphic/floor-texture/cell-borders";
    static constexpr const char* exact = "the cell on the right side of borders up to 1e9 cells out, and an ulp beside";
    static constexpr Bound bound = no_failures("look-ups");
    static constexpr bool own_traversal = true;

    static void plan(Plan& plan) {
        SceneDescription scene = empty_scene();
        add_object(scene, solid_object(PlatonicSolid::cube));
        plan.add("checkers", scene, CellBorders{}, {}, plan.rays(20'000'000, 300'000));
    }
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const int log_width = draw.between(0, 2), log_repeat = draw.between(-3, 3);
        Vec3<float> texels[16];
        for (int t = 0; t < 16; ++t) texels[t] = Vec3<float>(float(t));
        Texture texture{};
        texture.width = texture.height = 1u << log_width;
        texture.filter = TextureFilter::nearest;
        texture.repeat[0] = texture.repeat[1] = elementary::power_of_two(log_repeat);
        const Texels scene{{texels, 16}};
        const double factor = elementary::power_of_two(log_width + log_repeat);
        Vec2<Real> uv;
        int64_t cell[2];
        for (int axis = 0; axis < 2; ++axis) {
            const int bits = draw.between(0, 30);  // to 1.07e9 cells out
            const int64_t border = int64_t(draw.bits() >> (63 - bits)) - (int64_t(1) << bits);
            const Real at = Real(double(border) / factor);
            const Real least = RealTraits<Real>::least_normal;  // numbers by bits end at 0
            const Real beside = at == Real(0) ? (draw.one_in(2) ? least : -least) : draw.near(at, 1);
            uv[axis] = draw.one_in(4) ? at : beside;
            if (draw.one_in(8)) uv[axis] += draw.unit<Real>();
            cell[axis] = whole_below(double(uv[axis]) * factor);
        }
        const uint32_t expected = modulo(cell[1], texture.height) * texture.width + modulo(cell[0], texture.width);
        tally.expect(texture_at(scene, texture, uv) == Vec3<Real>(Real(expected)));
    }
};

/// Texels in rows of any length: near the origin, where floats represent all integers, and beyond.
struct RepeatedTexels {
    int64_t largest;  // |i| + n; 0: what the type holds exactly, up to 2^30

    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector&, uint64_t i, Tally& tally) const {
        Draw draw = setup.draw(i);
        const uint32_t n = draw.one_in(2) ? uint32_t(draw.between(1, 16)) : uint32_t(draw.between(1, 8192));
        const int64_t exact_to = sizeof(Real) == sizeof(float) ? int64_t(1) << 24 : int64_t(1) << 30;
        const int64_t most = (largest > 0 ? largest : exact_to) - n - 1;
        const int64_t range = most >> draw.between(0, 12);
        int64_t whole = int64_t(draw.bits() % uint64_t(2 * range + 1)) - range;
        if (draw.one_in(2)) whole = whole / n * n + draw.between(-1, 1);  // at the row's ends
        const Real x = Real(whole);
        tally.expect(repeated(x, n) == modulo(int64_t(x), n));
    }
    template <class Case>
    static void plan_rows(Plan& plan, int64_t most) {
        SceneDescription scene = empty_scene();
        add_object(scene, solid_object(PlatonicSolid::cube));
        plan.add("rows", scene, Case{{most}}, {}, plan.rays(20'000'000, 300'000));
    }
};

struct RepeatedNear : RepeatedTexels {
    static constexpr const char* name = "metamorphic/floor-texture/repeated";
    static constexpr const char* exact = "i modulo n, n to 8192, |i| + n to 2^24 in float and 2^30 in double";
    static constexpr Bound bound = no_failures("texels");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_rows<RepeatedNear>(plan, 0); }
};

struct RepeatedFar : RepeatedTexels {
    static constexpr const char* name = "metamorphic/floor-texture/repeated/to-1e9";
    static constexpr const char* exact = "i modulo n, n to 8192, |i| to 1e9, where floats are 64 apart";
    static constexpr Bound bound = no_failures("texels");
    static constexpr bool own_traversal = true;
    static void plan(Plan& plan) { plan_rows<RepeatedFar>(plan, 1'000'000'000); }
};

/// A floor of half width `size` with a checkerboard of `cell`, seen from above at up to 45 degrees.
struct FarFloor {
    static constexpr const char* name = "metamorphic/floor-texture/far";
    static constexpr const char* exact = "a floor's cells to 1e9, 32 u of its size beside borders and farther";
    // In u M: the point under a ray is off by 8 by the rounding of its slope, height and their product, which all
    // corners share; by 5 by that of the corners against the ray; by 10 by weights, whose edge functions are good to 2
    // u relative and their sum to 3 more, over a floor of width 2; by 6 by the sum over the corners' uv; and corners
    // and uv have been rounded themselves, 1 each: 31. Each of them the worst.
    static constexpr double margin = 32;
    static constexpr Bound bound = no_failures("cells");
    static constexpr bool needs_witness = true;
    double size, cell;

    static void plan(Plan& plan) {
        struct Floor {
            const char* label;
            double size, cell;
        };
        for (const Floor& floor : {Floor{"size 1, cell 1/16", 1, 0x1p-4}, Floor{"size 1e3, cell 1", 1e3, 1},
                                   Floor{"size 1e6, cell 1", 1e6, 1}, Floor{"size 1e6, cell 16", 1e6, 16},
                                   Floor{"size 1e9, cell 1", 1e9, 1}, Floor{"size 1e9, cell 2^14", 1e9, 0x1p14}}) {
            SceneDescription scene = empty_scene();
            TextureDescription checker;
            checker.name = "checker";
            checker.repeat = glm::dvec2(0.5 / floor.cell);
            scene.textures.push_back(checker);
            scene.materials[0].texture = 0;
            scene.materials[0].color = glm::dvec3(1);
            TrianglesObject quad;
            for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
                quad.vertices.emplace_back(x * floor.size, y * floor.size, 0);
                quad.uvs.emplace_back(x * floor.size, y * floor.size);
            }
            quad.triangles = {{0, 1, 2}, {0, 2, 3}};
            add_object(scene, quad);
            plan.add(floor.label, scene, FarFloor{floor.size, floor.cell}, {}, plan.rays(2'000'000, 60'000));
        }
    }
    template <class Real, class Intersector>
    CISTULA_HD void operator()(const Setup<Real>& setup, const Intersector& intersector, uint64_t i,
                               Tally& tally) const {
        Draw draw = setup.draw(i);
        const double extent = double(setup.extent());
        // At a border, a little beside it, or anywhere.
        double x[2], start[2];
        for (int axis = 0; axis < 2; ++axis) {
            x[axis] = draw.centered<double>(1.9) * size;
            if (!draw.one_in(4)) x[axis] = floor_of(x[axis] / cell) * cell;
            if (draw.one_in(2)) x[axis] += draw.centered<double>(4) * margin * double(RealTraits<Real>::unit) * size;
            start[axis] = draw.centered<double>(0.9) * extent;
        }
        const double height = (0.25 + draw.unit<double>()) * extent;
        const Vec3<Real> origin(Vec3<double>(start[0] + x[0] * setup.factor, start[1] + x[1] * setup.factor, height) *
                                0.5);
        const Vec3<Real> target(Vec3<double>(x[0], x[1], 0) * setup.factor);
        const Ray<Real> ray = ray_from(origin, normalized(target - origin));
        const Vec3<double> d(ray.direction);
        if (!(-d.z >= magnitude(d.x) && -d.z >= magnitude(d.y))) return;
        const Hit<Real> hit = intersector.closest(ray);
        int64_t low[2], high[2];
        for (int axis = 0; axis < 2; ++axis) {
            const DoubleDouble slope = DoubleDouble(d[axis]) / DoubleDouble(d.z);
            const DoubleDouble at = DoubleDouble(double(ray.origin[axis])) - slope * DoubleDouble(double(ray.origin.z));
            const double world = (at.high + at.low) / setup.factor,
                         off = margin * double(RealTraits<Real>::unit) * size;
            if (magnitude(world) > size - off) return;
            low[axis] = whole_below((world - off) / cell);
            high[axis] = whole_below((world + off) / cell);
        }
        const bool sure = low[0] == high[0] && low[1] == high[1];
        tally.expect(hit.found());
        if (!hit.found() || !sure) return;
        const Surface<Real> surface = surface_at<Real, Effects<all_effects>>(setup.scene, ray, hit);
        tally.expect((surface.color.x > Real(0.5)) == (modulo(low[0] + low[1], 2) == 0));
        tally.witness(true);
    }
};

}  // namespace cistula::verify::metamorphic
