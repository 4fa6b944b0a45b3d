// A slab whose two faces reflect R and transmit 1 - R, in front of a wall of radiance 1: T = (1-R)^2 (1 + R^2 + R^4 +
// ...).
#pragma once

#include "apps/render_verify/mirrors/mirror_images.h"

namespace cistula::verify::mirrors {

/// A box of triangles about the origin.
inline TrianglesObject box(const glm::dvec3& half) {
    TrianglesObject object = triangulated_solid(solid_object(PlatonicSolid::cube));
    for (glm::dvec3& v : object.vertices)
        for (int axis = 0; axis < 3; ++axis) v[axis] = v[axis] < 0 ? -half[axis] : half[axis];
    return object;
}

/// A slab perpendicular to y between the camera and the wall: a cube of planes or a thin box of triangles.
inline SceneDescription slab_scene(Shape shape, double reflectance) {
    SceneDescription scene = share_scene(reflectance, 1 - reflectance, 0);
    if (shape == Shape::planes)
        add_object(scene, solid_object(PlatonicSolid::cube, glm::dvec3(0), std::sqrt(3.0)));
    else
        add_object(scene, box({1, 0x1p-6, 1}));
    scene.materials.push_back(share_material("wall", 0, 0));
    add_object(scene, square_across_y(1.75, 1.5), 1);
    return scene;
}

/// A film with a view so narrow that 1,024 crossings of the slab stay on its large faces.
inline Film slab_film(const Stage& stage, Shape shape, double reflectance, int depth) {
    return film_of(stage, slab_scene(shape, reflectance), {0.001, -3, 0.002}, {0.001, 0, 0.002},
                   shape == Shape::planes ? 0.03 : 1.5, stage.quick ? 3 : 16, depth);
}

/// Number of terms within a depth. The surfaces of a path are the near face, the far one, 2 j more in the slab, the
/// wall.
inline int terms_within(int depth) {
    return depth < 3 ? 0 : (depth - 1) / 2;
}

/// Deviation in ulps of a sum of `terms` terms from its closed form in the scene's R, or of the sum with its ledger
/// from the limit. Truncation takes less than a unit of the sums from each term, besides what was pruned.
inline double slab_deviation(const Stage& stage, const PixelRecord& pixel, int channel, double reflectance, int terms) {
    const auto in_real = [&](double x) { return stage.in_double() ? x : double(float(x)); };
    const __float128 r = in_real(reflectance), t = in_real(1 - reflectance);
    __float128 power = 1;
    for (int j = 0; j < terms; ++j) power *= r * r;
    const __float128 limit = t * t / (1 - r * r) * whole, closed = limit * (1 - power);
    const __float128 above = pixel.radiance[channel] - closed;
    const __float128 below = -above - terms - pixel.pruned[channel];
    const __float128 missing = limit - pixel.radiance[channel] - ledger(pixel, channel) - terms;
    const __float128 larger = above > below ? above : below, off = larger > missing ? larger : missing;
    return off > 0 ? double(off / closed) / (2 * stage.unit()) : 0;
}

template <int percent>
struct SemiMirrorSlab {
    static void render(Stage& stage, Tally& tally) {
        constexpr double r = percent / 100.0;
        for (const Shape shape : {Shape::planes, Shape::triangles})
            for_each_sum(tally, shape == Shape::planes ? 0 : 5000, slab_film(stage, shape, r, 1024),
                         [&](const PixelRecord& pixel, int c) {
                             tally.measure(slab_deviation(stage, pixel, c, r, terms_within(1024)));
                         });
    }
};

// Term j is a product of 2 j + 2 shares, the first of which is exact: (2 j + 1) u. Over all terms that is
// 1 + 2 R^2 / (1 - R^2) u: 9.6 u for R = .9 and 99.6 u for R = .99, half as many ulps.
struct SemiMirror90 : SemiMirrorSlab<90> {
    static constexpr const char* name = "mirrors/semi-mirror-slab/0.9";
    static constexpr const char* exact = "T = (1-R)/(1+R), depth 1,024, less truncation; the rest is in the ledger";
    static constexpr Bound bound = at_most(4.8, "ulps");
};
struct SemiMirror99 : SemiMirrorSlab<99> {
    static constexpr const char* name = "mirrors/semi-mirror-slab/0.99";
    static constexpr const char* exact = SemiMirror90::exact;
    static constexpr Bound bound = at_most(49.8, "ulps");
};
struct SemiMirror50 {
    static constexpr const char* name = "mirrors/semi-mirror-slab/0.5";
    static constexpr const char* exact = "T = 1/3, depth 1,024, to the last of 62 bits";
    static constexpr Bound bound = no_failures("sums");
    static void render(Stage& stage, Tally& tally) {
        for (const Shape shape : {Shape::planes, Shape::triangles})
            for_each_sum(tally, shape == Shape::planes ? 0 : 5000, slab_film(stage, shape, 0.5, 1024),
                         [&](const PixelRecord& pixel, int c) {
                             tally.expect(pixel.radiance[c] == whole / 3 && pixel.cut[c] == 0);
                         });
    }
};

/// Depths at which paths are cut, after k = terms_within(depth) terms.
inline constexpr int cut_depths[] = {1, 2, 3, 4, 7, 16, 33, 64, 255};

struct DepthCut {
    static constexpr const char* name = "mirrors/depth-cut";
    static constexpr const char* exact =
        "cut after k terms: 0 <= T - image <= ledger, in integers; R = .5: T - image = T R^2k";
    static constexpr Bound bound = no_failures("sums");
    static void render(Stage& stage, Tally& tally) {
        uint64_t place = 0;
        for (const Shape shape : {Shape::planes, Shape::triangles})
            for (const double r : {0.5, 0.9, 0.99}) {
                const Film reference = slab_film(stage, shape, r, 1024);
                for (const int depth : cut_depths) {
                    const Film film = slab_film(stage, shape, r, depth);
                    size_t sums = 0;
                    for_each_sum(tally, place, film, [&](const PixelRecord& pixel, int c) {
                        const int64_t most = reference.pixels[sums++ / 3].radiance[c];
                        tally.expect(pixel.radiance[c] <= most && most - pixel.radiance[c] <= ledger(pixel, c));
                        if (r == 0.5) tally.expect(halves(pixel, c, depth));
                    });
                    place += 1000;
                }
            }
    }

  private:
    /// T R^2k = 4^-k / 3 remains, to the units that the sums can hold; the ledger has both branches of the last face,
    /// half of what gets there each: 2^-depth B twice, or after the near face 2^-1 B.
    static bool halves(const PixelRecord& pixel, int c, int depth) {
        const int k = terms_within(depth);
        const bool remains = whole / 3 - pixel.radiance[c] == (k > 30 ? 0 : (whole >> 2 * k) / 3);
        const bool exactly = depth > 50 || (pixel.pruned[c] == 0 && pixel.cut[c] == 2 * (bound_of_whole >> depth));
        return remains && exactly;
    }
};

}  // namespace cistula::verify::mirrors
