// The baseline of the GPU tables renders Cistula's own picture: the same scene, light and camera, by another algorithm.
#include "bench/seed_baseline_scene.h"

#include <gtest/gtest.h>

#include "image/color/srgb_codes.h"
#include "image/picture/raw_picture.h"
#include "testing/support/golden.h"
#include "testing/support/scratch_directory.h"
#include "testing/support/shipped_scenes.h"

namespace cistula {
namespace {

constexpr int width = 160, height = 120;

ColorPicture picture_of(const seed::View& view, const std::vector<seed::Pixel>& pixels) {
    ColorPicture picture{static_cast<uint32_t>(view.width), static_cast<uint32_t>(view.height), {}};
    for (const seed::Pixel& p : pixels) picture.texels.emplace_back(p.r, p.g, p.b);
    return picture;
}

/// In steps of the 8-bit codes that a screen shows.
struct Difference {
    double mean = 0;    // over all channels
    double within = 0;  // share of pixels none of whose channels is more than 2 steps off
    int worst = 0;
};

/// Both of one size.
Difference compare(const ColorPicture& a, const ColorPicture& b) {
    Difference result;
    for (size_t i = 0; i < a.texels.size(); ++i) {
        int worst = 0;
        for (int c = 0; c < 3; ++c) {
            const int difference = srgb8_from_linear(a.texels[i][c]) - srgb8_from_linear(b.texels[i][c]);
            const int apart = difference < 0 ? -difference : difference;
            result.mean += apart;
            if (apart > worst) worst = apart;
        }
        result.within += worst <= 2 ? 1 : 0;
        if (worst > result.worst) result.worst = worst;
    }
    const double pixels = static_cast<double>(a.texels.size());
    result.mean /= 3 * pixels;
    result.within /= pixels;
    return result;
}

SceneDescription benchmark_scene() {
    return test::shipped_scene("benchmark");
}

template <int depth>
ColorPicture by_the_baseline(const SceneDescription& description) {
    const seed::OwnedScene scene = seed::make_scene(description);
    const seed::View view = seed::make_view(camera_at(description.camera, 0), width, height);
    std::vector<seed::Pixel> pixels(size_t(width) * height);
    seed::render_on_host<depth>(scene.view(), view, pixels.data());
    return picture_of(view, pixels);
}

ColorPicture by_embree(const SceneDescription& description, int depth) {
    FrameSettings settings;
    settings.set_size(width, height);
    settings.depth = depth;
    const auto renderer = make_embree_renderer<double>(compile_scene<double>(description));
    return to_color(golden::render_with(*renderer, description, settings));
}

template <int depth>
void expect_same_picture(const SceneDescription& description) {
    const Difference difference = compare(by_the_baseline<depth>(description), by_embree(description, depth));
    std::cout << "depth " << depth << ": mean " << difference.mean << "/255, within 2/255 " << 100 * difference.within
              << " %, worst " << difference.worst << "/255\n";
    EXPECT_GE(difference.within, 0.99);
    EXPECT_LE(difference.mean, 0.05);
}

TEST(SeedBaseline, TheSceneIsAllTriangles) {
    const seed::OwnedScene scene = seed::make_scene(benchmark_scene());
    EXPECT_EQ(scene.triangles.size(), 8u + 36u + 20u + 2u);
    EXPECT_EQ(scene.lights.size(), 2u);
}

TEST(SeedBaseline, RendersCistulasPicture) {
    expect_same_picture<1>(benchmark_scene());
    expect_same_picture<4>(benchmark_scene());
}

// The scene's index is 1; this one bends and has total reflection.
TEST(SeedBaseline, RendersCistulasPictureOfGlass) {
    SceneDescription description = benchmark_scene();
    for (MaterialDescription& material : description.materials)
        if (material.transmission > 0) material.index = 1.5;
    expect_same_picture<4>(description);
}

// The scene's lights are above everything; here there are faces behind one.
TEST(SeedBaseline, RendersCistulasPictureWithALightAmongTheSolids) {
    SceneDescription description = benchmark_scene();
    description.lights[0].position = {0, 0, 1};
    expect_same_picture<2>(description);
}

TEST(SeedBaseline, FramesAreRead) {
    const ScratchDirectory folder;
    const ColorPicture picture = by_the_baseline<2>(benchmark_scene());
    write_raw_picture(folder.file("frame.data"), picture);
    const ColorPicture read = read_raw_picture(folder.file("frame.data"));
    ASSERT_EQ(read.texels.size(), picture.texels.size());
    const Difference difference = compare(read, picture);
    EXPECT_EQ(difference.mean, 0);
    EXPECT_EQ(difference.within, 1);
}

TEST(SeedBaseline, RefusesWhatItDoesNotRender) {
    const auto refused = [](auto change) {
        SceneDescription description = benchmark_scene();
        change(description);
        try {
            seed::make_scene(description);
        } catch (const Error& error) {
            return error.kind() == ErrorKind::usage;
        }
        return false;
    };
    EXPECT_FALSE(refused([](SceneDescription&) {}));
    EXPECT_TRUE(refused([](SceneDescription& s) { s.materials[0].fresnel = true; }));
    EXPECT_TRUE(refused([](SceneDescription& s) { s.materials[0].tint = glm::dvec3(1, 0.5, 1); }));
    EXPECT_TRUE(refused([](SceneDescription& s) { s.materials[0].absorption = glm::dvec3(1); }));
    EXPECT_TRUE(refused([](SceneDescription& s) { s.lights[0].radius = 0.1; }));
    EXPECT_TRUE(refused([](SceneDescription& s) { s.textures[0].file = "floor.data"; }));
    EXPECT_TRUE(refused([](SceneDescription& s) { std::get<SolidObject>(s.objects[0].shape).edge_lights.count = 1; }));
}

}  // namespace
}  // namespace cistula
