// Lamps with falloff whose spheres nothing comes near: the picture does not depend on how small these are.
#pragma once

#include "apps/render_verify/given/writing.h"

namespace cistula::verify::sums {

using namespace given;

/// A lamp of inverse-square falloff that is not seen but by what it lights.
inline void add_lamp(SceneDescription& scene, const dvec3& position, double intensity, double radius) {
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
        add_object(scene, box(low, high), add_material(scene, stone(dvec3(1))));
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
inline constexpr Bound bound_of_light = at_most(0x1p-13, 0x1p-24, "of the light");

template <int lamps>
struct InRoom {
    static constexpr const char* exact = "the light of a wall is the sum of I cos a / d^2, for radii from 1e-4 to 1e-8";
    static constexpr Bound bound = bound_of_light;

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage); ++i) {
            Draw draw(i, 55);
            Room room;
            const double radius = std::pow(10, -8.0 + 4 * double(i) / double(scenes(stage)));
            for (int k = 0; k < lamps; ++k) add_lamp(room.scene, draw.in_cube<double>(1.7), 4.0 / lamps, radius);
            const Film film = contact::film_of(stage, room.scene);
            for_each_pixel(film, room.scene, [&](size_t pixel, const dvec3& direction) {
                const double expected = room.light_along(direction);
                tally.place = place_of_scene(i) + pixel;
                tally.measure(magnitude(radiance(film, pixel) - expected) / expected);
            });
        }
    }
};
struct TinyLamp : InRoom<1> {
    static constexpr const char* name = "sums/tiny-lamp";
};
struct ManyTinyLamps : InRoom<16> {
    static constexpr const char* name = "sums/tiny-lamps";
};

/// A lamp in the hole of a torus: the torus' box surrounds it, nothing of the torus comes near.
struct LampInTorus {
    static constexpr const char* name = "sums/in-a-torus";
    static constexpr const char* exact = "the picture, background too, of a lamp with a radius of 1e-3";
    static constexpr Bound bound = at_most(0x1p-20, "of 1");

    static void render(Stage& stage, Tally& tally) {
        for (const double radius : {1e-8, 1e-5}) {
            const auto film = [&](double of) { return contact::film_of(stage, scene_of(of)); };
            contact::measure_difference(tally, film(radius), film(1e-3), place_of_scene(radius == 1e-8));
        }
    }

  private:
    static SceneDescription scene_of(double radius) {
        SceneDescription scene = lit_scene();
        add_object(scene, torus(1.2, 0.3, 16, 8), add_material(scene, stone({0.8, 0.6, 0.3})));
        add_lamp(scene, {0.1, 0, 0.05}, 0.7, radius);
        return scene;
    }
};

/// A hidden lamp in view of the camera.
struct HiddenLamp {
    static constexpr const char* name = "sums/hidden-lamp";
    static constexpr const char* exact = "the picture of a lamp too small to be seen";
    static constexpr Bound bound = at_most(0x1p-20, "of 1");

    static void render(Stage& stage, Tally& tally) {
        Room room;
        add_lamp(room.scene, {0.3, 0, 0.2}, 4, 0.2);
        room.scene.lights[0].visible = false;
        const Film hidden = contact::film_of(stage, room.scene);
        room.scene.lights[0].radius = 1e-6;
        contact::measure_difference(tally, hidden, contact::film_of(stage, room.scene), 0);
        room.scene.lights[0].visible = true;
        contact::measure_difference(tally, hidden, contact::film_of(stage, room.scene), place_of_scene(1));
    }
};

/// The room with a target error.
struct TargetError {
    static constexpr const char* name = "sums/target-error";
    static constexpr const char* exact = "the light of a wall at the pixel's middle, with --target-error 0.01";
    static constexpr Bound bound = at_most(0.01, "of 1");

    static void render(Stage& stage, Tally& tally) {
        Room room;
        add_lamp(room.scene, {-1, -1, 2}, 8, 1e-7);
        room.scene.camera.position = {0.1, -1, 0};  // toward one wall: no pixel has an edge
        room.scene.camera.target = {0, 4, 0.1};
        room.scene.camera.field_of_view = 40;
        FrameSettings settings;
        settings.set_size(room.scene.film.width, room.scene.film.height);
        settings.target_error = 0.01;
        const Film film = stage.render(room.scene, settings);
        for_each_pixel(film, room.scene, [&](size_t pixel, const dvec3& direction) {
            tally.place = pixel;
            tally.measure(magnitude(radiance(film, pixel) - room.light_along(direction)));
        });
    }
};

/// A sun at its distance in meters, seen, with its falloff: on a floor of ten meters, and in mirrors.
template <bool mirrors>
struct AtSunDistance {
    static constexpr const char* exact = "the light of a floor is I cos a / d^2";
    static constexpr Bound bound = bound_of_light;
    static constexpr bool float_warns = true;

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage, 6, 1); ++i) {
            Draw draw(i, 55);
            const double slope = 0.3 + draw.unit<double>();
            const dvec3 sun = normalized(dvec3(-0.5, -slope, 0.8)) * 1.5e11;
            SceneDescription scene = lit_scene();
            scene.ambient = dvec3(0);
            scene.camera.target = {0, 0, 0};
            scene.camera.field_of_view = 20;
            LightDescription& light = scene.lights[0];
            light.position = sun;
            light.color = dvec3(1.8e22);
            light.radius = 7e8;
            light.falloff = true;
            add_object(scene, parallelogram({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}),
                       add_material(scene, stone(dvec3(1), mirrors ? 0.25 : 0)));
            if (stage.warns_of(scene)) continue;
            const Film film = contact::film_of(stage, scene);
            const double light_on_floor = 1.8e22 * normalized(sun).z / dot(sun, sun);
            for (size_t pixel = 0; pixel < film.pixels.size(); ++pixel)
                for (int c = 0; c < 3; ++c) {
                    const double expected =
                        mirrors ? 0.75 * light_on_floor + 0.25 * scene.background[c] : light_on_floor;
                    tally.place = place_of_scene(i) + pixel;
                    tally.measure(magnitude(radiance(film, pixel, c) - expected) / expected);
                }
        }
    }
};
struct Sun : AtSunDistance<false> {
    static constexpr const char* name = "sums/sun";
};
struct SunInMirrors : AtSunDistance<true> {
    static constexpr const char* name = "sums/sun/mirrored-background";
};

}  // namespace cistula::verify::sums
