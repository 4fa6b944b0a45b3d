// Bodies that touch, in files whose numbers are rounded: the picture is that of all digits.
#pragma once

#include "apps/render_verify/given/writing.h"

namespace cistula::verify::digits {

using namespace given;

using Build = void (*)(SceneDescription&, bool triangles);

inline SceneDescription scene_of(Build build, bool triangles) {
    SceneDescription scene = lit_scene();
    add_material(scene, stone({0.9, 0.6, 0.3}));
    add_material(scene, contact::glass(1.5));
    add_material(scene, contact::glass(1.31, {0.6, 0.2, 0.1}));
    add_material(scene, stone({0.3, 0.2, 0.7}));
    build(scene, triangles);
    return scene;
}
inline constexpr int floor_material = 1, glass_material = 2, ice_material = 3, label_material = 4;

inline void add_floor(SceneDescription& scene) {
    add_object(scene, parallelogram({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), floor_material);
}
inline void on_floor(SceneDescription& scene, bool triangles) {
    add_floor(scene);
    add_object(scene, box({-0.7, -0.5, 0}, {0.3, 0.5, 1}, triangles), glass_material);
    add_object(scene, box({0.6, -0.4, 0}, {1.1, 0.1, 0.5}, triangles), ice_material);
}
inline void stack(SceneDescription& scene, bool triangles) {
    add_object(scene, box({-3, -3, -0.5}, {3, 3, 0}), floor_material);
    add_object(scene, box({-0.6, -0.6, 0}, {0.6, 0.6, 0.4}, triangles), glass_material);
    add_object(scene, box({-0.5, -0.6, 0.4}, {0.5, 0.6, 0.8}, triangles), ice_material);
    add_object(scene, box({-0.6, -0.6, 0.8}, {0.6, 0.6, 1.2}, triangles), glass_material);
}
inline void side_by_side(SceneDescription& scene, bool triangles) {
    add_floor(scene);
    add_object(scene, box({-0.7, -0.6, 0}, {0, 0.6, 0.7}, triangles), glass_material);
    add_object(scene, box({0, -0.6, 0}, {0.5, 0.6, 0.7}, triangles), ice_material);
    add_object(scene, box({0.5, -0.2, 0}, {0.9, 0.2, 0.4}, triangles), glass_material);
}
inline void in_corner(SceneDescription& scene, bool triangles) {
    scene.camera.position = {3.6, 4.1, 2.6};
    add_object(scene, parallelogram({-1, -1, 0}, {4, 0, 0}, {0, 4, 0}), floor_material);
    add_object(scene, parallelogram({-1, -1, 0}, {0, 4, 0}, {0, 0, 3}), label_material);
    add_object(scene, parallelogram({-1, -1, 0}, {0, 0, 3}, {4, 0, 0}), floor_material);
    add_object(scene, box({-1, -1, 0}, {0.2, 0.2, 1.1}, triangles), glass_material);
    add_object(scene, box({0.2, -1, 0}, {0.9, -0.3, 0.7}, triangles), ice_material);
    scene.lights[0].position = {2, 1.5, 2.5};
}
inline void decals(SceneDescription& scene, bool triangles) {
    on_floor(scene, triangles);
    add_object(scene, parallelogram({-0.5, -0.3, 1}, {0.6, 0, 0}, {0, 0.6, 0}), label_material);
    add_object(scene, parallelogram({-0.6, -0.5, 0.2}, {0.5, 0, 0}, {0, 0, 0.5}), label_material);
    add_object(scene, parallelogram({0.4, -1.5, 0}, {0.7, 0, 0}, {0, 0.7, 0}), label_material);
}

/// How files are written: 6 digits do not say to 2^-20 of a scene where a face is.
struct Rounding {
    int digits;
    double moved;
};
inline constexpr Rounding roundings[] = {{7, 0}, {8, 1}, {digits_of_float, 0}, {9, 10}, {7, 1}, {digits_of_float, 1},
                                         {8, 10}};

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
inline Writing with_all_digits(Writing writing) {
    writing.digits = all_digits;
    return writing;
}

/// `rounds_rest`: the light and the camera, too.
template <Build build, bool rounds_rest = false>
struct Rounded {
    static constexpr const char* exact = "the picture of the scene with all digits";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        for_each_rounding(stage, [&](Writing writing, uint64_t i) {
            writing.rounds_rest = rounds_rest;
            const SceneDescription scene = scene_of(build, i % 2 == 1);
            expect_same_picture(stage, tally, written(scene, writing), written(scene, with_all_digits(writing)), i);
        });
    }
};

struct OnFloor : Rounded<on_floor> {
    static constexpr const char* name = "digits/on-a-floor";
};
struct Stack : Rounded<stack> {
    static constexpr const char* name = "digits/stack";
};
struct SideBySide : Rounded<side_by_side> {
    static constexpr const char* name = "digits/side-by-side";
};
struct InCorner : Rounded<in_corner> {
    static constexpr const char* name = "digits/in-a-corner";
};
struct Decals : Rounded<decals> {
    static constexpr const char* name = "digits/decals";
};

/// 6 digits at 10 scene units, and a key that says what is apart.
struct ContactKey {
    static constexpr const char* name = "digits/contact-key";
    static constexpr const char* exact = "with \"contact\" 4e-4, the picture of the scene with all digits";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
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
};

/// Cubes by center and radius on a quad, both rounded.
struct SolidsOnFloor {
    static constexpr const char* name = "digits/solids-on-a-floor";
    static constexpr const char* exact = "the picture of the scene with all digits";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        for_each_rounding(stage, [&](const Writing& writing, uint64_t i) {
            expect_same_picture(stage, tally, scene_of_solids(writing), scene_of_solids(with_all_digits(writing)), i);
        });
    }

  private:
    static SceneDescription scene_of_solids(const Writing& writing) {
        contact::Site site(contact::Ground{writing.degrees, writing.origin});
        const int floor = add_material(site.scene, stone({0.9, 0.6, 0.3}));
        const int glass = add_material(site.scene, contact::glass(1.5));
        site.scene.film = lit_scene().film;
        site.scene.depth = lit_scene().depth;
        site.floor(floor, 3);
        site.cube(-0.3, 0.1, 0, 0.9, 0, glass);
        site.cube(0.7, -0.5, 0, 0.5, 33, glass);
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
};

/// Meshes in float, as a PLY file has them, on a floor whose height is given in decimals.
struct FloatOnFloor {
    static constexpr const char* name = "digits/float-on-a-floor";
    static constexpr const char* exact = "the picture of the scene with all digits";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const double height : {0.1, 0.7, -2.3}) {
            const bool triangles = number % 2 == 1;
            const SceneDescription scene = scene_of(on_floor, triangles);
            const Writing writing{{0, 0, 0}, {0.1, -0.3, height}};
            const SceneDescription expected = written(scene, writing);
            SceneDescription given = expected;
            for (size_t k = 1; k < given.objects.size(); ++k)
                for (dvec3& vertex : std::get<TrianglesObject>(given.objects[k].shape).vertices)
                    vertex = dvec3(glm::vec3(vertex));
            expect_same_picture(stage, tally, given, expected, number++);
        }
    }
};

// ---- lights and cameras on faces

inline void light_on_table(SceneDescription& scene, bool triangles) {
    stack(scene, triangles);
    add_object(scene, box({-1.6, -0.3, 0}, {-1.1, 0.4, 0.5}), label_material);
    scene.lights[0].position = {1.1, -0.9, 0};
    scene.lights[0].color = dvec3(1.2);
}
/// A camera in the plane of the floor, beside what stands on it.
inline void camera_on_floor(SceneDescription& scene, bool triangles) {
    add_object(scene, box({-3, -3, -0.5}, {3, 3, 0}), floor_material);
    add_object(scene, box({-1, 1, 0}, {0, 2, 1}, triangles), label_material);
    add_object(scene, box({0.4, 0.6, 0}, {1, 1.2, 0.6}, triangles), glass_material);
    scene.camera.position = {-0.4, -2, 0};
    scene.camera.target = {0.2, 1, 0.6};
}
/// A camera on the top of a block of glass, looking into it and past its edge.
inline void camera_on_glass(SceneDescription& scene, bool triangles) {
    add_object(scene, box({-3, -3, -0.5}, {3, 3, 0}), floor_material);
    add_object(scene, box({-1, 1, 0}, {0, 2, 1}), label_material);
    add_object(scene, box({-0.7, -0.7, 0}, {0.7, 0.7, 1}, triangles), glass_material);
    scene.camera.position = {0.05, -0.1, 1};
    scene.camera.target = {0.2, 1, 0.7};
    scene.camera.field_of_view = 70;
}

struct LightOnFace : Rounded<light_on_table, true> {
    static constexpr const char* name = "digits/light-on-a-face";
};
struct CameraOnFloor : Rounded<camera_on_floor, true> {
    static constexpr const char* name = "digits/camera-on-a-floor";
};
struct CameraOnGlass : Rounded<camera_on_glass, true> {
    static constexpr const char* name = "digits/camera-on-glass";
};

}  // namespace cistula::verify::digits
