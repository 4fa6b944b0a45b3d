// Light through slabs that are pieces of one mesh, one of them a shell with a body in it: exp(-sigma d) of the way d
// inside.
#pragma once

#include "apps/render_verify/pieces/windings.h"

namespace cistula::verify::pieces {

/// Slabs over one another around the z axis, in one mesh; `thickness` of all that is inside.
struct Slabs {
    static constexpr double sigma = 0.7;
    std::vector<TrianglesObject> outward;
    double thickness = 0;

    explicit Slabs(Draw& draw) {
        add(draw, 1, 0.4, 2);
        const double shell = add(draw, 2, 0.9, 2);
        add(draw, shell + 0.1, 0.6, 1.9, -1);
        add(draw, shell + 0.2, 0.3, 1.8);
        add(draw, 3.2, 0.4, 2);
    }
    TrianglesObject wound(Draw& draw) const {
        std::vector<TrianglesObject> pieces = outward;
        for (TrianglesObject& piece : pieces) {
            if (draw.one_in(2)) turn_inside_out(piece);
            if (draw.one_in(4)) wind_at_random(piece, draw);
        }
        return joined(pieces);
    }

  private:
    double add(Draw& draw, double low, double height, double half, double sign = 1) {
        const double high = low + height * (sign < 0 ? 1 : 0.7 + 0.3 * draw.unit<double>());
        outward.push_back(box({-half, -half, low}, {half, half, high}));
        thickness += sign * (high - low);
        return low;
    }
};

/// `in_shadow`: the camera is under the slabs and sees a floor that a lamp over them lights; else it sees through them.
template <bool in_shadow>
struct Absorption {
    // 10 faces whose t are off by some 8 u M each, M being up to 2, and sigma times the scene's size, 8, is below 8:
    // 2^10 u. Each is rounded to 2^-32 (rules 6).
    static constexpr Bound bound = at_most(0x1p-14, 0x1p-28, "of 1");

    static void render(Stage& stage, Tally& tally) {
        for (uint64_t i = 0; i < scenes(stage); ++i) {
            Draw draw(i, 53);
            const Slabs slabs(draw);
            const Writing writing = random_writing(draw, 3, 3);
            const SceneDescription scene = scene_of(slabs, draw);
            const Film film = contact::film_of(stage, written(scene, writing));
            for_each_pixel(film, scene, [&](size_t pixel, const dvec3& direction) {
                tally.place = place_of_scene(i) + pixel;
                tally.measure(magnitude(radiance(film, pixel) - expected(scene, slabs, direction)));
            });
        }
    }

  private:
    static SceneDescription scene_of(const Slabs& slabs, Draw& draw) {
        SceneDescription scene = lit_scene();
        scene.ambient = dvec3(0);
        scene.background = dvec3(in_shadow ? 0 : 1);
        scene.camera.position = {0.1, -0.2, in_shadow ? 0.8 : 5};
        scene.camera.target = {0.15, 0.05, 0};
        scene.camera.field_of_view = 16;
        scene.lights[0].position = {0.2, 0.3, 5};
        scene.lights[0].color = dvec3(1);
        MaterialDescription clear = contact::clear();
        clear.absorption = dvec3(Slabs::sigma);
        add_object(scene, slabs.wound(draw), add_material(scene, clear));
        if (in_shadow)
            add_object(scene, parallelogram({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}), add_material(scene, stone(dvec3(1))));
        return scene;
    }
    static double expected(const SceneDescription& scene, const Slabs& slabs, const dvec3& direction) {
        if (!in_shadow) return std::exp(-Slabs::sigma * slabs.thickness / magnitude(direction.z));
        const dvec3 point = scene.camera.position - direction * (scene.camera.position.z / direction.z);
        const double cosine = normalized(scene.lights[0].position - point).z;
        return cosine * std::exp(-Slabs::sigma * slabs.thickness / cosine);
    }
};

struct AbsorptionSeen : Absorption<false> {
    static constexpr const char* name = "pieces/absorption/seen";
    static constexpr const char* exact = "a white background through slabs is exp(-sigma d)";
};
struct AbsorptionInShadow : Absorption<true> {
    static constexpr const char* name = "pieces/absorption/in-shadow";
    static constexpr const char* exact = "a floor under slabs is cos a exp(-sigma d)";
};

}  // namespace cistula::verify::pieces
