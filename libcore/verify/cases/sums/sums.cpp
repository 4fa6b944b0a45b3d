// Sums that hold what is lit beside lights that could be far brighter; what truncation takes is in the ledger.
#include <optional>

#include "render/record/film_colors.h"
#include "verify/cases/writing.h"

namespace cistula::verify {
namespace sums {
namespace {

// ---- lamps with falloff whose spheres nothing comes near: the picture does not depend on how small these are

/// A lamp of inverse-square falloff that is not seen but by what it lights.
void add_lamp(SceneDescription& scene, const dvec3& position, double intensity, double radius) {
    LightDescription& lamp = add_light(scene, position);
    lamp.color = dvec3(intensity);
    lamp.glow = dvec3(0);
    lamp.radius = radius;
    lamp.falloff = true;
}

/// A closed room around the camera, of white walls, in the light of lamps alone; none stands between a wall and these.
struct Room {
    dvec3 low{-4, -4, -2}, high{4, 4, 3};
    SceneDescription scene = lit_scene();

    Room() {
        scene.ambient = scene.background = dvec3(0);
        scene.lights.clear();
        add_object(scene, box(low, high), add_material(scene, paper(dvec3(1))));
        scene.camera.position = {0.1, -3.5, 0.2};
        scene.camera.target = {0, 0, -0.5};
        scene.camera.field_of_view = 75;
    }
    /// The light of the lamps on the wall where a line from the camera ends.
    double light_along(const dvec3& direction) const {
        int axis = 0;
        double least = INFINITY;
        for (int k = 0; k < 3; ++k) {
            const double t = ((direction[k] > 0 ? high : low)[k] - scene.camera.position[k]) / direction[k];
            if (t < least) least = t, axis = k;
        }
        const dvec3 point = scene.camera.position + direction * least;
        double sum = 0;
        for (const LightDescription& lamp : scene.lights) {
            const dvec3 to = lamp.position - point;
            sum += lamp.color.x * magnitude(to[axis]) / (dot(to, to) * length(to));
        }
        return sum;
    }
};

// A point of a wall is off by some 64 u M, M being below 2, or below 6 u of a scene that is 8 large: the light of a
// lamp that is 1/4 away or more changes by less than 2^11 u of itself. Sums have 2^-24 of it.
constexpr Bound bound_of_light = at_most(0x1p-13, 0x1p-24, "of the light");

Render in_room(int lamps) {
    return [=](Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage); ++i) {
            Draw draw(i, 55);
            Room room;
            const double radius = std::pow(10, -8.0 + 4 * double(i) / double(scenes(stage)));
            for (int k = 0; k < lamps; ++k) add_lamp(room.scene, draw.in_cube<double>(1.7), 4.0 / lamps, radius);
            const Film film = stage.film(room.scene);
            for_each_view(film, room.scene, [&](size_t pixel, const dvec3& direction) {
                const double expected = room.light_along(direction);
                tally.place = place_of_scene(i) + pixel;
                tally.measure(magnitude(radiance(film, pixel) - expected) / expected);
            });
        }
    };
}

/// A lamp in the hole of a torus: the torus' box surrounds it, nothing of the torus comes near.
void lamp_in_torus(Stage& stage, Tally& tally) {
    const auto film = [&](double radius) {
        SceneDescription scene = lit_scene();
        add_object(scene, torus(1.2, 0.3, 16, 8), add_material(scene, paper({0.8, 0.6, 0.3})));
        add_lamp(scene, {0.1, 0, 0.05}, 0.7, radius);
        return stage.film(scene);
    };
    for (const double radius : {1e-8, 1e-5})
        measure_difference(tally, film(radius), film(1e-3), place_of_scene(radius == 1e-8));
}

/// A hidden lamp in view of the camera.
void hidden_lamp(Stage& stage, Tally& tally) {
    Room room;
    add_lamp(room.scene, {0.3, 0, 0.2}, 4, 0.2);
    room.scene.lights[0].visible = false;
    const Film hidden = stage.film(room.scene);
    room.scene.lights[0].radius = 1e-6;
    measure_difference(tally, hidden, stage.film(room.scene), 0);
    room.scene.lights[0].visible = true;
    measure_difference(tally, hidden, stage.film(room.scene), place_of_scene(1));
}

void with_target_error(Stage& stage, Tally& tally) {
    Room room;
    add_lamp(room.scene, {-1, -1, 2}, 8, 1e-7);
    room.scene.camera.position = {0.1, -1, 0};  // toward one wall: no pixel has an edge
    room.scene.camera.target = {0, 4, 0.1};
    room.scene.camera.field_of_view = 40;
    FrameSettings settings;
    settings.set_size(room.scene.film.width, room.scene.film.height);
    settings.target_error = 0.01;
    const Film film = stage.render(room.scene, settings);
    for_each_view(film, room.scene, [&](size_t pixel, const dvec3& direction) {
        tally.place = pixel;
        tally.measure(magnitude(radiance(film, pixel) - room.light_along(direction)));
    });
}

/// A sun at its distance in meters, seen, with its falloff: on a floor of ten meters, and in mirrors.
Render at_sun_distance(bool mirrors) {
    return [=](Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage, 6, 1); ++i) {
            Draw draw(i, 55);
            const double slope = 0.3 + draw.unit<double>();
            const dvec3 sun = normalized(dvec3(-0.5, -slope, 0.8)) * 1.5e11;
            SceneDescription scene = lit_scene();
            scene.ambient = dvec3(0);
            scene.camera.target = {0, 0, 0};
            scene.camera.field_of_view = 20;
            scene.lights[0] = {.position = sun, .color = dvec3(1.8e22), .radius = 7e8, .falloff = true};
            add_object(scene, parallelogram({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}),
                       add_material(scene, paper(dvec3(1), mirrors ? 0.25 : 0)));
            if (stage.warns_of(scene)) continue;
            const Film film = stage.film(scene);
            const double light_on_floor = 1.8e22 * normalized(sun).z / dot(sun, sun);
            for (size_t pixel = 0; pixel < film.pixels.size(); ++pixel)
                for (int c = 0; c < 3; ++c) {
                    const double expected =
                        mirrors ? 0.75 * light_on_floor + 0.25 * scene.background[c] : light_on_floor;
                    tally.place = place_of_scene(i) + pixel;
                    tally.measure(magnitude(radiance(film, pixel, c) - expected) / expected);
                }
        }
    };
}

// ---- what truncation takes away, by the depth, by the cutoff and by the unit of the sums: no more than error.* says

/// Bodies of glass before a mirror, in the light of several lamps: pixels of hundreds of contributions.
SceneDescription many_branches() {
    SceneDescription scene = lit_scene();
    const int half = add_material(scene, {.color = {0.7, 0.8, 0.6},
                                          .reflection = 0.3,
                                          .transmission = 0.5,
                                          .index = 1.5,
                                          .absorption = {0.1, 0.2, 0.4}});
    const int mirror = add_material(scene, paper({0.9, 0.8, 0.7}, 0.6));
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
    /// Expects what is lost to be what the ledger says at most.
    void check(const Stage& stage, Tally& tally) const {
        const Film reference = Loss().film(stage);
        const Film found = film(stage);
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

}  // namespace
}  // namespace sums

void add_sums(Cases& cases) {
    using namespace sums;
    const char* sum_of_lamps = "the light of a wall is the sum of I cos a / d^2, for radii from 1e-4 to 1e-8";
    cases.images("tiny-lamp", sum_of_lamps, bound_of_light, in_room(1));
    cases.images("tiny-lamps", sum_of_lamps, bound_of_light, in_room(16));
    cases.images("in-a-torus", "the picture, background too, of a lamp with a radius of 1e-3", at_most(0x1p-20, "of 1"),
                 lamp_in_torus);
    cases.images("hidden-lamp", "the picture of a lamp too small to be seen", at_most(0x1p-20, "of 1"), hidden_lamp);
    cases.images("target-error", "the light of a wall at the pixel's middle, with a target error of 0.01",
                 at_most(0.01, "of 1"), with_target_error);
    Bound bound_of_sun = bound_of_light;
    bound_of_sun.flags = float_warns;
    cases.images("sun", "the light of a floor is I cos a / d^2", bound_of_sun, at_sun_distance(false));
    cases.images("sun/mirrored-background", "the light of a floor is I cos a / d^2", bound_of_sun,
                 at_sun_distance(true));

    const auto ledger = [&](const std::string& name, const std::vector<Loss>& losses) {
        cases.images("ledger/" + name, "0 <= reference - image <= error.*, in every pixel and channel",
                     no_failures("sums", needs_witness), [=](Stage& stage, Tally& tally) {
                         for (const Loss& loss : losses) loss.check(stage, tally);
                     });
    };
    const int deep = Loss::deep;
    ledger("coarse-units", {{deep, 0, 0x1p40}, {deep, 0, 0x1p48}, {deep, 0, 0x1p56}});  // of 2^-22, 2^-14 and 2^-6
    ledger("depth", {{1, 0, {}}, {2, 0, {}}, {5, 0, {}}});
    ledger("cutoff", {{deep, 1e-3, 0x1p48}, {deep, 0.03, 0x1p48}});
    cases.images("broken/ledger", "without the ledger the case fails", must_fail(5, "sums"),
                 [](Stage& stage, Tally& tally) {
                     Loss{Loss::deep, 0, 0x1p48, false}.check(stage, tally);
                 });
}

}  // namespace cistula::verify
