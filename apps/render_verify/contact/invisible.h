// Bodies on paper that bend light by next to nothing: the picture is that of the paper alone. At each face a new line
// starts all the same, so that one that starts on the wrong side of a contact is seen.
#pragma once

#include "apps/render_verify/contact/arrangements.h"
#include "apps/render_verify/contact/compare.h"

namespace cistula::verify::contact {

/// Removes the objects of a material.
inline SceneDescription without(SceneDescription scene, int material) {
    std::erase_if(scene.objects, [&](const ObjectDescription& object) { return object.material == material; });
    return scene;
}

/// The index is 1 but for 2^-18: a line that crosses a face at a slope of 1/8 or more is turned by 2^-15 at most.
inline MaterialDescription next_to_nothing() {
    MaterialDescription material = clear();
    material.index = 1 + 0x1p-18;
    return material;
}

inline Site with_clear_bodies(const Ground& ground, Build build, Shape shape) {
    Site site(ground);
    const int body = add_material(site.scene, next_to_nothing());
    const int floor = add_material(site.scene, paper({0.8, 0.6, 0.3}));
    build(site, {body, body, floor, shape});
    look_at_it(site, build);
    light_it(site, build);
    return site;
}

/// Lines are turned at up to eight faces, over ways of up to 2: what is seen is displaced by less than 2^-11, and
/// colors of the paper change by less than 1/2 per unit of length.
inline constexpr Bound bound_of_displaced = at_most(0x1p-12, "of 1");

template <Shape shape, Build... builds>
struct Invisible {
    static constexpr const char* exact = "the colors of the paper alone";
    static constexpr Bound bound = bound_of_displaced;

    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Build build : {builds...})
            for (const Ground& ground : grounds) {
                const Site site = with_clear_bodies(ground, build, shape);
                measure_difference(tally, film_of(stage, site.scene), film_of(stage, without(site.scene, 1)),
                                   place_of_scene(number++));
            }
    }
};

struct InvisibleOnFloor : Invisible<Shape::planes, on_floor> {
    static constexpr const char* name = "contact/invisible/on-a-floor";
};
struct InvisibleOnMeshFloor : Invisible<Shape::planes, on_tessellated_floor> {
    static constexpr const char* name = "contact/invisible/on-a-tessellated-floor";
};
struct InvisibleOnSolid : Invisible<Shape::planes, on_solid> {
    static constexpr const char* name = "contact/invisible/on-a-solid";
};
struct InvisibleSideBySide : Invisible<Shape::planes, side_by_side> {
    static constexpr const char* name = "contact/invisible/side-by-side";
};
struct InvisibleOverEdge : Invisible<Shape::planes, over_the_edge, across_two_quads> {
    static constexpr const char* name = "contact/invisible/over-the-edge";
};
struct InvisibleInCorner : Invisible<Shape::planes, in_a_corner> {
    static constexpr const char* name = "contact/invisible/in-a-corner";
};
struct InvisibleAlongEdge : Invisible<Shape::planes, along_an_edge, at_a_vertex> {
    static constexpr const char* name = "contact/invisible/along-an-edge";
};
struct InvisibleStack : Invisible<Shape::planes, stacked> {
    static constexpr const char* name = "contact/invisible/stack";
};
struct InvisibleConvexMeshes : Invisible<Shape::convex_mesh, on_floor, in_a_corner, stacked> {
    static constexpr const char* name = "contact/invisible/convex-meshes";
};
struct InvisibleMeshes : Invisible<Shape::triangles, on_floor, on_tessellated_floor, over_the_edge> {
    static constexpr const char* name = "contact/invisible/meshes";
};
struct InvisibleMeshesInCorner : Invisible<Shape::triangles, side_by_side, in_a_corner, stacked> {
    static constexpr const char* name = "contact/invisible/meshes/side-by-side";
};

/// Every Platonic solid on each kind of its faces, turned as it comes.
struct InvisibleSolids {
    static constexpr const char* name = "contact/invisible/solids";
    static constexpr const char* exact = "the colors of the paper alone, under every face of the Platonic solids";
    static constexpr Bound bound = bound_of_displaced;

    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const PlatonicSolid kind : platonic_solids)
            for (size_t face = 0; face < platonic_shape(kind).faces.size(); face += stage.quick ? 3 : 1) {
                const SolidObject solid = solid_object(kind, {2.3, -1.7, 0.6}, 0.7, {20 + 7.0 * double(face), 35, 50});
                Site site(solid, face);
                const int body = add_material(site.scene, next_to_nothing());
                site.floor(add_material(site.scene, paper({0.8, 0.6, 0.3})));
                add_object(site.scene, solid, body);
                look_at_it(site, on_floor);
                light_it(site, on_floor);
                measure_difference(tally, film_of(stage, site.scene), film_of(stage, without(site.scene, body)),
                                   place_of_scene(number++));
            }
    }
};

}  // namespace cistula::verify::contact
