// Shadows at contacts: none leaks light, none specks, and each has the color of the faces that the light crosses.
#pragma once

#include "apps/render_verify/contact/arrangements.h"
#include "apps/render_verify/contact/compare.h"
#include "apps/render_verify/contact/straight.h"
#include "scene/description/camera_path.h"

namespace cistula::verify::contact {

/// Measures a film against the closed form, where that has an answer.
inline void measure_straight(Tally& tally, const Site& site, const Film& film, uint64_t place) {
    const int width = int(film.rect.width), height = int(film.rect.height);
    const StraightLight light(site);
    const ColorPicture picture = to_color(film);
    const Camera camera = camera_at(site.scene.camera, 0).camera;
    const dvec3 from = site.own(camera.position);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const dvec3 direction = site.own_direction(camera_direction(camera, x + 0.5, y + 0.5, width, height));
            const std::optional<dvec3> expected = light.seen(from, direction);
            if (!expected) continue;
            tally.place = place + uint64_t(y * width + x);
            const double off = difference(picture.texels[size_t(y * width + x)], glm::vec3(*expected));
            tally.measure(film.flags == 0 ? off : INFINITY);
        }
}

/// Lights from all sides, low and high.
inline void light_from_all_sides(Site& site, bool in_corner) {
    for (int i = 0; i < 3; ++i) {
        const double angle = in_corner ? 0.35 + 0.4 * i : 0.5 + 2.1 * i;
        site.light({2.2 * std::cos(angle), 2.2 * std::sin(angle), 0.4 + 0.9 * i}, dvec3(0.3));
    }
}

template <Build build>
Site with_tinted_bodies(const Ground& ground, bool near) {
    Site site(ground);
    build(site, {add_material(site.scene, clear({1, 0.5, 0.25})), add_material(site.scene, clear({0.5, 0.75, 1})),
                 add_material(site.scene, paper({0.8, 0.6, 0.3}))});
    light_from_all_sides(site, build == Build(in_a_corner));
    look_at_it(site, build);
    if (near) site.scene.camera.field_of_view = 8;
    return site;
}
template <Build build>
Site with_opaque_bodies(const Ground& ground, bool near) {
    Site site(ground);
    build(site, {add_material(site.scene, paper({0.3, 0.6, 0.8})), add_material(site.scene, paper({0.8, 0.3, 0.5})),
                 add_material(site.scene, paper({0.8, 0.6, 0.3}))});
    light_from_all_sides(site, build == Build(in_a_corner));
    look_at_it(site, build);
    if (near) site.scene.camera.field_of_view = 8;
    return site;
}

template <Site (*... sites)(const Ground&, bool near)>
struct Straight {
    static constexpr const char* exact = "every pixel that is not within 0.001 of an edge";
    static constexpr Bound bound = bound_of_colors;

    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const auto make : {sites...})
            for (const Ground& ground : grounds)
                for (const bool near : {false, true}) {
                    const Site site = make(ground, near);
                    measure_straight(tally, site, film_of(stage, site.scene), place_of_scene(number++));
                }
    }
};

struct TintedShadow : Straight<with_tinted_bodies<on_floor>, with_tinted_bodies<on_tessellated_floor>,
                               with_tinted_bodies<over_the_edge>, with_tinted_bodies<across_two_quads>> {
    static constexpr const char* name = "contact/shadows/tinted";
};
struct TintedShadowOnSolid : Straight<with_tinted_bodies<on_solid>> {
    static constexpr const char* name = "contact/shadows/tinted/on-a-solid";
};
struct OpaqueShadow
    : Straight<with_opaque_bodies<on_floor>, with_opaque_bodies<on_tessellated_floor>, with_opaque_bodies<on_solid>> {
    static constexpr const char* name = "contact/shadows/no-leak";
};
struct OpaqueNeighbors : Straight<with_opaque_bodies<side_by_side>, with_opaque_bodies<along_an_edge>,
                                  with_opaque_bodies<at_a_vertex>, with_opaque_bodies<stacked>> {
    static constexpr const char* name = "contact/shadows/neighbors";
};
struct OpaqueInCorner : Straight<with_opaque_bodies<in_a_corner>> {
    static constexpr const char* name = "contact/shadows/in-a-corner";
};
struct OpaqueOverEdge : Straight<with_opaque_bodies<over_the_edge>, with_opaque_bodies<across_two_quads>> {
    static constexpr const char* name = "contact/shadows/over-the-edge";
};

}  // namespace cistula::verify::contact
