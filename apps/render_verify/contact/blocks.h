// A cube of glass cut into cubes.
#pragma once

#include <numeric>

#include "apps/render_verify/contact/compare.h"
#include "testing/draw/draw.h"

namespace cistula::verify::contact {

/// A cube on a floor, cut into `cut`^3, in an order that `seed` shuffles; 0: none.
inline SceneDescription cut_cube(const Ground& ground, int cut, uint64_t seed, Shape shape = Shape::planes) {
    Site site(ground);
    const int body = add_material(site.scene, glass(1.5, {0.1, 0.3, 0.6}));
    site.floor(add_material(site.scene, paper({0.8, 0.6, 0.3})));
    site.scene.depth = 64;
    site.scene.cutoff = 1e-4;
    std::vector<int> order(size_t(cut * cut * cut));
    std::iota(order.begin(), order.end(), 0);
    parity::Draw draw(seed, 1);
    for (size_t i = order.size() - 1; i > 0 && seed != 0; --i)
        std::swap(order[i], order[size_t(draw.between(0, int(i)))]);
    const double side = 1.2 / cut;
    for (const int i : order) {
        const int across = i % cut, along = i / cut % cut, up = i / cut / cut;
        site.cube((across + 0.5) * side - 0.6, (along + 0.5) * side - 0.6, up * side, side, 0, body, shape);
    }
    site.look({1.4, -3.6, 2.1}, {0, 0, 0.45}, 35);
    return site.scene;
}

template <int cut, int orders, Shape shape = Shape::planes>
struct Blocks {
    static constexpr const char* exact = "the picture of the cube in one piece";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Ground& ground : grounds) {
            const Film whole = film_of(stage, cut_cube(ground, 1, 0));
            for (uint64_t order = 0; order < orders; ++order)
                expect_one_of(tally, film_of(stage, cut_cube(ground, cut, order, shape)), {&whole},
                              place_of_scene(number++));
        }
    }
};
struct EightBlocks : Blocks<2, 1> {
    static constexpr const char* name = "contact/blocks/eight";
};
struct Blocks27 : Blocks<3, 1> {
    static constexpr const char* name = "contact/blocks/twenty-seven";
};
struct BlocksInAnyOrder : Blocks<2, 4> {
    static constexpr const char* name = "contact/blocks/in-any-order";
};
struct ConvexMeshBlocks : Blocks<3, 1, Shape::convex_mesh> {
    static constexpr const char* name = "contact/blocks/convex-meshes";
};
struct EightMeshes : Blocks<2, 2, Shape::triangles> {
    static constexpr const char* name = "contact/blocks/meshes";
};

}  // namespace cistula::verify::contact
