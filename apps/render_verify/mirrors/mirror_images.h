// Helpers for images of mirrors: materials without local light, cameras, and sums in integers.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/mirrors/bounces_inside.h"
#include "apps/render_verify/mirrors/folded_paths.h"
#include "apps/render_verify/stage.h"

namespace cistula::verify::mirrors {

/// A material with local light 1 in the share that is neither reflected nor transmitted.
inline MaterialDescription share_material(const char* name, double reflection, double transmission) {
    MaterialDescription material;
    material.name = name;
    material.color = glm::dvec3(1);
    material.ambient = 1;
    material.diffuse = 0;
    material.reflection = reflection;
    material.transmission = transmission;
    return material;
}

/// A scene with ambient light 1, no objects, one material.
inline SceneDescription share_scene(double reflection, double transmission, double background) {
    SceneDescription scene = empty_scene();
    scene.materials = {share_material("mirror", reflection, transmission)};
    scene.ambient = glm::dvec3(1);
    scene.background = glm::dvec3(background);
    return scene;
}

inline Film film_of(const Stage& stage, SceneDescription scene, const glm::dvec3& from, const glm::dvec3& to,
                    double field_of_view, int size, int depth) {
    scene.camera.position = from;
    scene.camera.target = to;
    scene.camera.field_of_view = field_of_view;
    scene.depth = depth;
    return stage.render(scene, size, size);
}

/// Radiance 1 in units of the sums, in scenes whose brightest radiance is 1: B is 1 + 2^-10 there, and sums are scaled
/// by the next power of two.
inline constexpr int64_t whole = int64_t(1) << 61;
inline constexpr int64_t bound_of_whole = whole + (whole >> 10);

/// Whether the sums of a film are in the units of `whole`.
inline bool counts_in_wholes(const Film& film) {
    return film.flags == 0 && film.fixed_shift == 62 && film.radiance_exponent == 1 && film.samples == 1;
}

inline int64_t ledger(const PixelRecord& pixel, int channel) {
    return pixel.cut[channel] + pixel.pruned[channel];
}

/// Calls check(pixel, channel) for all, with places `first` and following; returns whether the film's units are those
/// of `whole`.
template <class Check>
void for_each_sum(Tally& tally, uint64_t first, const Film& film, const Check& check) {
    tally.place = first;
    tally.expect(counts_in_wholes(film));
    for (const PixelRecord& pixel : film.pixels) {
        tally.place = ++first;
        for (int channel = 0; channel < 3; ++channel) check(pixel, channel);
    }
}

/// A solid for cameras inside: an inner point, and the radius around it that is inside, too.
struct Body {
    SceneDescription scene;
    glm::dvec3 middle;
    double around;
};

/// Five solids as planes and as triangles, then a torus, a star and a bumpy sphere, with material 0 of `scene`.
inline std::vector<Body> bodies(const SceneDescription& scene) {
    std::vector<Body> all;
    for (const Shape shape : {Shape::planes, Shape::triangles})
        for (const PlatonicSolid kind : platonic_solids) {
            Body body{scene, glm::dvec3(0), 0.25 * platonic_shape(kind).inradius};
            add_solid(body.scene, shape, solid_object(kind, glm::dvec3(0), 1, glm::dvec3(31, 47, 11)));
            all.push_back(body);
        }
    const auto meshes = closed_meshes();
    for (const size_t number : {0, 2, 4}) {
        Body body{scene, meshes[number].middle, meshes[number].around};
        add_object(body.scene, meshes[number].mesh);
        all.push_back(body);
    }
    return all;
}

/// Lossless mirrors around the camera in a white world: every path ends at the depth limit, and none sees the white.
struct DepthEnds {
    static constexpr const char* name = "mirrors/depth-1024";
    static constexpr const char* exact = "in opaque mirrors a pixel takes 1,024 rays, stays black, and its ledger is B";
    static constexpr Bound bound = no_failures("sums");
    static void render(Stage& stage, Tally& tally) {
        const int size = stage.quick ? 3 : 16;
        uint64_t place = 0;
        for (const Body& body : bodies(share_scene(1, 0, 1))) {
            const glm::dvec3 from = body.middle + body.around * glm::dvec3(0.3, -0.2, 0.1);
            const Film film = film_of(stage, body.scene, from, from + glm::dvec3(0.3, 1, -0.2), 100, size, 1024);
            for_each_sum(tally, place, film, [&](const PixelRecord& pixel, int c) {
                tally.expect(pixel.radiance[c] == 0 && pixel.rays == 1024 && pixel.cut[c] == bound_of_whole &&
                             pixel.pruned[c] == 0);
            });
            place += 1000;
        }
    }
};

/// Two mirrors that reflect half and emit the other half: 1/2 + 1/4 + ... after `depth` surfaces.
struct ParallelSum {
    static constexpr const char* name = "mirrors/parallel/image";
    static constexpr const char* exact =
        "between half mirrors a pixel is 1 - 2^-depth, its ledger 2^-depth B, its rays depth";
    static constexpr Bound bound = no_failures("sums");
    static void render(Stage& stage, Tally& tally) {
        const int size = stage.quick ? 6 : 32;
        for (const Shape shape : {Shape::planes, Shape::triangles}) {
            SceneDescription scene = share_scene(0.5, 0, 0);
            for (const double side : {-1.0, 1.0})
                if (shape == Shape::planes)
                    add_object(scene, solid_object(PlatonicSolid::cube, {0, side * 1.015625, 0}, std::sqrt(3.0)));
                else
                    add_object(scene, square_across_y(side * 0.015625, 1));
            for (const int depth : {1, 2, 3, 10, 40}) {
                const Film film = film_of(stage, scene, {0, 0.001, 0}, {0.01, 1, 0.02}, 40, size, depth);
                for_each_sum(tally, uint64_t(depth) * 10000 + (shape == Shape::planes ? 0 : 5000), film,
                             [&](const PixelRecord& pixel, int c) {
                                 tally.expect(pixel.radiance[c] == whole - (whole >> depth) &&
                                              pixel.cut[c] == bound_of_whole >> depth && pixel.pruned[c] == 0 &&
                                              pixel.rays == uint32_t(depth));
                             });
            }
        }
    }
};

}  // namespace cistula::verify::mirrors
