// Sheets that lie on sheets and on faces of solids: the one declared later is seen.
#pragma once

#include "apps/render_verify/contact/compare.h"

namespace cistula::verify::contact {

/// What decals lie on.
enum class Under { floor, tessellated_floor, solid, mesh };

/// Overlapping decals on something, each `lift` above the one before. `first`: which of the two comes first.
inline SceneDescription with_decals(const Ground& ground, Under under, double lift, int first, bool lit) {
    Site site(ground);
    site.lift = lift;
    const int plain = add_material(site.scene, paper({0.8, 0.6, 0.3}));
    const int red = add_material(site.scene, paper({0.9, 0.1, 0.1}));
    TextureDescription checker;
    checker.name = "checker";
    checker.checker = {dvec3(0.9), dvec3(0.2, 0.2, 0.6)};
    checker.repeat = {3, 3};
    site.scene.textures.push_back(checker);
    MaterialDescription checkered = paper(dvec3(1));
    checkered.texture = 0;
    const int squares = add_material(site.scene, checkered);
    MaterialDescription film = clear({0.5, 0.8, 1});
    film.transmission = 0.7;
    const int foil = add_material(site.scene, film);
    if (under == Under::floor) site.floor(plain);
    if (under == Under::tessellated_floor) site.tessellated_floor(plain, 9);
    if (under == Under::solid || under == Under::mesh)
        site.cube(0, 0, -2, 2, 0, plain, under == Under::solid ? Shape::planes : Shape::triangles);
    for (int i = 0; i < 2; ++i) {
        if ((first + i) % 2 == 0)
            site.decal({-0.7, -0.6, 0}, {1, 0.2, 0}, {-0.2, 1, 0}, red);
        else
            site.decal({-0.2, -0.3, 0}, {0.9, -0.3, 0}, {0.25, 0.75, 0}, squares);
    }
    if (!lit) site.decal({-0.9, -0.1, 0}, {1.9, 0, 0}, {0, 0.25, 0}, foil);  // ambient light alone: see the case
    if (under == Under::solid || under == Under::mesh)
        site.decal({-0.5, -1, -0.5}, {1, 0, 0}, {0, 0, 0.4}, squares);  // on its side
    site.look({0.8, -2.6, 2.1}, {0, 0, 0}, 45);
    if (lit) site.light({1.8, -1.5, 3.2});
    return site.scene;
}

/// A foil lets most of a light through and is itself no obstacle to the light of what it lies on: with lights it
/// differs from one that is raised, so it is there in ambient light alone.
template <Under... unders>
struct Decals {
    static constexpr const char* exact = "the picture with each decal raised by 2^-14";
    static constexpr Bound bound = no_failures("pixels");

    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Under under : {unders...})
            for (const Ground& ground : grounds)
                for (const int first : {0, 1})
                    for (const bool lit : {false, true}) {
                        const Film raised = film_of(stage, with_decals(ground, under, 0x1p-14, first, lit));
                        expect_one_of(tally, film_of(stage, with_decals(ground, under, 0, first, lit)), {&raised},
                                      place_of_scene(number++));
                    }
    }
};
struct DecalsOnFloor : Decals<Under::floor> {
    static constexpr const char* name = "contact/decals/on-a-floor";
};
struct DecalsOnMeshFloor : Decals<Under::tessellated_floor> {
    static constexpr const char* name = "contact/decals/on-a-tessellated-floor";
};
struct DecalsOnSolid : Decals<Under::solid> {
    static constexpr const char* name = "contact/decals/on-a-solid";
};
struct DecalsOnMesh : Decals<Under::mesh> {
    static constexpr const char* name = "contact/decals/on-a-mesh";
};

/// A label on the face of a glass cube, seen from without and through the glass.
struct LabelOnGlass {
    static constexpr const char* name = "contact/decals/on-glass";
    static constexpr const char* exact = "each pixel is one of the label raised by 2^-14, or one of it lowered";
    static constexpr Bound bound = no_failures("pixels");

    static SceneDescription with_label(const Ground& ground, double lift, bool on_top) {
        Site site(ground);
        site.lift = lift;
        site.cube(0, 0, -1, 2, 0, add_material(site.scene, glass(1.5)));
        const int red = add_material(site.scene, paper({0.9, 0.1, 0.1}));
        if (on_top)
            site.decal({-0.7, -0.6, 1}, {1, 0.2, 0}, {-0.2, 1, 0}, red);
        else
            site.decal({0.6, 1, -0.7}, {-1, 0, 0.2}, {0.2, 0, 1}, red);  // behind the glass
        site.look({1.2, -3.6, 3.1}, {0, 0, 0}, 45);
        site.light({1.8, -1.5, 3.2});
        site.scene.cutoff = 1e-4;
        return site.scene;
    }
    static void render(Stage& stage, Tally& tally) {
        uint64_t number = 0;
        for (const Ground& ground : grounds)
            for (const bool on_top : {true, false}) {
                const auto film = [&](double lift) { return film_of(stage, with_label(ground, lift, on_top)); };
                const Film raised = film(0x1p-14), lowered = film(-0x1p-14);
                expect_one_of(tally, film(0), {&raised, &lowered}, place_of_scene(number++));
            }
    }
};

}  // namespace cistula::verify::contact
