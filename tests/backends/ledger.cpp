// The ledger is a proof: what truncation takes from any pixel of any scene is never more than it says, in integers. And
// it is of use: not many times more than the truth, and what it allows spares work.
#include <gtest/gtest.h>

#include <iostream>

#include "testing/support/golden.h"
#include "testing/support/scene.h"
#include "testing/support/shipped_scenes.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;
using glm::dvec3;

namespace {

/// A frame of the same view of at most so many pixels a side.
FrameSettings smaller(FrameSettings settings, int width, int height) {
    settings.set_size(std::min(settings.full_width, width), std::min(settings.full_height, height));
    settings.tile = 4;  // so that all threads have part in small frames
    return settings;
}

FrameSettings truncated(FrameSettings settings, int depth, double cutoff) {
    settings.depth = depth;
    settings.cutoff = cutoff;
    return settings;
}

/// Without a cutoff, as deep as `limit` rays or so allow: each step up is taken only below that. What it leaves out
/// itself makes it no less of a reference, as truncation only ever takes away: image <= reference <= truth <= image +
/// ledger.
struct Reference {
    Film film;
    int depth = 0;

    Reference(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings, uint64_t limit) {
        for (const int next : {8, 12, 16, 24, 32, 48, 64}) {
            film = golden::render_with(renderer, scene, truncated(settings, next, 0));
            depth = next;
            if (film.rays.total() > limit) break;
        }
    }
};

/// Sums over a picture of what the reference has more, and of the ledger, in units of the integers.
struct Totals {
    double lost = 0, ledger = 0;
    size_t violations = 0, compared = 0;

    void add(const Film& reference, const Film& image) {
        for (size_t i = 0; i < image.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const PixelRecord &r = reference.pixels[i], &p = image.pixels[i];
                const int64_t loss = r.radiance[c] - p.radiance[c], bound = p.pruned[c] + p.cut[c];
                violations += loss < 0 || loss > bound;
                ++compared;
                lost += double(loss);
                ledger += double(bound);
            }
    }
};

class Ledger : public ::testing::Test {
  protected:
    template <class Real>
    void check(const std::string& name, const SceneDescription& scene, const FrameSettings& settings) {
        constexpr uint64_t limit = 200000;
        const auto renderer = make_embree_renderer<Real>(compile_scene<Real>(scene));
        const Reference reference(*renderer, scene, settings, limit);
        EXPECT_EQ(reference.film.flags, 0u) << name;
        full_ += reference.depth == 64;
        ++references_;
        // Depth, both, and the budget alone.
        for (const auto& [depth, cutoff] : {std::pair{1, 0.0}, {2, 0.02}, {4, 0.5 / 255}, {reference.depth, 0.05}}) {
            const Film image = golden::render_with(*renderer, scene, truncated(settings, depth, cutoff));
            ASSERT_EQ(image.fixed_shift, reference.film.fixed_shift);
            ASSERT_EQ(image.radiance_exponent, reference.film.radiance_exponent);
            Totals totals;
            totals.add(reference.film, image);
            EXPECT_EQ(totals.violations, 0u)
                << name << " at depth " << depth << ", cutoff " << cutoff << ", in precision " << sizeof(Real) * 8;
            truncated_ += totals.lost > 0;
            compared_ += totals.compared;
        }
    }

    size_t compared_ = 0, references_ = 0;
    int full_ = 0;       // references of the whole depth
    int truncated_ = 0;  // images that lack anything
};

TEST_F(Ledger, HoldsInGeneratedScenes) {
    constexpr uint64_t count = 60;
    for (uint64_t seed = 0; seed < count; ++seed) {
        const SceneDescription scene = generated_scene(seed, test::scene_folder);
        const FrameSettings settings = smaller(generated_settings(scene), 24, 18);
        const std::string name = test::numbered("generated scene ", seed);
        if (seed % 2 == 0)
            check<float>(name, scene, settings);
        else
            check<double>(name, scene, settings);
    }
    std::cout << compared_ << " integers compared; " << full_ << " of " << references_ << " references at depth 64, "
              << truncated_ << " images that lack something\n";
    EXPECT_GE(full_, int(count) / 2);
    EXPECT_GE(truncated_, int(count) * 2);
}

TEST_F(Ledger, HoldsInAllScenes) {
    int scene_count = 0;
    for (const std::string& name : golden::scene_names(test::scene_folder)) {
        const SceneDescription scene = test::shipped_scene(name);
        const FrameSettings settings = smaller(golden::settings_for(scene), 32, 18);
        check<float>(name, scene, settings);
        check<double>(name, scene, settings);
        ++scene_count;
    }
    std::cout << compared_ << " integers compared; " << full_ << " of " << references_ << " references at depth 64, "
              << truncated_ << " images that lack something\n";
    EXPECT_GE(full_, scene_count);
    EXPECT_GE(truncated_, 4 * scene_count);
}

/// What whole units take is bounded by the rays: sums of a coarse unit, against those of one that is 2^40 times finer.
TEST_F(Ledger, HasWhatWholeUnitsTake) {
    uint64_t compared = 0, lost = 0;
    for (const std::string& name : golden::scene_names(test::scene_folder)) {
        SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = truncated(smaller(golden::settings_for(scene), 32, 18), 8, 0);
        settings.supersample = 2;
        const std::shared_ptr<const CompiledScene<double>> compiled = compile_scene<double>(scene);
        const Film fine = golden::render_with(*make_embree_renderer<double>(compiled), scene, settings);
        if (!scene.frame) scene.frame = FrameOfReference{compiled->center, compiled->scale, {}};
        constexpr int shift = 40;
        scene.frame->bound = std::ldexp(1.0, compiled->radiance_exponent + shift - 1);
        const std::shared_ptr<const CompiledScene<double>> coarse_scene = compile_scene<double>(scene);
        ASSERT_EQ(coarse_scene->radiance_exponent, compiled->radiance_exponent + shift);
        const Film coarse = golden::render_with(*make_embree_renderer<double>(coarse_scene), scene, settings);
        for (size_t i = 0; i < coarse.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const PixelRecord &f = fine.pixels[i], &p = coarse.pixels[i];
                const int64_t whole = f.radiance[c] >> shift, rest = f.radiance[c] & ((int64_t{1} << shift) - 1);
                const int64_t loss = whole - p.radiance[c];
                ASSERT_GE(loss, 0) << name << " pixel " << i;
                ASSERT_LE(loss + (rest > 0), p.pruned[c] + static_cast<int64_t>(coarse.units_lost(p)))
                    << name << " pixel " << i;
                ++compared;
                lost += loss > 0;
            }
    }
    std::cout << compared << " sums compared, " << lost << " lost units\n";
    EXPECT_GT(lost, compared / 10);
}

/// The lights that make the bound are seen by few of the rays that are cut, yet what is missing is a fair part of it.
TEST_F(Ledger, IsTightEnoughToBeUsed) {
    const SceneDescription scene = test::shipped_scene("infinity");
    const FrameSettings settings = smaller(golden::settings_for(scene), 160, 90);
    const auto renderer = make_embree_renderer<float>(compile_scene<float>(scene));
    const Film reference = golden::render_with(*renderer, scene, truncated(settings, 64, 0));
    Totals totals;
    totals.add(reference, golden::render_with(*renderer, scene, truncated(settings, 4, 0)));
    std::cout << "lost " << totals.lost / totals.ledger << " of the ledger\n";
    EXPECT_EQ(totals.violations, 0u);
    EXPECT_GE(totals.lost, 0.05 * totals.ledger);
}

/// Semi-mirrors, in which every ray goes on in two for as long as it is followed.
SceneDescription octahedron_on_a_floor() {
    SceneDescription scene;
    const int mirror = test::add_material(scene, 0.88, 0.1), floor = test::add_material(scene, 0.2);
    test::add_solid(scene, PlatonicSolid::octahedron, dvec3(0, 0, 1.2), 1.2, dvec3(0, 0, 20), mirror);
    TrianglesObject quad;
    quad.vertices = {{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}};
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    test::add_object(scene, quad, floor);
    test::add_light(scene, {-4, -3, 6});
    test::add_light(scene, {5, 4, 5});
    scene.camera.position = {-0.6, -4.2, 2.4};
    scene.camera.target = {0, 0, 1.1};
    return scene;
}

TEST_F(Ledger, ABudgetOfHalfAStepSparesTwoThirdsOfTheRays) {
    const SceneDescription scene = octahedron_on_a_floor();
    const FrameSettings settings = smaller(FrameSettings(), 160, 120);
    const auto renderer = make_embree_renderer<float>(compile_scene<float>(scene));
    const Film all = golden::render_with(*renderer, scene, truncated(settings, 64, 0));
    const Film image = golden::render_with(*renderer, scene, truncated(settings, 64, 0.5 / 255));
    Totals totals;
    totals.add(all, image);
    EXPECT_EQ(totals.violations, 0u);
    std::cout << all.rays.total() << " rays without a cutoff, " << image.rays.total() << " with, "
              << double(all.rays.total()) / double(image.rays.total()) << " times fewer\n";
    EXPECT_GE(all.rays.total(), 3 * image.rays.total());
    size_t on_the_solid = 0;
    for (const PixelRecord& pixel : all.pixels) on_the_solid += pixel.id == 1;
    EXPECT_GT(on_the_solid, all.pixels.size() / 8);
}

}  // namespace
