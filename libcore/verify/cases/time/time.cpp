// Values that change over time: what lies at and between keys, and what stays as it is meanwhile.
#include "scene/readers/read_scene.h"
#include "verify/cases/writing.h"

namespace cistula::verify {
namespace time {
namespace {

/// A scene of JSON whose first object moves, as a frame has it.
SceneDescription scene_at(const std::string& moving, int frame, const std::string& more = "") {
    const std::string text =
        R"({"film": {"width": 24, "height": 18}, "camera": {"position": [0, 0, 10], "up": [0, 1, 0],
        "fov": 40}, "materials": {"plain": {}, "mirror": {"reflection": 0.5}}, "objects": [)" +
        moving + more + "]}";
    return at_frame(read_scene_text(text, "verify", ""), frame);
}

/// A quad before the camera, its height by these keys.
std::string quad_with(const std::string& interpolation) {
    std::string text;
    for (const char* corner : {"-9, -9", "9, -9", "9, 9", "-9, 9"})
        text += std::string(text.empty() ? "" : ", ") + "[" + corner +
                R"(, {"keys": [[0, 0], [4, 1], [8, 4], [16, -2]], "interpolation": ")" + interpolation + "\"}]";
    return R"({"quad": [)" + text + R"(], "material": "plain"})";
}
double height_of(const std::string& interpolation, int frame) {
    constexpr double at[] = {0, 4, 8, 16};
    constexpr double height[] = {0, 1, 4, -2};
    const int i = frame < 4 ? 0 : frame < 8 ? 1 : 2;
    const double length = at[i + 1] - at[i];
    const double s = (frame - at[i]) / length;
    if (interpolation == "step") return frame == 16 ? height[3] : height[i];
    if (interpolation == "linear") return height[i] * (1 - s) + height[i + 1] * s;
    const auto change = [&](int k) {
        const int a = std::max(k - 1, 0);
        const int b = std::min(k + 1, 3);
        return (height[b] - height[a]) / (at[b] - at[a]);
    };
    // Hermite's basis, as textbooks have it.
    const double s2 = s * s;
    const double s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * height[i] + (s3 - 2 * s2 + s) * length * change(i) +
           (3 * s2 - 2 * s3) * height[i + 1] + (s3 - s2) * length * change(i + 1);
}

/// The depths of a quad that rises and sinks.
void depth(Stage& stage, Tally& tally) {
    for (const std::string interpolation : {"linear", "step", "smooth"})
        for (int frame = 0; frame <= 16; ++frame) {
            const Film film = stage.film(scene_at(quad_with(interpolation), frame));
            for (size_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
                tally.place = place_of(0, uint64_t(frame), pixel);
                tally.measure(magnitude(double(film.pixels[pixel].z) - (10 - height_of(interpolation, frame))));
            }
        }
}

constexpr const char* still_bodies = R"(, {"solid": "dodecahedron", "material": "mirror", "rotate": [10, 20, 30]},
    {"quad": [[-9, -9, -2], [9, -9, -2], [9, 9, -2], [-9, 9, -2]], "material": "plain"})";

/// A body that flies about behind the camera, where nothing shows it: in double so far off that rounding of what is
/// seen would show in a picture.
std::string unseen(const Stage& stage) {
    const std::string zeros = stage.in_double() ? "00000000" : "";
    return R"({"solid": "cube", "material": "plain", "center": {"keys": [[0, [0, 0, 30)" + zeros + "]], [5, [7" +
           zeros + ", 1" + zeros + ", 90" + zeros + "]], [9, [-3" + zeros + ", 40" + zeros + ", 31" + zeros +
           R"(]]], "interpolation": "smooth"}, "rotate": {"keys": [[0, [0, 0, 0]], [9, [100, 200, 300]]]}})";
}

/// What stands still while a body moves that is not seen: the same bits in all frames.
Render at_rest(bool in_one_frame) {
    return [=](Stage& stage, Tally& tally) {
        Film first;
        for (int frame = 0; frame < 10; ++frame) {
            SceneDescription scene = scene_at(unseen(stage), frame, still_bodies);
            if (!in_one_frame) scene.motion = nullptr;
            const Film film = stage.film(scene);
            if (frame == 0)
                first = film;
            else
                expect_same(tally, film, first, 0, uint64_t(frame));
        }
    };
}

/// A body that turns: after a whole turn, and two back, the same bits.
void turns_close(Stage& stage, Tally& tally) {
    const std::string turning = R"({"solid": "cube", "material": "mirror",
        "rotate": {"keys": [[0, [0, 0, 0]], [12, [360, 0, 360]], [36, [360, -720, 360]]]}})";
    const Film first = stage.film(scene_at(turning, 0, still_bodies));
    for (const int frame : {12, 24, 36})
        expect_same(tally, stage.film(scene_at(turning, frame, still_bodies)), first, 0, uint64_t(frame));
}

}  // namespace
}  // namespace time

void add_time(Cases& cases) {
    using namespace time;
    // A depth of 12 or less: 64 u M of an extent of 9, and the step of float's z.
    cases.images("depth", "keys, straight lines and Hermite's cubics between them", at_most(0x1p-16, 0x1p-20, "of 1"),
                 depth);
    cases.images("at-rest", "what does not move has the same bits in all frames", no_failures("pixels"), at_rest(true));
    cases.images("turns", "whole turns are none, bit by bit", no_failures("pixels"), turns_close);
    cases.images("broken/own-frames", "what does not move has the same bits in all frames", must_fail(10, "pixels"),
                 at_rest(false));
}

}  // namespace cistula::verify
