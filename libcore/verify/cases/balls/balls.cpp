// Balls: outlines, lenses, bounces, shells that coincide or nearly do, contact, and sizes.
#include "verify/cases/balls/paths.h"
#include "verify/cases/pictures.h"
#include "verify/cases/scenes.h"

namespace cistula::verify {
namespace balls {
namespace {

SphereObject sphere(const glm::dvec3& center, double radius) {
    SphereObject object;
    object.center = center;
    object.radius = radius;
    return object;
}

/// Adds rays through a ball of each radius, alone and beside a ball of radius 1.
template <class Functor>
auto through_balls(const Functor& functor, double index, uint64_t in_full, uint64_t in_quick) {
    return [=](Plan& plan) {
        for (const double radius : {0.3, 1.0, 0x1p-10}) {
            SceneDescription scene = empty_scene();
            const int material = add_material(scene, glass(index));
            const glm::dvec3 center = radius < 0.1 ? glm::dvec3(1.5, 0.25, 0.5) : glm::dvec3(0.1, 0.2, 0.3);
            add_object(scene, sphere(center, radius), material);
            if (radius < 0.1) add_object(scene, sphere({-1, 0, 0}, 1), material);
            Part& part =
                plan.add("radius " + std::to_string(radius), scene, functor, {center}, plan.rays(in_full, in_quick));
            part.frame_numbers = [=](const PartFrame& frame, Numbers& numbers) {
                numbers = {radius * frame.factor, index};
            };
        }
    };
}

/// What stands on a floor under a sky: a view for pictures.
SceneDescription view(double unit = 1) {
    SceneDescription scene = empty_scene();
    scene.film.width = 48;
    scene.film.height = 36;
    scene.depth = 8;
    scene.ambient = glm::dvec3(0.2);
    scene.background = {0.3, 0.4, 0.55};
    scene.camera.position = glm::dvec3(0, -6, 3) * unit;
    scene.camera.target = glm::dvec3(0, 0, 0.8) * unit;
    scene.camera.field_of_view = 50;
    add_checker(scene, glm::dvec2(0.5 / unit));
    add_object(scene, floor_of_half(8 * unit));
    add_light(scene, glm::dvec3(3, -3, 8) * unit);
    return scene;
}

/// A ball in uniform light that takes none is invisible, but for what the depth cuts off: Fresnel's shares sum to 1 at
/// every angle.
void furnace(Stage& stage, Tally& tally) {
    SceneDescription scene = empty_scene();
    scene.film.width = scene.film.height = stage.quick ? 32 : 64;  // every pixel has a tree of thousands of rays
    scene.depth = 40;
    scene.background = glm::dvec3(1);
    scene.camera.position = {0, -4, 0};
    scene.camera.field_of_view = 32;
    add_object(scene, sphere({0, 0, 0}, 1), add_material(scene, glass(1.5, true)));
    add_object(scene, sphere({0.2, 0, 0.1}, 0.5), add_material(scene, glass(1.2, true)));
    const Film film = stage.film(scene);
    const double whole = std::ldexp(1.0, film.fixed_shift - film.radiance_exponent);
    for_each_pixel(film, [&](size_t pixel, int, int) {
        tally.place = pixel;
        const PixelRecord& record = film.pixels[pixel];
        bool holds = film.flags == 0;
        for (int c = 0; c < 3; ++c) {
            const double missing = whole - double(record.radiance[c]);
            holds = holds && missing >= -whole * 64 * stage.unit() &&
                    missing <= double(record.cut[c]) + double(record.pruned[c]) + whole * 0x1p-12;
        }
        tally.expect(holds);
    });
}

/// A clear ball of the same index in a hole of the same radius, written a few roundings apart, leaves nothing to see.
void filled_hole(Stage& stage, Tally& tally) {
    for (uint64_t variation = 0; variation < 3; ++variation) {
        SceneDescription plain = view();
        const int material = add_material(plain, glass(1.5));
        add_object(plain, sphere({0, 0, 1.2}, 1), material);
        SceneDescription filled = plain;
        const double rounding = double(variation) * stage.unit();
        add_object(filled, sphere({0, 0, 1.2}, 0.8), add_material(filled, glass(1)));
        add_object(filled, sphere({rounding, 0, 1.2}, 0.8 * (1 + rounding)), material);
        expect_same(tally, stage.film(filled), stage.film(plain), 0, variation);
    }
}

/// Shells of the same index around one another, touching from inside or cut by one another, leave nothing to see.
void shells(Stage& stage, Tally& tally) {
    SceneDescription plain = view();
    const int material = add_material(plain, glass(1.5));
    add_object(plain, sphere({0, 0, 1.2}, 1), material);
    const Film expected = stage.film(plain);
    for (const double radius : {0.999, 0.6, 0x1p-6})
        for (const double off : {0.0, 1.0}) {
            SceneDescription scene = plain;
            add_object(scene, sphere({off * (1 - radius), 0, 1.2}, radius), material);
            expect_same_picture(stage, tally, scene, expected, uint64_t(1000 * radius) + uint64_t(off));
        }
}

/// Bodies of the same glass in a ball, and two halves of a box that overlap or touch, leave nothing to see, however
/// small the depth; nor do they darken shadows. `tint`: of the glass.
void same_glass(Stage& stage, Tally& tally, double tint) {
    MaterialDescription material = glass(1.5, true);
    material.reflection = 0.1, material.transmission = 0.9, material.tint = glm::dvec3(tint);
    SceneDescription plain = view();
    plain.depth = 5;
    SceneDescription halves = plain;
    const int number = add_material(plain, material);
    add_material(halves, material);
    add_object(plain, sphere({0, 0, 1.2}, 1), number);
    const Film expected = stage.film(plain);
    for (int kind = 0; kind < 4; ++kind) {
        SceneDescription scene = plain;
        if (kind < 2) add_object(scene, sphere({0.1, 0, 1.2}, 0.7), number);
        if (kind == 1) add_object(scene, sphere({0.2, 0.1, 1.2}, 0.4), number);
        if (kind >= 2) add_object(scene, box({-0.3, -0.2, 0.8}, {0.4, 0.5, 1.5}, kind == 3), number);
        const Film film = stage.film(scene);
        for_each_pixel(film, [&](size_t pixel, int, int) {
            tally.place = place_of(0, uint64_t(kind), pixel);
            bool same = film.pixels[pixel].rays == expected.pixels[pixel].rays;
            for (int c = 0; c < 3; ++c)
                same = same && magnitude(radiance(film, pixel, c) - radiance(expected, pixel, c)) <= 16 * stage.unit();
            tally.expect(same);
        });
    }
    SceneDescription whole = halves;
    add_object(whole, box({-0.8, -0.6, 0}, {0.9, 0.7, 1.1}), number);
    const Film expected_box = stage.film(whole);
    for (const double overlap : {0.25, 0.0})
        for (const bool triangles : {false, true}) {
            SceneDescription scene = halves;
            add_object(scene, box({-0.8, -0.6, 0}, {0.1 + overlap, 0.7, 1.1}, triangles), number);
            add_object(scene, box({0.1, -0.6, 0}, {0.9, 0.7, 1.1}, triangles), number);
            expect_same_picture(stage, tally, scene, expected_box, 1 + uint64_t(overlap > 0) + 2 * uint64_t(triangles));
        }
}

/// A ball that touches a glass cube that stands on the floor looks as one a hair above it.
void on_cube(Stage& stage, Tally& tally) {
    const auto scene_at = [&](double height) {
        SceneDescription scene = view();
        add_object(scene, solid_object(PlatonicSolid::cube, {0, 0, 0.5}, std::sqrt(0.75)),
                   add_material(scene, glass(1.5)));
        add_object(scene, sphere({0, 0, 1.5 + height}, 0.5), add_material(scene, glass(1.3)));
        return scene;
    };
    const Film near = stage.film(scene_at(0x1p-12));
    expect_same_picture(stage, tally, scene_at(0), near, 0);
    expect_same_picture(stage, tally, scene_at(-0x1p-12), near, 1);
}

/// Pictures of a ball of radius 1e-6 and of one of 1, with a ball of 1 or 1e6 behind the camera.
void sizes(Stage& stage, Tally& tally) {
    const auto scene_of = [&](double unit, double other) {
        SceneDescription scene = view(unit);
        add_object(scene, sphere(glm::dvec3(0, 0, 1) * unit, unit), add_material(scene, glass(1.5)));
        if (other > 0) add_object(scene, sphere({0, -3 * other, 0}, other), add_material(scene, paper({0, 0, 0})));
        return scene;
    };
    for (const double other : {1e2, 1e6}) {
        const SceneDescription scene = scene_of(1, other);
        if (!stage.warns_of(scene)) expect_same_picture(stage, tally, scene, scene_of(1, 1e2), 0);
    }
    const SceneDescription small = scene_of(1e-6, 1);
    if (!stage.warns_of(small)) expect_same_picture(stage, tally, small, scene_of(1e-6, 1e-4), 1);
}

}  // namespace
}  // namespace balls

void add_balls(Cases& cases) {
    using namespace balls;
    cases.rays<Outline>("outline", "a line meets a ball where it comes nearer than the radius, on its surface",
                        no_failures("rays", needs_witness), through_balls(Outline{false}, 1.5, 1'000'000, 20000));
    cases.rays<Outline>("broken/textbook-discriminant", "b^2 - (f.f - r^2) misses outlines", must_fail(1, "rays"),
                        through_balls(Outline{true}, 1.5, 1'000'000, 20000));
    cases.rays<Focus>("focus", "a ray through a glass ball turns by 2 (i - t)", at_most(64, "u M / r"),
                      through_balls(Focus{}, 1.5, 400'000, 10000));
    cases.rays<Bounces>("bounces", "all chords of a line inside a ball have one length", at_most(128, "u M"),
                        through_balls(Bounces{}, 1.5, 200'000, 5000));
    cases.images("furnace", "the background's color, at every angle", no_failures("pixels"), furnace);
    cases.images("filled-hole", "the ball without hole and filling", no_failures("pixels"), filled_hole);
    cases.images("shells", "the ball without shells in it", no_failures("pixels"), shells);
    cases.images("same-glass", "one body, whatever bodies of its glass are in it", no_failures("pixels"),
                 [](Stage& stage, Tally& tally) { same_glass(stage, tally, 1); });
    cases.images("broken/tinted-glass", "faces with a tint are seen", must_fail(100, "pixels"),
                 [](Stage& stage, Tally& tally) { same_glass(stage, tally, 0.999); });
    cases.images("on-a-cube", "the ball a hair above the cube", no_failures("pixels"), on_cube);
    cases.images("sizes", "the ball beside one that is not larger", no_failures("pixels", float_warns), sizes);
}

}  // namespace cistula::verify
