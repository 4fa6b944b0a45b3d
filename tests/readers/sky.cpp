// Backgrounds that are gradients or pictures.
#include <gtest/gtest.h>

#include "render/record/film_picture.h"
#include "render/scene.h"
#include "sequence/backends.h"
#include "sequence/render_request.h"
#include "testing/support/read_text.h"

namespace cistula {
namespace {

using test::json_scene;
using test::scene_with;

SceneDescription with_background(const std::string& background) {
    return scene_with("\"background\": " + background);
}

TEST(Sky, GradientsAndPicturesAreRead) {
    const SceneDescription gradient =
        with_background(R"({"axis": [0, 2, 0], "stops": [[0, 1], [90, [1, 2, 3]], [90, 0], [180, 0.5]]})");
    ASSERT_TRUE(gradient.sky);
    EXPECT_EQ(gradient.background, glm::dvec3(0));
    EXPECT_EQ(gradient.sky->axis, glm::dvec3(0, 2, 0));
    ASSERT_EQ(gradient.sky->stops.size(), 4u);
    EXPECT_EQ(gradient.sky->stops[1].degrees, 90);
    EXPECT_EQ(gradient.sky->stops[1].color, glm::dvec3(1, 2, 3));
    EXPECT_TRUE(gradient.textures.empty());
    const SceneDescription picture = json_scene(R"({"objects": [], "textures": {"t": {"checker": [0, 1]}},
        "background": {"file": "sky.hdr", "rotate": [0, 0, 90], "scale": 2}})");
    ASSERT_TRUE(picture.sky);
    EXPECT_EQ(picture.sky->texture, 1);
    EXPECT_EQ(picture.sky->rotation, glm::dvec3(0, 0, 90));
    EXPECT_EQ(picture.sky->scale, 2);
    EXPECT_EQ(picture.textures[1].file, "sky.hdr");
    EXPECT_EQ(picture.textures[1].place, "/background");
    EXPECT_FALSE(with_background("[1, 2, 3]").sky);
}

TEST(Sky, ChangesOverTime) {
    const SceneDescription scene =
        with_background(R"({"stops": [[0, {"keys": [[0, 0], [10, 1]]}], [{"keys": [[0, 20], [10, 40]]}, 0.5]]})");
    EXPECT_EQ(at_frame(scene, 5).sky->stops[0].color, glm::dvec3(0.5));
    EXPECT_EQ(at_frame(scene, 5).sky->stops[1].degrees, 30);
    const SceneDescription picture =
        with_background(R"({"file": "sky.exr", "rotate": [0, 0, {"keys": [[0, 0], [10, 90]]}]})");
    const SceneDescription later = at_frame(picture, 10);
    EXPECT_EQ(later.sky->rotation, glm::dvec3(0, 0, 90));
    EXPECT_EQ(later.sky->texture, 0);
    EXPECT_EQ(later.textures.size(), 1u);
}

TEST(Sky, FaultsHaveTheirPlace) {
    EXPECT_WRONG(with_background(R"({"stops": []})"),
                 "a.json: /background/stops: expected an array of stops [degrees, color], found an empty array");
    EXPECT_WRONG(with_background(R"({"stops": [[0, 1], [190, 0]]})"),
                 "a.json: /background/stops/1/0: expected a number from 0 to 180, found 190");
    EXPECT_WRONG(
        with_background(R"({"stops": [[50, 1], [40, 0]]})"),
        "a.json: /background/stops/1/0: 40 degrees stand after 50; the angles of stops ascend; two of one angle "
        "are an edge");
    EXPECT_WRONG(with_background(R"({"stops": [[5, 1], [5, 0], [5, 2]]})"),
                 "a.json: /background/stops/2/0: a third stop at 5 degrees; two of one angle are an edge");
    EXPECT_WRONG(with_background(R"({"stops": [[5, 1, 2]]})"),
                 "a.json: /background/stops/0: expected a stop [degrees, color], found an array of 3");
    EXPECT_WRONG(with_background(R"({"axis": [0, 0, 0], "stops": [[0, 1]]})"),
                 "a.json: /background/axis: expected a direction other than [0, 0, 0]");
    EXPECT_WRONG(with_background(R"({"fil": "a.exr"})"), "a.json: /background/fil: unknown key; did you mean 'file'?");
    EXPECT_WRONG(
        with_background(R"({"file": "a.exr", "stops": [[0, 1]]})"),
        "a.json: /background: expected a color, or one of the keys 'stops' (a gradient) and 'file' (a picture)");
}

constexpr const char* cube_under_sky =
    R"({"film": {"width": 40, "height": 30, "supersample": 3}, "materials": {"m": {}},
    "objects": [{"solid": "cube", "material": "m", "rotate": [10, 20, 30]}], "ambient": 0.4,
    "background": {"axis": [1, 0, 1], "stops": [[0, [1, 0, 0.5]], [60, [0, 1, 0]], [60, 0.25], [180, 1]]}})";

LayeredPicture picture_of(const Scene& scene, const SceneDescription& description, const RenderRequest& request) {
    Film film;
    RenderProgress progress;
    make_renderer(Backend::embree, scene, {})
        ->render(camera_at(description.camera, 0), frame_settings(request, description), film, progress);
    return to_layers(film, request.channels);
}

/// Whatever is seen of a sky beside bodies, a transparent picture has the bodies alone; with a target error, too.
TEST(Sky, TransparentPicturesLeaveOutWhatIsSeenOfIt) {
    const SceneDescription description = json_scene(cube_under_sky);
    SceneDescription dark = description;
    dark.sky->stops = {{0, glm::dvec3(0)}};
    dark.frame = FrameOfReference{{0, 0, 0}, 0, 2.0};  // of the same units
    SceneDescription sky = description;
    sky.frame = dark.frame;
    for (const double target : {0.0, 0.01}) {
        RenderRequest request;
        request.frame.target_error = target;
        request.channels.transparent = true;
        const LayeredPicture seen = picture_of(Scene(sky), sky, request);
        const LayeredPicture alone = picture_of(Scene(dark), dark, request);
        size_t bare = 0;
        for (const auto& channel : seen.channels) {
            const LayeredPicture::Channel& other = *channel_of(alone, channel.name);
            for (size_t i = 0; i < channel.values.size(); ++i) {
                const float coverage = channel_of(seen, "A")->values[i];
                if (target == 0 || coverage == 0 || coverage == 1) {
                    EXPECT_EQ(channel.values[i], other.values[i]) << channel.name << ' ' << i;
                }
                bare += coverage == 0;
            }
        }
        EXPECT_GT(bare, 1000u);
    }
}

TEST(Sky, SaysOnceThatItLightsNothingWhereNothingElseDoes) {
    const auto lit_by = [](const std::string& lights) {
        SceneDescription description = json_scene(R"({"materials": {"m": {}}, "objects": [{"solid": "cube",
            "material": "m", "edge_lights": {"count": 1, "radius": 0.01, "color": 0}}], "background": {"stops": [[0, 1]]})" +
                                                  lights + "}");
        return Scene(description);
    };
    for (const char* lights : {"", R"(, "ambient": [0, 0, 0.1])",
                               R"(, "ambient": 0, "lights": [{"position": [0, 0, 9], "color": [0, 1, 0]}])"})
        EXPECT_TRUE(lit_by(lights).warnings().empty()) << lights;
    const Scene scene = lit_by(R"(, "ambient": 0, "lights": [{"position": [0, 0, 9], "color": 0, "radius": 0.1}])");
    ASSERT_EQ(scene.warnings().size(), 1u);
    EXPECT_EQ(scene.warnings()[0],
              "a.json: /background: it is seen, mirrored and refracted, but lights nothing; `ambient` "
              "and lights do");
}

}  // namespace
}  // namespace cistula
