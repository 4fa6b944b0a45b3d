// Pixels that are traced eight at a time are those that are traced one at a time, bit for bit: rays, flags and sums.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "backend_embree/embree_renderer.h"
#include "backend_embree/packet_tracer.h"
#include "endless_scene.h"
#include "golden.h"
#include "scene/compiled_scene.h"
#include "scene/film_difference.h"
#include "scene/without_effect.h"
#include "stopping.h"
#include "support_scene.h"

namespace cistula {
namespace {

static_assert(fits_packets<Effects<opaque_solids>> && fits_packets<Effects<opaque_bodies>> &&
              fits_packets<Effects<mirrors>>);
static_assert(!fits_packets<Effects<clear_bodies>> && !fits_packets<Effects<all_effects>>);

SceneDescription mirrors_on_a_floor() {
    return without_effect(read_scene(CISTULA_SOURCE_DIR "/scenes/benchmark.json"), effect_transmission).value();
}
SceneDescription bodies_on_a_floor() {
    return without_effect(mirrors_on_a_floor(), effect_reflection).value();
}
SceneDescription bodies_alone() {
    return without_effect(bodies_on_a_floor(), effect_triangles).value();
}

/// Of every mask that goes by packets.
std::vector<std::pair<SceneDescription, uint32_t>> scenes_and_masks() {
    return {{bodies_alone(), opaque_solids}, {bodies_on_a_floor(), opaque_bodies}, {mirrors_on_a_floor(), mirrors}};
}

template <class Real>
class Packets : public testing::Test {
  protected:
    /// What --effects all renders, one pixel at a time, against what runs without it: `mask`.
    static Film compare(const SceneDescription& scene, FrameSettings settings, uint32_t mask, const std::string& what) {
        const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
        EXPECT_NE(make_small_renderer<Real>(compiled), nullptr) << what << ": not by packets";
        const auto renderer = make_embree_renderer<Real>(compiled, EmbreeOptions());
        const Film packets = golden::render_with(*renderer, scene, settings);
        EXPECT_EQ(renderer->effects(), mask) << what;
        settings.effects = all_effects;
        const FilmDifference difference = film_difference(packets, golden::render_with(*renderer, scene, settings));
        EXPECT_EQ(difference.differing, 0u) << what << ", first at pixel " << difference.first.value_or(0);
        return packets;
    }
    static FrameSettings frame(int width, int height, int depth = 4) {
        FrameSettings settings;
        settings.set_size(width, height);
        settings.depth = depth;
        return settings;
    }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Packets, Reals);

TYPED_TEST(Packets, OfAnyWidth) {
    for (const auto& [scene, mask] : scenes_and_masks())
        for (int width = 1; width <= 18; ++width) {
            FrameSettings settings = this->frame(97, 55);
            settings.crop = {41 - width, 11, width, 33};
            settings.tile = width % 3 == 0 ? 13 : 16;
            const Film film = this->compare(scene, settings, mask, std::to_string(width) + " pixels wide");
            EXPECT_GT(film.rays.shadow, 0u);
        }
}

/// Of every sample a budget of its own, and lamps beside what is cut.
TYPED_TEST(Packets, OfManySamples) {
    for (const int supersample : {2, 3, 8})
        for (const double cutoff : {0.0, 0.02, 0.3}) {
            FrameSettings settings = this->frame(61, 35, 6);
            settings.supersample = supersample;
            settings.cutoff = cutoff;
            const std::string what =
                std::to_string(supersample) + " samples along a side, cutoff " + std::to_string(cutoff);
            this->compare(mirrors_on_a_floor(), settings, mirrors, what);
            this->compare(bodies_on_a_floor(), settings, opaque_bodies, what);
        }
}

TYPED_TEST(Packets, OfOneSurface) {
    const Film film = this->compare(mirrors_on_a_floor(), this->frame(96, 54, 1), mirrors, "depth 1");
    EXPECT_EQ(film.rays.reflected, 0u);
}

/// Exponents that are no integers, a lamp that adds nothing, and more lamps than one.
TYPED_TEST(Packets, OfManyLamps) {
    SceneDescription scene = mirrors_on_a_floor();
    scene.materials[0].exponent = 7.5;
    scene.materials[1].diffuse = 0;
    scene.materials[1].exponent = 1000;
    for (int i = 0; i < 6; ++i) test::add_light(scene, {2.0 * i - 5, 5.0 - i, 4});
    this->compare(scene, this->frame(160, 90), mirrors, "many lamps");
}

/// Crossings at equal times: sheets in one place, and in the plane of a solid's face.
TYPED_TEST(Packets, OfFacesInOnePlace) {
    SceneDescription scene = mirrors_on_a_floor();
    test::add_solid(scene, PlatonicSolid::cube, {-2.5, -2.5, 1}, std::sqrt(3.0));  // from 0 to 2
    for (const double height : {2.0, 2.0, 0.0}) {
        TrianglesObject sheet;
        sheet.vertices = {{-5, -5, height}, {0, -5, height}, {0, 0, height}, {-5, 0, height}};
        sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
        test::add_object(scene, sheet, test::add_material(scene, 0.3));
    }
    this->compare(scene, this->frame(192, 108, 8), mirrors, "faces in one place");
}

TYPED_TEST(Packets, OfLongPathsAndWhatIsCutFromThem) {
    SceneDescription scene = without_effect(test::room_of_mirrors(), effect_transmission).value();
    for (const double cutoff : {0.0, 0.01, 0.2}) {
        for (MaterialDescription& material : scene.materials) material.reflection = cutoff > 0 ? 0.8 : 1;
        FrameSettings settings = this->frame(96, 54, 40);
        settings.cutoff = cutoff;
        const Film film = this->compare(scene, settings, mirrors, "cutoff " + std::to_string(cutoff));
        bool is_cut = false, is_pruned = false;
        for (const PixelRecord& pixel : film.pixels) {
            is_cut |= pixel.cut[0] != 0;
            is_pruned |= pixel.pruned[0] != 0;
        }
        EXPECT_EQ(is_cut, cutoff == 0);
        EXPECT_EQ(is_pruned, cutoff > 0);
    }
}

TYPED_TEST(Packets, FromFarAway) {
    for (auto [scene, mask] : {std::pair{bodies_alone(), opaque_solids}, std::pair{mirrors_on_a_floor(), mirrors}}) {
        scene.camera.position_path.reset();
        scene.camera.target_path.reset();
        scene.camera.position = {300, -200, 150};
        scene.camera.target = {0, 0, 1};
        scene.camera.field_of_view = 2.5;
        FrameSettings settings = this->frame(96, 54);
        EXPECT_GT(this->compare(scene, settings, mask, "from far away").rays.shadow, 500u);
        settings.supersample = 3;
        this->compare(scene, settings, mask, "from far away, in many samples");
    }
}

/// Faces of both sides, in many directions, of more triangles than a packet has lanes.
TYPED_TEST(Packets, AmongSheets) {
    test::Random random(7);
    SceneDescription scene = mirrors_on_a_floor();
    TrianglesObject leaves;
    for (uint32_t i = 0; i < 20; ++i) {
        const glm::dvec3 middle = random.in_cube(3) + glm::dvec3(0, 0, 3);
        for (int corner = 0; corner < 3; ++corner) leaves.vertices.push_back(middle + random.in_cube(1));
        leaves.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    test::add_object(scene, leaves, test::add_material(scene, 0.5));
    this->compare(scene, this->frame(192, 108, 12), mirrors, "among leaves");
    this->compare(without_effect(scene, effect_solids).value(), this->frame(192, 108, 12), mirrors,
                  "among leaves alone");
}

TYPED_TEST(Packets, StopAmongSamples) {
    const SceneDescription scene = without_effect(test::room_of_mirrors(), effect_transmission).value();
    FrameSettings settings = test::endless_settings(64, 36);
    settings.supersample = 64;
    const auto renderer = make_embree_renderer<TypeParam>(compile_scene<TypeParam>(scene), EmbreeOptions());
    const test::Stopped stopped = test::render_stopped(*renderer, camera_at(scene.camera, 0), settings, 0.1);
    EXPECT_EQ(renderer->effects(), mirrors);
    EXPECT_FALSE(stopped.whole);
    EXPECT_GT(stopped.seconds, -0.05) << "the frame is not endless";
    EXPECT_LT(stopped.seconds, 2);
}

/// What no scene file can bring about, so that the compiled scene is changed: a channel of the lights that is out of
/// range adds nothing and is flagged, and the others are as ever.
TYPED_TEST(Packets, OutOfRange) {
    using Real = TypeParam;
    const Real infinity = RealTraits<Real>::infinity, faults[] = {infinity, infinity - infinity, -1};
    FrameSettings settings = this->frame(61, 35);
    for (const auto& [scene, mask] : scenes_and_masks())
        for (int channel = 0; channel < 3; ++channel) {
            const auto render = [&](Real intensity, uint32_t effects) {
                std::shared_ptr<CompiledScene<Real>> compiled = compile_scene<Real>(scene);
                for (Light<Real>& light : compiled->lights) light.intensity[channel] = intensity;
                EXPECT_NE(make_small_renderer<Real>(compiled), nullptr);
                const auto renderer = make_embree_renderer<Real>(compiled, EmbreeOptions());
                settings.effects = effects;
                Film film = golden::render_with(*renderer, scene, settings);
                EXPECT_EQ(renderer->effects(), effects == 0 ? mask : effects);
                return film;
            };
            const Film without = render(0, 0);
            EXPECT_EQ(without.flags, 0u);
            for (const Real fault : faults) {
                const std::string what = std::to_string(fault) + " in channel " + std::to_string(channel);
                const Film packets = render(fault, 0);
                const FilmDifference difference = film_difference(packets, render(fault, all_effects));
                EXPECT_EQ(difference.differing, 0u) << what << ", first at pixel " << difference.first.value_or(0);
                EXPECT_EQ(packets.flags, uint32_t(flag_not_finite)) << what;
                for (size_t i = 0; i < without.pixels.size(); ++i)
                    for (int c = 0; c < 3; ++c)
                        ASSERT_EQ(packets.pixels[i].radiance[c], without.pixels[i].radiance[c])
                            << what << ", pixel " << i;
            }
        }
}

}  // namespace
}  // namespace cistula
