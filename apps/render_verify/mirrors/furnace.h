// Furnace test: lossless objects are invisible in a world of constant radiance.
#pragma once

#include "apps/render_verify/mirrors/mirror_images.h"

namespace cistula::verify::mirrors {

/// Tests the bodies one by one, then five overlapping solids, seen from outside and from inside.
template <class Check>
void for_each_furnace(const Stage& stage, const SceneDescription& lossless, int depth_of_convex, int depth_of_others,
                      const Check& check) {
    const int size = stage.quick ? 6 : 48;
    std::vector<Body> all = bodies(lossless);
    Body together{lossless, glm::dvec3(0), 0.1};
    for (const PlatonicSolid kind : platonic_solids) {
        const double n = double(together.scene.objects.size());
        add_solid(together.scene, Shape::planes,
                  solid_object(kind, {0.3 * n - 0.6, 0.1 * n, 0}, 0.8, glm::dvec3(31 * n, 0, 11)));
    }
    all.push_back(together);
    for (const Body& body : all) {
        const bool convex =
            body.scene.objects.size() == 1 && std::holds_alternative<SolidObject>(body.scene.objects[0].shape);
        const int depth = convex ? depth_of_convex : depth_of_others;
        check(film_of(stage, body.scene, {0.4, -3.5, 0.8}, {0, 0, 0}, 40, size, depth), depth);
        const glm::dvec3 from = body.middle + body.around * glm::dvec3(0.3, -0.2, 0.1);
        check(film_of(stage, body.scene, from, from + glm::dvec3(0.3, 1, -0.2), 90, size, depth), depth);
    }
}

/// Furnace with shares of 1/2, which make every weight a power of two.
struct FurnaceHalves {
    static constexpr const char* name = "mirrors/furnace/halves";
    static constexpr const char* exact =
        "lossless solids in a white world, kr = kt = 1/2: (1 - image) B = ledger, in integers";
    static constexpr Bound bound = no_failures("sums");
    static constexpr bool needs_witness = true;
    static void render(Stage& stage, Tally& tally) {
        uint64_t place = 0;
        for_each_furnace(stage, share_scene(0.5, 0.5, 1), 40, 9, [&](const Film& film, int) {
            for_each_sum(tally, place, film, [&](const PixelRecord& pixel, int c) {
                const int64_t missing = whole - pixel.radiance[c];
                tally.expect(missing >= 0 && pixel.pruned[c] == 0 &&
                             __int128(missing) * bound_of_whole == __int128(pixel.cut[c]) * whole);
                tally.witness(missing > 0 && pixel.radiance[c] > 0);
            });
            place += 10000;
        });
    }
};

/// Furnace with glass of index 1.5: total reflection, given shares, and Fresnel's.
struct FurnaceGlass {
    static constexpr const char* name = "mirrors/furnace/glass";
    static constexpr const char* exact =
        "lossless glass in a white world: image + ledger / (1 + 2^-10) = 1, less truncation";
    // Rounding at each surface: kr and kt, 1 u for both; 1 - F; and the products with the branch's weight: at most 3 u
    // of what arrives. 10 surfaces, and the ledger's product with B: 31 u, or 15.5 ulps. A contribution and a branch
    // that is not followed are off by less than a unit of the sums each, three at most for a ray.
    static constexpr int depth = 10;
    static constexpr Bound bound = at_most(15.5, "ulps of 1");
    static constexpr bool needs_witness = true;
    static void render(Stage& stage, Tally& tally) {
        uint64_t place = 0;
        for (const bool fresnel : {false, true}) {
            SceneDescription scene = share_scene(fresnel ? 0.0 : 0.1, fresnel ? 1.0 : 0.9, 1);
            scene.materials[0].index = 1.5;
            scene.materials[0].fresnel = fresnel;
            for_each_furnace(stage, scene, depth, depth, [&](const Film& film, int) {
                for_each_sum(tally, place, film, [&](const PixelRecord& pixel, int c) {
                    const __float128 sum = pixel.radiance[c] + __float128(ledger(pixel, c)) * whole / bound_of_whole;
                    const __float128 off = sum > whole ? sum - whole : whole - sum,
                                     units = 3 * (__float128(pixel.rays) + 1);
                    tally.measure(off > units ? double((off - units) / whole) / (2 * stage.unit()) : 0);
                    tally.witness(pixel.cut[c] > 0 && pixel.radiance[c] > 0);
                });
                place += 10000;
            });
        }
    }
};

}  // namespace cistula::verify::mirrors
