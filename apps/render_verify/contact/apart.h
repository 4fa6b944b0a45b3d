// Bodies of glass that touch, and the same bodies a hair larger: the picture is that of those, never of bodies a hair
// apart, whose gaps would reflect totally.
#pragma once

#include "apps/render_verify/contact/arrangements.h"
#include "apps/render_verify/contact/compare.h"

namespace cistula::verify::contact {

inline constexpr double hair = 0x1p-12;

inline Site with_glass_bodies(const Ground& ground, Build build, Shape shape, double size) {
    Site site(ground);
    site.size = size;
    site.lift = hair / 4;
    const Parts parts{add_material(site.scene, glass(1.5, {0.1, 0.3, 0.6})),
                      add_material(site.scene, glass(1.33, {0.7, 0.2, 0.1})),
                      add_material(site.scene, paper({0.8, 0.6, 0.3})), shape};
    build(site, parts);
    look_at_it(site, build);
    site.scene.cutoff = 1e-4;
    return site;
}

template <Shape shape, Build... builds>
struct Apart {
    static constexpr const char* exact = "the picture of the bodies 2^-12 larger, with some of them within others";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Build build : {builds...})
            for (const Ground& ground : grounds) {
                const auto film = [&](double size) {
                    return film_of(stage, with_glass_bodies(ground, build, shape, size).scene);
                };
                const Film larger = film(1 + hair);
                expect_one_of(tally, film(1), {&larger}, place_of_scene(number++));
            }
    }
};

struct ApartOnFloor : Apart<Shape::planes, on_floor> {
    static constexpr const char* name = "contact/apart/on-a-floor";
};
struct ApartOnMeshFloor : Apart<Shape::planes, on_tessellated_floor> {
    static constexpr const char* name = "contact/apart/on-a-tessellated-floor";
};
struct ApartOnSolid : Apart<Shape::planes, on_solid> {
    static constexpr const char* name = "contact/apart/on-a-solid";
};
struct ApartSideBySide : Apart<Shape::planes, side_by_side> {
    static constexpr const char* name = "contact/apart/side-by-side";
};
struct ApartOverEdge : Apart<Shape::planes, over_the_edge, across_two_quads> {
    static constexpr const char* name = "contact/apart/over-the-edge";
};
struct ApartInCorner : Apart<Shape::planes, in_a_corner> {
    static constexpr const char* name = "contact/apart/in-a-corner";
};
struct ApartAlongEdge : Apart<Shape::planes, along_an_edge, at_a_vertex> {
    static constexpr const char* name = "contact/apart/along-an-edge";
};
struct ApartStack : Apart<Shape::planes, stacked> {
    static constexpr const char* name = "contact/apart/stack";
};
struct ApartConvexMeshes : Apart<Shape::convex_mesh, on_floor, side_by_side, in_a_corner> {
    static constexpr const char* name = "contact/apart/convex-meshes";
};
struct ApartMeshes : Apart<Shape::triangles, on_floor, on_tessellated_floor, over_the_edge, side_by_side> {
    static constexpr const char* name = "contact/apart/meshes";
};

}  // namespace cistula::verify::contact
