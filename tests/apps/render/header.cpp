// Attributes of the header as other programs read them.
#include "render/record/frame_header.h"

#include <gtest/gtest.h>

#include <cmath>

#include "backend_embree/embree/embree_renderer.h"
#include "cistula/model/effects.h"
#include "image/exr/exr.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "scene/description/camera_path.h"
#include "scene/readers/read_scene.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

struct Point {
    double x, y, z, w;
};

/// p M, for row vectors.
Point times(const glm::dvec3& p, const std::vector<float>& m) {
    const auto column = [&](size_t c) { return p.x * m[c] + p.y * m[4 + c] + p.z * m[8 + c] + m[12 + c]; };
    return {column(0), column(1), column(2), column(3)};
}

/// A camera at (1, 2, 3) that looks along +y, with z up: +x is to the right in its picture.
CameraDescription camera_along_y(double fov) {
    CameraDescription camera;
    camera.position = {1, 2, 3};
    camera.target = {1, 12, 3};
    camera.up = {0, 0, 1};
    camera.field_of_view = fov;
    return camera;
}

/// The attributes of a picture with these channels.
Attributes attributes_of(const OutputChannels& channels) {
    Film film;
    film.full_width = film.full_height = film.rect.width = film.rect.height = 1;
    film.pixels.assign(1);
    return to_layers(film, channels).attributes;
}

TEST(Header, CameraSpaceIsLeftHandedWithZAhead) {
    const std::vector<float> matrix = world_to_camera(camera_at(camera_along_y(60), 0).camera);
    const auto expect = [&](const glm::dvec3& world, const glm::dvec3& camera) {
        const Point p = times(world, matrix);
        EXPECT_NEAR(p.x, camera.x, 1e-6);
        EXPECT_NEAR(p.y, camera.y, 1e-6);
        EXPECT_NEAR(p.z, camera.z, 1e-6);
        EXPECT_NEAR(p.w, 1, 1e-6);
    };
    expect({1, 2, 3}, {0, 0, 0});
    expect({1, 7, 3}, {0, 0, 5});  // ahead
    expect({3, 2, 3}, {2, 0, 0});  // right
    expect({1, 2, 7}, {0, 4, 0});  // up
    expect({0, 12, 2}, {-1, -1, 10});
}

TEST(Header, NdcIsZeroAtTheUpperLeftAndOneAtTheLowerRight) {
    const double fov = 90;  // half as wide as far away
    const std::vector<float> matrix = world_to_ndc(camera_at(camera_along_y(fov), 0).camera, 200, 100);
    const auto expect = [&](const glm::dvec3& world, double x, double y, double distance) {
        const Point p = times(world, matrix);
        EXPECT_NEAR(p.w, distance, 1e-5);
        EXPECT_NEAR(p.x / p.w, x, 1e-6);
        EXPECT_NEAR(p.y / p.w, y, 1e-6);
    };
    expect({1, 12, 3}, 0.5, 0.5, 10);
    expect({1 - 10, 12, 3 + 5}, 0, 0, 10);
    expect({1 + 10, 12, 3 - 5}, 1, 1, 10);
    expect({1 + 4, 6, 3 + 2}, 1, 0, 4);
    expect({1 + 1, 4, 3}, 0.75, 0.5, 2);
}

/// With a target error, too, another program writes the file that render writes.
TEST_F(RenderProgram, FilesOfOtherProgramsHaveItsHeader) {
    expect_done({"s.json", "-q", "-o", "a.exr", "--target-error", "0.05", "--frames", "1", "--precision", "float"});
    const SceneDescription scene = read_scene(file("s.json"));
    const std::shared_ptr<const CompiledScene<float>> compiled = compile_scene<float>(scene);
    FrameSettings settings = frame_settings(scene);
    settings.target_error = 0.05;
    settings.depth = 1024;
    const CameraFrame camera = camera_at(scene.camera, 1);
    Film film;
    RenderProgress progress;
    ASSERT_TRUE(make_embree_renderer<float>(compiled)->render(camera, settings, film, progress));
    LayeredPicture picture = to_layers(film, {});
    picture.attributes.merge(
        header_attributes(film, scene.film, compiled->hashes, settings, Precision::single_, camera));
    ASSERT_EQ(picture.attributes.count("cistula:checkedPixels"), 1u);
    write_exr(file("b.exr"), picture);
    EXPECT_EQ(bytes_of(file("a.exr")), bytes_of(file("b.exr")));
}

TEST(Header, ScreenWindowIsThatOfTheFieldOfView) {
    const Attributes attributes =
        header_attributes(FrameHashes("abc"), FrameSettings(), Precision::single_, camera_at(camera_along_y(60), 7));
    EXPECT_NEAR(std::get<double>(attributes.at("screenWindowWidth")), 2 * std::tan(M_PI / 6), 1e-7);
    EXPECT_EQ(std::get<int>(attributes.at("imageCounter")), 7);
}

TEST(Header, WhatTheFilmDoesNotSayIsNotThere) {
    Attributes attributes;
    FilmDescription film;
    add_film_attributes(film, attributes);
    EXPECT_TRUE(attributes.empty());
    film.rate = 24000;
    film.rate_divisor = 1001;
    film.owner = "A. Owner";
    film.comments = "first take";
    add_film_attributes(film, attributes);
    EXPECT_EQ(attributes, (Attributes{{"framesPerSecond", Ratio{24000, 1001}},
                                      {"owner", std::string("A. Owner")},
                                      {"comments", std::string("first take")}}));
}

TEST(Header, ColorsAreNamedAsOtherProgramsKnowThem) {
    OutputChannels channels;
    EXPECT_EQ(attributes_of(channels),
              (Attributes{{"chromaticities", std::vector<float>{.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f}},
                          {"colorInteropID", std::string("lin_rec709_scene")}}));
    channels.space = find_color_space("lin_ap0_scene");
    channels.half = true;
    Attributes attributes = attributes_of(channels);
    EXPECT_EQ(std::get<std::string>(attributes.at("colorInteropID")), "lin_ap0_scene");
    EXPECT_EQ(std::get<std::vector<float>>(attributes.at("chromaticities"))[5], -0.077f);
    EXPECT_EQ(attributes.count("acesImageContainerFlag"), 0u);  // compressed
    channels.compression = Compression::none;
    attributes = attributes_of(channels);
    EXPECT_EQ(std::get<int>(attributes.at("acesImageContainerFlag")), 1);
}

TEST(Header, WhatChangesPixelsIsThere) {
    OutputChannels channels;
    channels.transparent = channels.z = true;
    channels.z_far = 1000;
    const Attributes attributes = attributes_of(channels);
    EXPECT_EQ(std::get<std::string>(attributes.at("cistula:background")), "transparent");
    EXPECT_EQ(std::get<double>(attributes.at("cistula:zFar")), 1000);
}

TEST(HeaderAttributes, MatricesTakePointsWhereTheCameraSeesThem) {
    CameraDescription description;
    description.position = {3, -5, 2};
    description.target = {0.5, 1, 0.25};
    description.field_of_view = 70;
    const Camera camera = camera_at(description, 0).camera;
    const auto transformed = [](const std::vector<float>& m, const Vec3<double>& p) {
        std::array<double, 4> q{};
        for (size_t c = 0; c < 4; ++c) q[c] = p.x * m[c] + p.y * m[4 + c] + p.z * m[8 + c] + m[12 + c];
        return q;
    };
    const int width = 320, height = 180;
    for (const double x : {0.5, 100.0, 319.5})
        for (const double y : {0.5, 90.0, 150.25})
            for (const double distance : {0.25, 6.0}) {
                const Vec3<double> direction = camera_direction(camera, x, y, width, height);
                const Vec3<double> point = camera.position + distance * direction;
                const double depth = distance * dot(direction, camera.forward);
                const auto ndc = transformed(world_to_ndc(camera, width, height), point);
                EXPECT_NEAR(ndc[3], depth, 1e-5);
                EXPECT_NEAR(ndc[0] / ndc[3], x / width, 2e-5);
                EXPECT_NEAR(ndc[1] / ndc[3], y / height, 2e-5);
                EXPECT_NEAR(ndc[2] / ndc[3], 1 - 1 / depth, 2e-5);
                const auto seen = transformed(world_to_camera(camera), point);
                EXPECT_NEAR(seen[0], distance * dot(direction, camera.right), 1e-5);
                EXPECT_NEAR(seen[1], distance * dot(direction, camera.up), 1e-5);
                EXPECT_NEAR(seen[2], depth, 1e-5);
                EXPECT_EQ(seen[3], 1);
            }
}

TEST(HeaderAttributes, TellImagesApart) {
    FrameSettings settings;
    CameraFrame camera;
    camera.camera.position = {0, 0, 0};
    camera.camera.forward = {0, 1, 0};
    camera.camera.right = {1, 0, 0};
    camera.camera.up = {0, 0, 1};
    LayeredPicture picture;
    picture.width = picture.display_width = 4;
    picture.height = picture.display_height = 2;
    picture.channels = {{"R", false, {}}, {"G", false, {}}};
    picture.attributes = header_attributes(FrameHashes("abc"), settings, Precision::single_, camera);
    EXPECT_TRUE(is_same_image(picture, picture));
    const auto differs = [&](const std::function<void(LayeredPicture&)>& change) {
        LayeredPicture other = picture;
        change(other);
        return !is_same_image(other, picture);
    };
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.x = 1; }));
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.display_width = 5; }));
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.channels[0].half = true; }));
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.channels.pop_back(); }));
    EXPECT_TRUE(differs([](LayeredPicture& p) { p.compression = Compression::dwaa; }));
    EXPECT_FALSE(differs([](LayeredPicture& p) { std::swap(p.channels[0], p.channels[1]); }));
    const auto attributes_differ = [&](const Attributes& attributes) {
        return differs([&](LayeredPicture& p) { p.attributes = attributes; });
    };
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abd"), settings, Precision::single_, camera)));
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), settings, Precision::double_, camera)));
    FrameSettings other = settings;
    other.cutoff = 1e-9;
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), other, Precision::single_, camera)));
    other = settings;
    other.depth = 5;
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), other, Precision::single_, camera)));
    other = settings;
    other.supersample = 2;
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), other, Precision::single_, camera)));
    other = settings;
    other.target_error = 0.01;
    const Attributes target = header_attributes(FrameHashes("abc"), other, Precision::single_, camera);
    EXPECT_TRUE(attributes_differ(target));
    EXPECT_EQ(std::get<double>(target.at("cistula:targetError")), 0.01);
    EXPECT_EQ(std::get<double>(target.at("cistula:cutoff")), 0.0025);
    other.max_samples = 32;
    EXPECT_EQ(std::get<int>(
                  header_attributes(FrameHashes("abc"), other, Precision::single_, camera).at("cistula:maxSamples")),
              32);
    EXPECT_EQ(picture.attributes.count("cistula:targetError") + picture.attributes.count("cistula:maxSamples"), 0u);
    CameraFrame moved = camera;
    moved.frame = 1;
    EXPECT_TRUE(attributes_differ(header_attributes(FrameHashes("abc"), settings, Precision::single_, moved)));
    // What does not reach the image does not reach the header.
    other = settings;
    other.tile = 64;
    other.effects = all_effects;
    EXPECT_FALSE(attributes_differ(header_attributes(FrameHashes("abc"), other, Precision::single_, camera)));
}

}  // namespace
}  // namespace cistula
