// Lines from the camera meet seen lights only where their images are, straight on or mirrored once.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "cistula/bvh.h"
#include "scene/frame_contents.h"
#include "scene/frame_view.h"
#include "scene/generated_scene.h"
#include "scene/mirror_planes.h"
#include "scene/read_scene.h"
#include "scene/shadow_plan.h"
#include "scene/without_effect.h"
#include "support_camera.h"
#include "support_scene.h"

using namespace cistula;

namespace {

const std::string source = CISTULA_SOURCE_DIR;

bool holds(const PixelRect& rect, int x, int y) {
    return x >= rect.x && x < rect.x + rect.width && y >= rect.y && y < rect.y + rect.height;
}

FrameSettings small_frame() {
    FrameSettings settings;
    settings.set_size(64, 36);
    settings.crop = {5, 3, 51, 30};
    settings.depth = 4;
    return settings;
}

template <class Real, class E, class Intersector>
PixelRecord rendered(const typename Intersector::Scene& scene, const FrameView& frame, const Intersector& intersector,
                     int x, int y) {
    PixelRecord record;
    PixelWork work;
    StackOf<Real, E, typename Intersector::Media> stack;
    render_pixel<Real, E>(scene, frame, intersector, x, y, SampleRange(), record, work, stack);
    return record;
}

template <class Real>
LightImages images_of(const SceneDescription& description) {
    const auto scene = compile_scene<Real>(description);
    FrameSettings settings;
    settings.set_size(40, 30);
    return frame_contents(*scene, frame_view(*scene, camera_at(description.camera, 0), settings), settings).lights;
}

/// Benchmark.json among few lights and many.
std::vector<SceneDescription> lit_benchmarks() {
    SceneDescription edges = read_scene(source + "/scenes/benchmark.json");
    test::add_edge_lights(edges, 3);
    SceneDescription more = edges;
    test::add_seen_lights(more, 30);
    return {edges, more};
}

template <class Real>
class LightsIn : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(LightsIn, Reals);

constexpr uint64_t straight_bit = uint64_t{1} << MirrorNumbers::straight;

/// Looks for lights nowhere on the lines from the camera.
template <class Real>
struct Unlit : BvhIntersector<Real> {
    static constexpr LitCell dark{~straight_bit};
    ShownLights shown{&dark};
};

TYPED_TEST(LightsIn, ThePictureShowWhereTheirImagesAre) {
    test::Random random(20);
    size_t apart = 0, elsewhere = 0, wrong = 0, all = 0;
    const auto check = [&](const SceneDescription& description) {
        const auto scene = compile_scene<TypeParam>(description);
        build_primitive_tree(*scene);
        const SceneView<TypeParam> view = scene->view();
        const BvhIntersector<TypeParam> whole{view};
        const Unlit<TypeParam> unlit{{view}};
        const FrameSettings settings = small_frame();
        for (int i = 0; i < 6; ++i) {
            const CameraDescription camera =
                i == 0 ? description.camera : test::random_camera(random, description.camera);
            FrameView frame = frame_view(*scene, camera_at(camera, 0), settings);
            camera_solids(view, whole, frame.camera.position, frame.camera_media);
            const LightImages lights = frame_contents(*scene, frame, settings).lights;
            for (int y = 0; y < settings.crop.height; ++y)
                for (int x = 0; x < settings.crop.width; ++x) {
                    using E = Effects<all_effects>;
                    const int px = settings.crop.x + x, py = settings.crop.y + y;
                    const bool differs = !test::same_bytes(rendered<TypeParam, E>(view, frame, whole, px, py),
                                                           rendered<TypeParam, E>(view, frame, unlit, px, py));
                    const bool told = std::ranges::any_of(lights.images(), [&](const LightImage& image) {
                        return image.mirror == MirrorNumbers::straight && holds(image.rect, x, y);
                    });
                    ++all;
                    apart += differs;
                    elsewhere += !told;
                    wrong += differs && !told;
                }
        }
    };
    for (const SceneDescription& lamps : lit_benchmarks()) check(lamps);
    for (uint64_t seed = 0; seed < generated_scene_count; seed += 8) check(generated_scene(seed, source + "/scenes"));
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(apart, all / 200);
    EXPECT_GT(elsewhere, all / 2);
}

/// What a mask whose lines go on straight renders.
SceneDescription straight(SceneDescription description) {
    for (const uint32_t effect : {effect_refraction, effect_fresnel, effect_absorption, effect_light_falloff})
        if (auto without = without_effect(description, Effect(effect))) description = *without;
    return description;
}

TYPED_TEST(LightsIn, MirrorsShowWhereTheirImagesAre) {
    using E = Effects<clear_bodies | effect_visible_lights | effect_tint | effect_lights_on_faces>;
    using Loop = BruteIntersector<TypeParam, OneMedium, SmallScene<TypeParam>>;
    test::Random random(21);
    const LitCell unmirrored{straight_bit};
    size_t apart = 0, told = 0, listed = 0, asked = 0, wrong = 0, all = 0, scenes = 0;
    const auto check = [&](const SceneDescription& description, const std::string& what) {
        const auto scene = compile_scene<TypeParam>(description);
        const auto small = small_scene(scene->view());
        if (!small || (scene->effects & ~E::mask) != 0) return;
        const FrameSettings settings = small_frame();
        const size_t faces = mirror_planes(scene->view()).size();
        for (int i = 0; i < 8; ++i) {
            const CameraDescription camera =
                i == 0 ? description.camera : test::random_camera(random, description.camera);
            FrameView frame = frame_view(*scene, camera_at(camera, 0), settings);
            Loop whole{*small}, none{*small}, some{*small};
            camera_solids(*small, whole, frame.camera.position, frame.camera_media);
            const LightImages lights = frame_contents(*scene, frame, settings).lights;
            if (!lights.knows_mirrors()) continue;
            scenes += i == 0;
            none.shown.cell = &unmirrored;
            const LitCells cells(lights, 1, 1);
            for (int y = 0; y < settings.crop.height; ++y)
                for (int x = 0; x < settings.crop.width; ++x) {
                    some.shown = cells.at(x, y);
                    const int px = settings.crop.x + x, py = settings.crop.y + y;
                    const PixelRecord right = rendered<TypeParam, E>(*small, frame, whole, px, py);
                    const bool is_wrong = !test::same_bytes(right, rendered<TypeParam, E>(*small, frame, some, px, py));
                    EXPECT_TRUE(!is_wrong || wrong != 0)
                        << what << ", camera " << i << ", pixel " << px << ", " << py;  // the first
                    wrong += is_wrong;
                    apart += !test::same_bytes(right, rendered<TypeParam, E>(*small, frame, none, px, py));
                    told += size_t(std::popcount(some.shown.cell->mirrors & ~unmirrored.mirrors));
                    listed += some.shown.cell->count;
                    asked += faces;
                    ++all;
                }
        }
    };
    for (const SceneDescription& lamps : lit_benchmarks()) check(lamps, "benchmark");
    for (uint64_t seed = 0; seed < generated_scene_count; ++seed) {
        SceneDescription description = straight(generated_scene(seed, source + "/scenes"));
        description.frame.reset();  // it might hold no more lights
        test::add_edge_lights(description, 2);
        test::add_seen_lights(description, 20);
        check(description, "seed " + std::to_string(seed));
    }
    SceneDescription many = lit_benchmarks().back();
    test::add_seen_lights(many, 70);  // of more hulls than are outlined
    check(many, "many lights");
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(scenes, 20u);
    EXPECT_GT(apart, all / 200);
    EXPECT_LT(told, asked / 8);
    EXPECT_GT(listed, told / 2);
}

/// Lines leave a triangle toward a point above its middle: in float an eighth of the way to it where that lies some u M
/// high.
TEST(LightsInSlivers, ShowWhereTheLinesThatTheySendBackStart) {
    SceneDescription description = read_scene(source + "/scenes/benchmark.json");
    constexpr double width = 1e-5;
    ObjectDescription sliver = description.objects.back();
    sliver.shape = TrianglesObject{{{0, -width, 0}, {6, 0, 0}, {0, width, 0}}, {{0, 1, 2}}, {}};
    description.objects = {sliver};
    description.textures.clear();
    for (MaterialDescription& material : description.materials) material.texture = -1;
    description.lights.clear();
    LightDescription light;
    light.position = {0.51, 0, 3};  // over where lines start that meet the sliver at 0.3
    light.color = glm::dvec3{0};
    light.glow = glm::dvec3{1};
    light.radius = 0.1;
    description.lights = {light};
    description.camera = CameraDescription();
    description.camera.position = {0.3, 0, 5};
    description.camera.target = {0.3, 0, 0};
    description.camera.up = {0, 1, 0};
    description.camera.field_of_view = 4e-4;
    const auto scene = compile_scene<float>(description);
    const auto small = small_scene(scene->view());
    ASSERT_TRUE(small);
    FrameSettings settings = small_frame();
    const FrameView frame = frame_view(*scene, camera_at(description.camera, 0), settings);
    const LightImages lights = frame_contents(*scene, frame, settings).lights;
    ASSERT_TRUE(lights.knows_mirrors());
    using E = Effects<clear_bodies | effect_visible_lights>;
    BruteIntersector<float, OneMedium, SmallScene<float>> loop{*small};
    const LitCell dark{0};
    size_t met = 0;
    for (int y = settings.crop.y; y < settings.crop.y + settings.crop.height; ++y) {
        const int x = settings.crop.x + 20;
        loop.shown.cell = nullptr;
        const PixelRecord whole = rendered<float, E>(*small, frame, loop, x, y);
        loop.shown.cell = &dark;
        if (test::same_bytes(whole, rendered<float, E>(*small, frame, loop, x, y))) continue;
        ++met;
        EXPECT_TRUE(std::ranges::any_of(lights.images(), [&](const LightImage& image) {
            return image.mirror != MirrorNumbers::straight &&
                   holds(image.rect, x - settings.crop.x, y - settings.crop.y);
        })) << y;
    }
    EXPECT_GT(met, 5u);
}

TYPED_TEST(LightsIn, AThousandAndMoreMayShowAnywhere) {
    SceneDescription description = read_scene(source + "/scenes/benchmark.json");
    test::add_seen_lights(description, 1100);
    const LightImages lights = images_of<TypeParam>(description);
    const std::vector<LightImage> anywhere = {{{0, 0, 40, 30}, MirrorNumbers::straight}};
    EXPECT_EQ(lights.images(), anywhere);
    EXPECT_FALSE(lights.knows_mirrors());
}

/// As many as fill the picture more than so often.
TYPED_TEST(LightsIn, ImagesOverImagesAreOneOfAnyLight) {
    SceneDescription description = read_scene(source + "/scenes/benchmark.json");
    description.camera = CameraDescription();
    description.camera.position = {4, 4, 3};
    description.camera.target = {0, 0, 2};
    LightDescription around;  // the camera
    around.position = description.camera.position;
    around.color = glm::dvec3{0};
    around.glow = glm::dvec3{1};
    around.radius = 0.5;
    const auto images_of_so_many = [&](size_t count) {
        description.lights.assign(count, around);
        std::vector<LightImage> straight;
        const LightImages lights = images_of<TypeParam>(description);
        for (const LightImage& image : lights.images())
            if (image.mirror == MirrorNumbers::straight) straight.push_back(image);
        return straight;
    };
    EXPECT_EQ(images_of_so_many(16).size(), 16u);
    EXPECT_EQ(images_of_so_many(16).back().light, 15u);
    const std::vector<LightImage> any = {{{0, 0, 40, 30}, MirrorNumbers::straight, LightImage::any}};
    EXPECT_EQ(images_of_so_many(17), any);
}

/// Few images and many, of any size.
TEST(LitCells, ListWhatTheirImagesShow) {
    test::Random random(23);
    const PixelRect rect{9, 4, 150, 71};
    size_t listed = 0, unlisted = 0, dark = 0;
    for (const int count : {1, 30, 300})
        for (const auto& [width, height] : {std::pair{8, 4}, {8, 8}, {1, 1}}) {
            LightImages images(rect);
            images.know_mirrors();
            const auto whole = [&](int most) { return std::min(int(random.unit() * most), most - 1); };
            for (int i = 0; i < count; ++i) {
                const int x = whole(rect.width), y = whole(rect.height);
                const uint32_t mirror = uint32_t(whole(MirrorNumbers::most + 1));
                images.add({{x, y, 1 + whole(std::min(20, rect.width - x)), 1 + whole(std::min(20, rect.height - y))},
                            mirror,
                            mirror % 5 == 0 && i % 3 == 0 ? LightImage::any : uint32_t(whole(ShownLight::most))});
            }
            const LitCells cells(images, width, height);
            for (int row = 0; row * height < rect.height; ++row)
                for (int column = 0; column * width < rect.width; ++column) {
                    const ShownLights shown = cells.at(column, row);
                    for (uint32_t mirror = 0; mirror <= MirrorNumbers::straight; ++mirror) {
                        std::vector<uint32_t> expected;
                        bool is_any = false, is_lit = false;
                        for (const LightImage& image : images.images()) {
                            if (image.mirror != mirror) continue;
                            is_any |= image.light == LightImage::any;
                            const bool meets = image.rect.x < (column + 1) * width &&
                                               image.rect.x + image.rect.width > column * width &&
                                               image.rect.y < (row + 1) * height &&
                                               image.rect.y + image.rect.height > row * height;
                            if (!meets) continue;
                            is_lit = true;
                            expected.push_back(image.light);
                        }
                        EXPECT_EQ(shown.cell->is_dark(mirror), !is_lit);
                        const std::vector<uint32_t> known = test::listed_in(shown, mirror);
                        if (is_any || shown.cell->count == 0)
                            EXPECT_TRUE(known.empty());
                        else
                            EXPECT_EQ(known, expected);
                        ++(!is_lit ? dark : known.empty() ? unlisted : listed);
                    }
                }
        }
    EXPECT_GT(listed, 10000u);
    EXPECT_GT(unlisted, 1000u);
    EXPECT_GT(dark, listed);
}

TYPED_TEST(LightsIn, MirrorsAreKnownWhereTheyAreAskedFor) {
    SceneDescription description = read_scene(source + "/scenes/benchmark.json");
    EXPECT_FALSE(images_of<TypeParam>(description).knows_mirrors());  // no lights
    test::add_edge_lights(description, 2);
    EXPECT_TRUE(images_of<TypeParam>(description).knows_mirrors());
    EXPECT_FALSE(images_of<TypeParam>(*without_effect(description, effect_reflection)).knows_mirrors());
    EXPECT_FALSE(images_of<TypeParam>(read_scene(source + "/scenes/glass.json")).knows_mirrors());
}

/// A mirror on one face of which the camera lies sends lines back from either side, for all that rounding tells.
TYPED_TEST(LightsIn, MirrorsWhoseSideIsInDoubtShowAnywhere) {
    SceneDescription description = read_scene(source + "/scenes/benchmark.json");
    test::add_edge_lights(description, 2);
    description.camera = CameraDescription();
    description.camera.position = {4, 4, 0};  // on the floor, which is two triangles
    description.camera.target = {0, 0, 2};
    const LightImages lights = images_of<TypeParam>(description);
    EXPECT_EQ(std::ranges::count_if(
                  lights.images(),
                  [](const LightImage& image) {
                      return image.mirror != MirrorNumbers::straight && image.rect == PixelRect{0, 0, 40, 30};
                  }),
              2);
}

TEST(LightView, HasNoImageFarBesideThePicture) {
    const FrameView frame = test::frame_from({0, 0, 0}, 1e-6, 20000, 10000);
    const LightView view(frame, frame.camera, {100, 50, 400, 300}, {0, 0, 400, 300});
    for (const double side : {-1.0, 1.0}) {  // by more pixels than integers count
        EXPECT_EQ(view.image_of({side, 0, -1e-4}, 1e-6), PixelRect());
        EXPECT_EQ(view.image_of({0, side, -1e-4}, 1e-6), PixelRect());
    }
    EXPECT_EQ(view.image_of({0, 0, 1}, 1e-3), PixelRect());                   // behind
    EXPECT_EQ(view.image_of({0, 0, -1}, 1e-3), (PixelRect{0, 0, 400, 300}));  // larger than the picture
}

/// All around the eye, balls near it and far: each pixel whose line meets one is in its image, and few others are.
TEST(LightView, ImagesAreTightAroundBalls) {
    const FrameView frame = test::frame_from({0, 0, 0}, 2, 200, 120);
    const PixelRect rect{0, 0, 200, 120}, window{30, 20, 140, 70};
    const LightView view(frame, frame.camera, rect, window);
    test::Random random(22);
    size_t met = 0, images = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3<double> center = random.in_cube(1);
        const double radius = 0.4 * random.unit() * random.unit();
        const PixelRect image = view.image_of(center, radius);
        images += size_t(image.width) * size_t(image.height);
        for (int y = window.y; y < window.y + window.height; ++y)
            for (int x = window.x; x < window.x + window.width; ++x) {
                const Vec3<double> direction =
                    camera_direction(frame.camera, x + 0.5, y + 0.5, frame.width, frame.height);
                const double ahead = dot(center, direction);
                const bool meets = dot(center, center) < radius * radius ||
                                   (ahead > 0 && dot(center, center) - ahead * ahead < radius * radius);
                EXPECT_TRUE(!meets || holds(image, x, y)) << i << ": " << x << ", " << y;
                met += meets;
            }
    }
    EXPECT_GT(met, images / 2);
}

}  // namespace
