// What may never change an image: threads, tiles, instruction sets, trees, the order of lights, effects that a scene does
// not use, and solids that cannot be seen. And what truncation may take away: at most what the ledger says.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "cistula/fixed_sum.h"
#include "golden.h"
#include "scene/compiled_scene.h"
#include "scene/generated_mesh.h"

using namespace cistula;

namespace {

const std::string source = CISTULA_SOURCE_DIR;

SceneDescription load(const std::string& name) {
    return read_scene(source + "/scenes/" + name + ".json");
}

FrameSettings small_frame(const SceneDescription& scene, int depth = 0) {
    FrameSettings settings = golden::settings_for(scene);
    settings.full_width = 160;
    settings.full_height = 90;
    settings.crop = {0, 0, 160, 90};
    if (depth > 0) settings.depth = depth;
    return settings;
}

template <class Real>
Film render(const SceneDescription& scene, const FrameSettings& settings, const EmbreeOptions& options = {}) {
    const auto renderer = make_embree_renderer<Real>(compile_scene<Real>(scene), options);
    return golden::render_with<Real>(*renderer, scene, settings);
}

/// 0 <= reference - image <= ledger of the image, per pixel and channel, in integers.
::testing::AssertionResult within_ledger(const Film& reference, const Film& image, double& used) {
    int64_t lost = 0, stated = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const PixelRecord &r = reference.pixels[i], &p = image.pixels[i];
            const int64_t loss = r.radiance[c] - p.radiance[c], ledger = p.pruned[c] + p.cut[c];
            if (loss < 0 || loss > ledger)
                return ::testing::AssertionFailure()
                       << "pixel " << i << " channel " << c << ": lost " << loss << ", ledger " << ledger;
            lost += loss >> 20;
            stated += ledger >> 20;
        }
    used = stated > 0 ? double(lost) / double(stated) : 1;
    return ::testing::AssertionSuccess();
}

template <class Real>
constexpr double largest_share_apart = sizeof(Real) == 4 ? 0.002 : 0.0002;

template <class Real>
class Images : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Images, Reals);

TYPED_TEST(Images, ThreadsAndTilesChangeNothing) {
    const SceneDescription scene = load("platonic");
    FrameSettings settings = small_frame(scene);
    const std::string expected = film_hash(render<TypeParam>(scene, settings));
    for (const size_t threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        for (const int tile : {1, 7, 16, 64}) {
            settings.tile = tile;
            EXPECT_EQ(film_hash(render<TypeParam>(scene, settings)), expected) << threads << " threads, tile " << tile;
        }
    }
}

TYPED_TEST(Images, InstructionSetsAndTreesChangeNothing) {
    const SceneDescription scene = load("mesh");
    const FrameSettings settings = small_frame(scene, 4);
    const std::string expected = film_hash(render<TypeParam>(scene, settings));
    for (const char* isa : {"isa=sse2", "isa=avx2", "isa=avx512"}) {
        EmbreeOptions options;
        options.device_config = isa;
        EXPECT_EQ(film_hash(render<TypeParam>(scene, settings, options)), expected) << isa;
    }
    EmbreeOptions quick;
    quick.tree_quality = 0;
    EXPECT_EQ(film_hash(render<TypeParam>(scene, settings, quick)), expected);
    for (const int quality : {0, 1}) {
        auto compiled = compile_scene<TypeParam>(scene);
        build_primitive_tree(*compiled, quality);
        const auto renderer = make_host_renderer<TypeParam>(std::move(compiled), HostIntersector::bvh);
        EXPECT_EQ(film_hash(golden::render_with<TypeParam>(*renderer, scene, settings)), expected) << "bvh " << quality;
    }
}

TYPED_TEST(Images, ATreeAndThePlainLoopAgree) {
    for (const char* name : {"benchmark", "glass"}) {
        const SceneDescription scene = load(name);
        EmbreeOptions tree;
        tree.always_tree = true;
        const FrameSettings settings = small_frame(scene);
        EXPECT_EQ(film_hash(render<TypeParam>(scene, settings)), film_hash(render<TypeParam>(scene, settings, tree)))
            << name;
    }
}

TYPED_TEST(Images, EffectsThatAreNotUsedChangeNothing) {
    for (const char* name : {"benchmark", "platonic", "infinity"}) {
        const SceneDescription scene = load(name);
        FrameSettings settings = small_frame(scene, 4);
        const std::string expected = film_hash(render<TypeParam>(scene, settings));
        for (const uint32_t mask : effect_masks) {
            settings.effects = mask;
            EXPECT_EQ(film_hash(render<TypeParam>(scene, settings)), expected) << name << ", mask " << mask;
        }
    }
}

TYPED_TEST(Images, TheOrderOfLightsChangesNothing) {
    SceneDescription scene = load("benchmark");
    scene.lights.push_back(scene.lights[0]);
    scene.lights.back().position = {0.3, -4, 7};
    const FrameSettings settings = small_frame(scene);
    const std::string expected = film_hash(render<TypeParam>(scene, settings));
    std::reverse(scene.lights.begin(), scene.lights.end());
    EXPECT_EQ(film_hash(render<TypeParam>(scene, settings)), expected);
}

TYPED_TEST(Images, ACropIsThatPartOfTheFrame) {
    const SceneDescription scene = load("glass");
    FrameSettings settings = small_frame(scene);
    const Film whole = render<TypeParam>(scene, settings);
    settings.crop = {41, 23, 30, 20};
    const Film part = render<TypeParam>(scene, settings);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 30; ++x) {
            const PixelRecord& a = whole.pixels[size_t((23 + y) * 160 + 41 + x)];
            const PixelRecord& b = part.pixels[size_t(y * 30 + x)];
            ASSERT_EQ(std::memcmp(a.radiance, b.radiance, sizeof a.radiance), 0) << x << ", " << y;
            ASSERT_EQ(a.id, b.id);
            ASSERT_EQ(a.rays, b.rays);
        }
}

/// A solid of index 1 that mirrors and tints nothing is not there, for convex solids and for meshes.
TYPED_TEST(Images, IndexOneIsInvisible) {
    SceneDescription scene = load("glass");
    scene.frame = FrameOfReference{{0, 0, 1}, -4, 64.0};
    const FrameSettings settings = small_frame(scene, 5);
    const Film without = render<TypeParam>(scene, settings);
    MaterialDescription air;
    air.name = "air";
    air.transmission = 1;
    scene.materials.push_back(air);
    const int material = int(scene.materials.size()) - 1;
    for (const PlatonicSolid solid : {PlatonicSolid::icosahedron, PlatonicSolid::tetrahedron}) {
        ObjectDescription object;
        object.name = "nothing";
        object.material = material;
        SolidObject shape;
        shape.solid = solid;
        shape.center = {0.4, -0.3, 1.1};
        shape.radius = 1.7;
        object.shape = shape;
        scene.objects.insert(scene.objects.begin(), object);
        const Film with = render<TypeParam>(scene, settings);
        EXPECT_EQ(with.flags, 0u);
        size_t differing = 0;
        for (size_t i = 0; i < with.pixels.size(); ++i)
            differing += std::memcmp(with.pixels[i].radiance, without.pixels[i].radiance, sizeof without.pixels[i].radiance) != 0;
        EXPECT_EQ(differing, 0u);
    }
}

/// Solids as planes and as closed meshes go different ways through the code: to one picture, but for the rays that rounding
/// sends past an edge on the other side.
TYPED_TEST(Images, PlanesAndTrianglesShowTheSame) {
    for (const char* name : {"benchmark", "glass"}) {
        SceneDescription scene = load(name);
        const FrameSettings settings = small_frame(scene);
        const Film planes = render<TypeParam>(scene, settings);
        for (ObjectDescription& object : scene.objects)
            if (const auto* solid = std::get_if<SolidObject>(&object.shape)) object.shape = triangulated_solid(*solid);
        const Film triangles = render<TypeParam>(scene, settings);
        EXPECT_EQ(triangles.flags, 0u);
        const ColorPicture a = to_color(planes), b = to_color(triangles);
        size_t apart = 0;
        for (size_t i = 0; i < a.texels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                if (std::abs(a.texels[i][c] - b.texels[i][c]) > 0.5f / 255) {
                    ++apart;
                    break;
                }
        EXPECT_LE(double(apart), largest_share_apart<TypeParam> * double(a.texels.size())) << name << ": " << apart;
    }
}

TYPED_TEST(Images, TruncationStaysWithinTheLedger) {
    for (const char* name : {"benchmark", "platonic", "glass", "infinity"}) {
        const SceneDescription scene = load(name);
        const Film reference = render<TypeParam>(scene, small_frame(scene, 24));
        for (const int depth : {1, 2, 4, 8}) {
            double used = 0;
            EXPECT_TRUE(within_ledger(reference, render<TypeParam>(scene, small_frame(scene, depth)), used))
                << name << " at depth " << depth;
        }
        FrameSettings budget = small_frame(scene, 24);
        for (const double cutoff : {1e-3, 0.02, 0.5}) {
            budget.cutoff = cutoff;
            const Film image = render<TypeParam>(scene, budget);
            double used = 0;
            EXPECT_TRUE(within_ledger(reference, image, used)) << name << " with cutoff " << cutoff;
            EXPECT_LT(image.rays.total(), reference.rays.total());
            // The budget itself holds too: pruned <= cutoff per pixel, in units of the sums.
            const double unit = fixed_scale(image.fixed_shift) / elementary::power_of_two(image.radiance_exponent);
            for (const PixelRecord& pixel : image.pixels)
                for (const int64_t pruned : pixel.pruned) ASSERT_LE(double(pruned), cutoff * unit * (1 + 1e-9) + 4096);
        }
    }
}

}  // namespace
