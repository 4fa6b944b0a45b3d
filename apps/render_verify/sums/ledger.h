// What truncation takes away, by the depth, by the cutoff and by the unit of the sums: no more than error.* says.
#pragma once

#include "apps/render_verify/given/writing.h"
#include "render/record/film_colors.h"

namespace cistula::verify::sums {

using namespace given;

/// Bodies of glass before a mirror, in the light of several lamps: pixels of hundreds of contributions.
inline SceneDescription many_branches() {
    SceneDescription scene = lit_scene();
    MaterialDescription semi = contact::glass(1.5, {0.1, 0.2, 0.4});
    semi.fresnel = false;
    semi.transmission = 0.5, semi.reflection = 0.3;
    semi.color = {0.7, 0.8, 0.6};
    const int half = add_material(scene, semi), mirror = add_material(scene, stone({0.9, 0.8, 0.7}, 0.6));
    add_object(scene, parallelogram({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), mirror);
    add_object(scene, parallelogram({-3, 2, 0}, {6, 0, 0}, {0, 0, 4}), mirror);
    add_object(scene, box({-0.8, -0.6, 0.2}, {-0.1, 0.5, 1.1}), half);
    add_object(scene, box({0.1, -0.3, 0.1}, {0.9, 0.6, 0.9}), half);
    scene.frame = FrameOfReference{{0, 0, 0}, -2, {}};
    for (int k = 0; k < 5; ++k) add_light(scene, {2.0 * k - 4, -3, 4.0 + 0.3 * k}).color = dvec3(0.2, 0.25, 0.15);
    return scene;
}

/// A picture of these with less than all light.
struct Loss {
    static constexpr int deep = 24;
    int depth = deep;
    double cutoff = 0;
    std::optional<double> bound;  // of radiance, pinned
    bool counts_ledger = true;

    Film film(const Stage& stage) const {
        SceneDescription scene = many_branches();
        scene.frame->bound = bound;
        scene.depth = depth;
        scene.cutoff = cutoff;
        return stage.render(scene, scene.film.width, scene.film.height);
    }
    void check(const Stage& stage, Tally& tally) const {
        const Film reference = Loss().film(stage), found = film(stage);
        const FilmColors colors(found, OutputChannels()), reference_colors(reference, OutputChannels());
        for (size_t i = 0; i < found.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double lost = radiance(reference, i, c) - radiance(found, i, c);
                tally.place = i;
                const double said = counts_ledger ? double(colors.error(found.pixels[i], c)) : 0;
                // The reference may lose as much as its own ledger says.
                tally.expect(lost <= said && lost >= -double(reference_colors.error(reference.pixels[i], c)));
                tally.witness(lost > 0);
            }
    }
};

struct Ledger {
    static constexpr const char* exact = "0 <= reference - image <= error.*, in every pixel and channel";
    static constexpr Bound bound = no_failures("sums");
    static constexpr bool needs_witness = true;
};
/// Units of 2^-22, 2^-14 and 2^-6.
struct CoarseUnits : Ledger {
    static constexpr const char* name = "sums/ledger/coarse-units";
    static void render(Stage& stage, Tally& tally) {
        for (const double of : {0x1p40, 0x1p48, 0x1p56}) Loss{Loss::deep, 0, of}.check(stage, tally);
    }
};
struct DepthCut : Ledger {
    static constexpr const char* name = "sums/ledger/depth";
    static void render(Stage& stage, Tally& tally) {
        for (const int depth : {1, 2, 5}) Loss{depth, 0, {}}.check(stage, tally);
    }
};
struct Cutoff : Ledger {
    static constexpr const char* name = "sums/ledger/cutoff";
    static void render(Stage& stage, Tally& tally) {
        for (const double cutoff : {1e-3, 0.03}) Loss{Loss::deep, cutoff, 0x1p48}.check(stage, tally);
    }
};
struct BrokenUnits {
    static constexpr const char* name = "sums/broken/ledger";
    static constexpr const char* exact = "without the ledger the case fails";
    static constexpr Bound bound = must_fail(5, "sums");
    static void render(Stage& stage, Tally& tally) { Loss{Loss::deep, 0, 0x1p48, false}.check(stage, tally); }
};

}  // namespace cistula::verify::sums
