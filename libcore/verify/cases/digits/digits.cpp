// What touches in the author's mind touches in the picture, however many digits a file has: the picture is that of all
// digits. What is apart stays apart.
#include "verify/cases/contact/site.h"
#include "verify/cases/writing.h"

namespace cistula::verify {
namespace digits {
namespace {

using Build = void (*)(SceneDescription&, bool triangles);

SceneDescription scene_of(Build build, bool triangles) {
    SceneDescription scene = lit_scene();
    add_material(scene, paper({0.9, 0.6, 0.3}));
    add_material(scene, glass(1.5, true));
    add_material(scene, glass(1.31, true, {0.6, 0.2, 0.1}));
    add_material(scene, paper({0.3, 0.2, 0.7}));
    build(scene, triangles);
    return scene;
}
constexpr int floor_material = 1;
constexpr int glass_material = 2;
constexpr int ice_material = 3;
constexpr int label_material = 4;

void add_floor(SceneDescription& scene) {
    add_object(scene, parallelogram({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), floor_material);
}
void on_floor(SceneDescription& scene, bool triangles) {
    add_floor(scene);
    add_object(scene, box({-0.7, -0.5, 0}, {0.3, 0.5, 1}, triangles), glass_material);
    add_object(scene, box({0.6, -0.4, 0}, {1.1, 0.1, 0.5}, triangles), ice_material);
}
void stack(SceneDescription& scene, bool triangles) {
    add_object(scene, box({-3, -3, -0.5}, {3, 3, 0}), floor_material);
    add_object(scene, box({-0.6, -0.6, 0}, {0.6, 0.6, 0.4}, triangles), glass_material);
    add_object(scene, box({-0.5, -0.6, 0.4}, {0.5, 0.6, 0.8}, triangles), ice_material);
    add_object(scene, box({-0.6, -0.6, 0.8}, {0.6, 0.6, 1.2}, triangles), glass_material);
}
void side_by_side(SceneDescription& scene, bool triangles) {
    add_floor(scene);
    add_object(scene, box({-0.7, -0.6, 0}, {0, 0.6, 0.7}, triangles), glass_material);
    add_object(scene, box({0, -0.6, 0}, {0.5, 0.6, 0.7}, triangles), ice_material);
    add_object(scene, box({0.5, -0.2, 0}, {0.9, 0.2, 0.4}, triangles), glass_material);
}
void in_corner(SceneDescription& scene, bool triangles) {
    scene.camera.position = {3.6, 4.1, 2.6};
    add_object(scene, parallelogram({-1, -1, 0}, {4, 0, 0}, {0, 4, 0}), floor_material);
    add_object(scene, parallelogram({-1, -1, 0}, {0, 4, 0}, {0, 0, 3}), label_material);
    add_object(scene, parallelogram({-1, -1, 0}, {0, 0, 3}, {4, 0, 0}), floor_material);
    add_object(scene, box({-1, -1, 0}, {0.2, 0.2, 1.1}, triangles), glass_material);
    add_object(scene, box({0.2, -1, 0}, {0.9, -0.3, 0.7}, triangles), ice_material);
    scene.lights[0].position = {2, 1.5, 2.5};
}
void decals(SceneDescription& scene, bool triangles) {
    on_floor(scene, triangles);
    add_object(scene, parallelogram({-0.5, -0.3, 1}, {0.6, 0, 0}, {0, 0.6, 0}), label_material);
    add_object(scene, parallelogram({-0.6, -0.5, 0.2}, {0.5, 0, 0}, {0, 0, 0.5}), label_material);
    add_object(scene, parallelogram({0.4, -1.5, 0}, {0.7, 0, 0}, {0, 0.7, 0}), label_material);
}

// ---- lights and cameras on faces

void light_on_table(SceneDescription& scene, bool triangles) {
    stack(scene, triangles);
    add_object(scene, box({-1.6, -0.3, 0}, {-1.1, 0.4, 0.5}), label_material);
    scene.lights[0].position = {1.1, -0.9, 0};
    scene.lights[0].color = dvec3(1.2);
}
/// A camera in the plane of the floor, beside what stands on it.
void camera_on_floor(SceneDescription& scene, bool triangles) {
    add_object(scene, box({-3, -3, -0.5}, {3, 3, 0}), floor_material);
    add_object(scene, box({-1, 1, 0}, {0, 2, 1}, triangles), label_material);
    add_object(scene, box({0.4, 0.6, 0}, {1, 1.2, 0.6}, triangles), glass_material);
    scene.camera.position = {-0.4, -2, 0};
    scene.camera.target = {0.2, 1, 0.6};
}
/// A camera on the top of a block of glass, looking into it and past its edge.
void camera_on_glass(SceneDescription& scene, bool triangles) {
    add_object(scene, box({-3, -3, -0.5}, {3, 3, 0}), floor_material);
    add_object(scene, box({-1, 1, 0}, {0, 2, 1}), label_material);
    add_object(scene, box({-0.7, -0.7, 0}, {0.7, 0.7, 1}, triangles), glass_material);
    scene.camera.position = {0.05, -0.1, 1};
    scene.camera.target = {0.2, 1, 0.7};
    scene.camera.field_of_view = 70;
}

// ---- rounding

/// How files are written: 6 digits do not say to 2^-20 of a scene where a face is.
struct Rounding {
    int digits;
    double moved;
};
constexpr Rounding roundings[] = {{7, 0}, {8, 1}, {digits_of_float, 0}, {9, 10}, {7, 1}, {digits_of_float, 1}, {8, 10}};

/// Calls check(writing, number) with roundings and turns in turn.
template <class Check>
void for_each_rounding(const Stage& stage, const Check& check) {
    for (uint64_t i = 0; i < scenes(stage, 4 * std::size(roundings), 4); ++i) {
        const Rounding& rounding = roundings[i % std::size(roundings)];
        Draw draw(i, 54);
        Writing writing = random_writing(draw, rounding.moved);
        writing.digits = rounding.digits;
        check(writing, i);
    }
}
Writing with_all_digits(Writing writing) {
    writing.digits = all_digits;
    return writing;
}

/// `rounds_rest`: the light and the camera, too.
Render rounded_scene(Build build, bool rounds_rest = false) {
    return [=](Stage& stage, Tally& tally) {
        for_each_rounding(stage, [&](Writing writing, uint64_t i) {
            writing.rounds_rest = rounds_rest;
            const SceneDescription scene = scene_of(build, i % 2 == 1);
            expect_same_picture(stage, tally, written(scene, writing), written(scene, with_all_digits(writing)), i);
        });
    };
}

/// 6 digits at 10 scene units, and a key that says what is apart.
void contact_key(Stage& stage, Tally& tally) {
    for (uint64_t i = 0; i < scenes(stage); ++i) {
        Draw draw(i, 54);
        Writing writing = random_writing(draw, 10);
        writing.digits = 6;
        const SceneDescription scene = scene_of(i % 2 == 1 ? stack : on_floor, i % 4 >= 2);
        SceneDescription joined = written(scene, writing);
        joined.contact = 4e-4;
        expect_same_picture(stage, tally, joined, written(scene, with_all_digits(writing)), i);
    }
}

/// Cubes by center and radius on a quad, both rounded.
SceneDescription scene_of_solids(const Writing& writing) {
    contact::Site site(contact::Ground{writing.degrees, writing.origin});
    const int floor = add_material(site.scene, paper({0.9, 0.6, 0.3}));
    const int body = add_material(site.scene, glass(1.5, true));
    site.scene.film = lit_scene().film;
    site.scene.depth = lit_scene().depth;
    site.floor(floor, 3);
    site.cube(-0.3, 0.1, 0, 0.9, 0, body);
    site.cube(0.7, -0.5, 0, 0.5, 33, body);
    site.look({2, -4.6, 2.7}, {0.07, 0.03, 0.4}, 38);
    site.light({-3, -4, 5});
    const auto round = [&](dvec3& point) {
        for (int k = 0; k < 3; ++k) point[k] = rounded(point[k], writing.digits);
    };
    for (dvec3& vertex : std::get<TrianglesObject>(site.scene.objects[0].shape).vertices) round(vertex);
    for (size_t k = 1; k < site.scene.objects.size(); ++k) {
        SolidObject& solid = std::get<SolidObject>(site.scene.objects[k].shape);
        round(solid.center);
        solid.radius = rounded(solid.radius, writing.digits);
    }
    return site.scene;
}
void solids_on_floor(Stage& stage, Tally& tally) {
    for_each_rounding(stage, [&](const Writing& writing, uint64_t i) {
        expect_same_picture(stage, tally, scene_of_solids(writing), scene_of_solids(with_all_digits(writing)), i);
    });
}

/// Meshes in float, as a PLY file has them, on a floor whose height is given in decimals.
void float_on_floor(Stage& stage, Tally& tally) {
    uint64_t number = 0;
    for (const double height : {0.1, 0.7, -2.3}) {
        const Writing writing{{0, 0, 0}, {0.1, -0.3, height}};
        const SceneDescription expected = written(scene_of(on_floor, number % 2 == 1), writing);
        SceneDescription given = expected;
        for (size_t k = 1; k < given.objects.size(); ++k)
            for (dvec3& vertex : std::get<TrianglesObject>(given.objects[k].shape).vertices)
                vertex = dvec3(glm::vec3(vertex));
        expect_same_picture(stage, tally, given, expected, number++);
    }
}

// ---- gaps that a file can tell are no contacts: glass over a floor reflects totally, whatever the gap

/// A block of glass, `size` large, over a floor by a share of that.
SceneDescription with_gap(double size, double share, bool triangles) {
    SceneDescription scene = scene_of(
        +[](SceneDescription& to, bool) { add_floor(to); }, triangles);
    const double gap = share * size;
    add_object(scene, box({-size / 2, -size / 2, gap}, {size / 2, size / 2, gap + size}, triangles), glass_material);
    scene.camera.position = dvec3(1.9, -2.6, 1.9) * size;
    scene.camera.target = dvec3(0.03, 0.02, 0.4) * size;
    scene.lights[0].position = dvec3(-3, -4, 5) * size;
    return scene;
}

Render apart(double size) {
    return [=](Stage& stage, Tally& tally) {
        for_each_rounding(stage, [&](const Writing& writing, uint64_t i) {
            const double share = i % 4 < 2 ? 1e-3 : 1e-2;
            const auto film = [&](double gap) { return written(with_gap(size, gap, i % 2 == 1), writing); };
            expect_same_picture(stage, tally, film(share), film(share * 1.0625), i);
        });
    };
}
Render mistaken(double gap, double expected) {
    return [=](Stage& stage, Tally& tally) {
        expect_same_picture(stage, tally, with_gap(1, gap, false), with_gap(1, expected, false), 0);
    };
}

}  // namespace
}  // namespace digits

void add_digits(Cases& cases) {
    using namespace digits;
    const auto add = [&](const std::string& name, const Render& render,
                         const char* exact = "the picture of the scene with all digits",
                         const Bound& bound = no_failures("pixels")) { cases.images(name, exact, bound, render); };
    add("on-a-floor", rounded_scene(on_floor));
    add("solids-on-a-floor", solids_on_floor);
    add("stack", rounded_scene(stack));
    add("side-by-side", rounded_scene(side_by_side));
    add("in-a-corner", rounded_scene(in_corner));
    add("decals", rounded_scene(decals));
    add("contact-key", contact_key, "with \"contact\" 4e-4, the picture of the scene with all digits");
    add("float-on-a-floor", float_on_floor);
    add("light-on-a-face", rounded_scene(light_on_table, true));
    add("camera-on-a-floor", rounded_scene(camera_on_floor, true));
    add("camera-on-glass", rounded_scene(camera_on_glass, true));
    add("gaps", apart(1), "the picture of a gap larger by a sixteenth");
    add("hovering", apart(0.05), "the picture of a gap larger by a sixteenth");  // a pebble of a hundredth of its floor
    const char* seen = "a gap in a contact's place is seen, and a contact in a gap's";
    add("broken/contact", mistaken(1e-3, 0), seen, must_fail(5, "pixels"));
    add("broken/gap", mistaken(0, 1e-3), seen, must_fail(5, "pixels"));
}

}  // namespace cistula::verify
