// Skies: gradients and pictures, seen, mirrored and through glass, against closed forms and integrals.
#include "image/reader/picture_reader.h"
#include "verify/cases/writing.h"

namespace cistula::verify {
namespace sky {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;
const dvec3 axis = {0.48, -0.6, 0.64};

/// A scene without light in which only a sky is seen, from a place inside of it, or from far away.
SceneDescription scene_under(const SkyDescription& sky, bool far = false) {
    SceneDescription scene = empty_scene();
    scene.film.width = 48, scene.film.height = 36;
    scene.ambient = dvec3(0);
    scene.sky = sky;
    scene.camera.position = dvec3(0.1, -0.2, 0.3) * (far ? 1000.0 : 1.0);
    scene.camera.target = scene.camera.position + dvec3(0.3, 1, 0.2);
    scene.camera.field_of_view = 120;
    add_object(scene, solid_object(PlatonicSolid::octahedron, {0, -40, 0}, 2));
    return scene;
}

/// Colors of the whole range of angles, with an edge at 70 degrees.
SkyDescription gradient() {
    return {.axis = 3.0 * axis,
            .stops = {{0, {1, 0.25, 0}}, {30, {0.5, 0.75, 0}}, {70, {0, 1, 0.5}}, {70, {1, 0, 0}}, {180, {0, 0.5, 1}}}};
}
dvec3 color_of(const SkyDescription& sky, const dvec3& direction) {
    const double cosine = dot(normalized(sky.axis), direction);
    for (size_t i = 1; i < sky.stops.size(); ++i) {
        const double low = std::cos(sky.stops[i].degrees * degree);
        const double high = std::cos(sky.stops[i - 1].degrees * degree);
        if (cosine < low && i + 1 < sky.stops.size()) continue;
        return sky.stops[i - 1].color +
               (sky.stops[i].color - sky.stops[i - 1].color) * ((high - cosine) / (high - low));
    }
    return sky.stops.back().color;
}
/// The color, were it linear in the angle.
dvec3 wrong_color_of(const SkyDescription& sky, const dvec3& direction) {
    const double angle = std::acos(dot(normalized(sky.axis), direction)) / degree;
    for (size_t i = 1; i < sky.stops.size(); ++i) {
        const SkyColor &a = sky.stops[i - 1], &b = sky.stops[i];
        if (angle <= b.degrees) return a.color + (b.color - a.color) * ((angle - a.degrees) / (b.degrees - a.degrees));
    }
    return sky.stops.back().color;
}

/// A picture whose red goes linearly along its rows, whose green goes down its columns, both texel by texel.
SceneDescription under_picture(const dvec3& rotation, bool far = false) {
    constexpr uint32_t width = 64;
    constexpr uint32_t height = 32;
    const auto texels = std::make_shared<TexelArray>();
    texels->width = width, texels->height = height;
    std::vector<float> values;
    for (uint32_t row = 0; row < height; ++row)
        for (uint32_t column = 0; column < width; ++column) {
            values.push_back((float(column) + 0.5f) / width);
            values.push_back((float(row) + 0.5f) / height);
            values.push_back(0.5f);
        }
    texels->values = std::move(values);
    SkyDescription sky;
    sky.texture = 0;
    sky.rotation = rotation;
    sky.scale = 0.75;
    SceneDescription scene = scene_under(sky, far);
    scene.textures.emplace_back();
    scene.textures.back().texels = texels;
    scene.textures.back().wrap[1] = TextureWrap::clamp;
    return scene;
}
/// Its color in a direction; none at the seam and beside the poles, where texels do not go on linearly.
std::optional<dvec3> color_of_picture(const SkyDescription& sky, const dvec3& direction) {
    const Rotation rotation(sky.rotation);
    const dvec3 d(dot(rotation({1, 0, 0}), direction), dot(rotation({0, 1, 0}), direction),
                  dot(rotation({0, 0, 1}), direction));
    const double u = 0.5 - std::atan2(d.y, d.x) / (360 * degree);
    const double v = std::acos(d.z) / (180 * degree);
    if (u < 1.0 / 128 || u > 1 - 1.0 / 128 || v < 1.0 / 64 || v > 1 - 1.0 / 64) return std::nullopt;
    return dvec3(u, v, 0.5) * sky.scale;
}

// A direction in Real is off by 2 u, its cosine too; the steepest stop here changes by 1 in 0.13. At the edge a pixel
// may lie on either side if its cosine is that near. Near a pole's limb the longitude changes by 20 a unit.
const Bound bound_of_color = at_most(0x1p-18, 0x1p-46, "of 1");

template <class Expected>
void measure(Tally& tally, const Film& film, const SceneDescription& scene, uint64_t place, const Expected& expected) {
    for_each_view(film, scene, [&](size_t pixel, const dvec3& direction) {
        const std::optional<dvec3> color = expected(direction);
        if (!color) return;
        tally.place = place + pixel;
        for (int c = 0; c < 3; ++c) tally.measure(magnitude(radiance(film, pixel, c) - (*color)[c]));
    });
}

using Color = dvec3 (*)(const SkyDescription&, const dvec3&);
Render seen_gradient(Color color) {
    return [=](Stage& stage, Tally& tally) {
        for (const bool far : {false, true}) {
            const SceneDescription scene = scene_under(gradient(), far);
            measure(tally, stage.film(scene), scene, place_of_scene(far), [&](const dvec3& d) -> std::optional<dvec3> {
                if (magnitude(dot(axis, d) - std::cos(70 * degree)) < 16 * stage.unit()) return std::nullopt;
                return color(*scene.sky, d);
            });
        }
    };
}

void seen_picture(Stage& stage, Tally& tally) {
    for (const dvec3& rotation : {dvec3(0), dvec3(90, 0, 90), dvec3(20, -35, 130)})
        for (const bool far : {false, true}) {
            const SceneDescription scene = under_picture(rotation, far);
            measure(tally, stage.film(scene), scene, place_of_scene(far),
                    [&](const dvec3& d) { return color_of_picture(*scene.sky, d); });
        }
}

/// In a mirror that fills the view, or through bodies that bend nothing.
Render over_a_floor(bool mirrors) {
    return [=](Stage& stage, Tally& tally) {
        SceneDescription scene = scene_under(gradient());
        const int material = add_material(scene, mirrors ? MaterialDescription{.reflection = 1} : clear());
        add_object(scene, floor_of_half(64, -4), material);
        scene.camera.target = scene.camera.position + dvec3(0, 0.1, -1);
        scene.camera.field_of_view = 60;
        scene.depth = 4;
        measure(tally, stage.film(scene), scene, 0, [&](const dvec3& d) -> std::optional<dvec3> {
            const dvec3 onward = mirrors ? dvec3(d.x, d.y, -d.z) : d;
            if (magnitude(dot(axis, onward) - std::cos(70 * degree)) < 64 * stage.unit()) return std::nullopt;
            return color_of(*scene.sky, onward);
        });
    };
}

/// The mean of 1 / sqrt(1 + x^2 + y^2) over [-a, a]^2: that of the cosine to the view over a square picture.
double mean_of_cosine(double a) {
    const double root = std::sqrt(1 + a * a);
    return (2 * a * std::asinh(a / root) - std::atan(a * a / std::sqrt(1 + 2 * a * a))) / (a * a);
}

// The midpoint rule with 192 steps a side, 2 a / 192 wide, is off by less than a twelfth of the square of a step.
void integral(Stage& stage, Tally& tally) {
    for (const double field : {40.0, 90.0, 140.0}) {
        SceneDescription scene = scene_under({.axis = {0.3, 1, 0.2}, .stops = {{0, dvec3(1)}, {180, dvec3(0)}}});
        scene.camera.field_of_view = field;
        const Film film = stage.render(scene, frame_of(48, 48, 4));
        double sum = 0;
        for (size_t pixel = 0; pixel < film.pixels.size(); ++pixel) sum += radiance(film, pixel);
        const double a = std::tan(field / 2 * degree);
        const double step = 2 * a / 192;
        tally.place = uint64_t(field);
        tally.measure(magnitude(sum / double(film.pixels.size()) - (0.5 + 0.5 * mean_of_cosine(a))) / (step * step));
    }
}

}  // namespace
}  // namespace sky

void add_sky(Cases& cases) {
    using namespace sky;
    const char* closed_form = "stops, linear in the cosine of the angle to the axis";
    cases.images("gradient/seen", closed_form, bound_of_color, seen_gradient(color_of));
    cases.images("gradient/mirrored", closed_form, bound_of_color, over_a_floor(true));
    cases.images("gradient/through-a-sheet", closed_form, bound_of_color, over_a_floor(false));
    cases.images("gradient/integral", "the mean of a picture is the integral of the cosine over its square",
                 at_most(1.0 / 12, "of a step's square"), integral);
    cases.images("picture/seen", "texels that go on linearly in longitude and latitude", bound_of_color, seen_picture);
    cases.images("broken/linear-in-degrees", closed_form, must_fail(1000, "values"), [](Stage& stage, Tally& tally) {
        const SceneDescription scene = scene_under(gradient());
        const Film film = stage.film(scene);
        for_each_view(film, scene, [&](size_t pixel, const dvec3& d) {
            const dvec3 color = wrong_color_of(*scene.sky, d);
            for (int c = 0; c < 3; ++c) tally.expect(magnitude(radiance(film, pixel, c) - color[c]) < 0x1p-10);
        });
    });
}

}  // namespace cistula::verify
