#include "scene/compile/materials/required_effects.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/compile/compiled_scene.h"
#include "scene/description/rotation.h"
#include "testing/support/scene.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using samples::add_light;
using samples::add_object;
using samples::empty_scene;
using samples::solid;
using samples::square;

std::string because(const SceneDescription& scene, uint32_t effect) {
    for (const EffectReason& reason : explain_effects(scene))
        if (reason.effect == effect) return reason.because;
    return "";
}

/// Both ways to find out agree.
uint32_t effects_of(const SceneDescription& scene) {
    const uint32_t effects = required_effects(scene);
    const auto compiled = compile_scene<float>(scene);
    EXPECT_EQ(compiled->effects, effects);
    EXPECT_EQ(required_effects(compiled->effect_reasons), effects);
    return effects;
}

SceneDescription lit_cube() {
    SceneDescription scene = empty_scene();
    add_object(scene, solid(PlatonicSolid::cube));
    add_light(scene, {0, 0, 4});
    return scene;
}

TEST(RequiredEffects, EveryEffectIsExplainedInOrder) {
    const auto reasons = explain_effects(lit_cube());
    ASSERT_EQ(reasons.size(), size_t(effect_count));
    for (int i = 0; i < effect_count; ++i) {
        EXPECT_EQ(reasons[i].effect, 1u << i);
        EXPECT_FALSE(reasons[i].because.empty());
    }
}

TEST(RequiredEffects, AnUnlitSceneNeedsNone) {
    SceneDescription scene = empty_scene();
    add_object(scene, solid(PlatonicSolid::cube));
    EXPECT_EQ(effects_of(scene), uint32_t(effect_solids));
    add_light(scene, {0, 0, 3}, glm::dvec3{0}).radius = 0.5;
    EXPECT_EQ(effects_of(scene), effect_solids | effect_visible_lights);
    EXPECT_EQ(because(scene, effect_visible_lights), "the light /lights/0 is seen");
    EXPECT_EQ(because(scene, effect_diffuse), "no light has an intensity above 0");
}

/// A cube on a floor that is 10^5 to 10^9 times as large, off its middle and turned, touches it in double precision.
TEST(RequiredEffects, ContactsAreFoundOnLargeTurnedFloors) {
    test::Random random(3);
    for (const double half : {1e5, 1e7, 1e9})
        for (int trial = 0; trial < 20; ++trial) {
            const glm::dvec3 angles = random.in_cube(180),
                             place(random.between(-half, half), random.between(-half, half), 0);
            const Rotation rotation(angles);
            SceneDescription scene = empty_scene();
            TrianglesObject floor = square(half);
            for (glm::dvec3& p : floor.vertices) p = rotation(p);
            add_object(scene, floor);
            SolidObject cube = solid(PlatonicSolid::cube, rotation(place + glm::dvec3(0, 0, 0.5)), std::sqrt(0.75));
            cube.rotation = angles;
            add_object(scene, cube);
            const std::vector<EffectReason> reasons = explain_effects(scene, Precision::double_);
            EXPECT_TRUE(required_effects(reasons) & effect_contacts) << half << ' ' << trial;
        }
}

TEST(RequiredEffects, AnOpaqueCubeUnderALight) {
    SceneDescription scene = lit_cube();
    EXPECT_EQ(effects_of(scene), effect_solids | effect_diffuse | effect_opaque_shadows);
    EXPECT_EQ(because(scene, effect_solids), "material plain of /objects/0 is on a convex solid");
    EXPECT_EQ(because(scene, effect_triangles), "there is neither mesh nor sheet");
    EXPECT_EQ(because(scene, effect_insides), "no closed body lets rays pass; a camera in one adds it");
    EXPECT_EQ(because(scene, effect_diffuse), "material plain of /objects/0 has kd 1");
    EXPECT_EQ(because(scene, effect_opaque_shadows), "material plain of /objects/0 has kt 0");
    EXPECT_EQ(because(scene, effect_refraction), "no material lets rays pass");
    scene.materials[0].specular = 0.5;
    EXPECT_EQ(effects_of(scene), opaque_bodies & ~(effect_texture | effect_triangles));
    scene.materials[0].diffuse = 0;
    EXPECT_EQ(effects_of(scene), opaque_bodies & ~(effect_texture | effect_triangles | effect_diffuse));
}

TEST(RequiredEffects, MirrorsAndGlass) {
    SceneDescription scene = lit_cube();
    auto& m = scene.materials[0];
    m.reflection = 0.1;
    EXPECT_EQ(effects_of(scene), effect_solids | effect_diffuse | effect_opaque_shadows | effect_reflection);
    EXPECT_EQ(because(scene, effect_reflection), "material plain of /objects/0 has kr 0.1");
    m.transmission = 0.5;
    const uint32_t glassy = effect_solids | effect_diffuse | effect_transparent_shadows | effect_reflection |
                            effect_transmission | effect_insides;
    EXPECT_EQ(effects_of(scene), glassy);
    EXPECT_EQ(because(scene, effect_insides), "material plain of /objects/0 lets rays into a closed body");
    EXPECT_EQ(because(scene, effect_tint), "what passes keeps its color");
    m.tint = glm::dvec3{0.5};
    EXPECT_EQ(effects_of(scene), glassy);
    EXPECT_EQ(because(scene, effect_opaque_shadows), "every material lets every color pass");
    EXPECT_EQ(because(scene, effect_refraction), "no solid has an index other than 1");
    m.tint = {1, 1, 0};
    EXPECT_EQ(effects_of(scene), glassy | effect_opaque_shadows | effect_tint);
    EXPECT_EQ(because(scene, effect_tint), "material plain of /objects/0 has a tint");
    m.index = 1.5;
    EXPECT_EQ(effects_of(scene), glassy | effect_opaque_shadows | effect_tint | effect_refraction);
    EXPECT_EQ(because(scene, effect_refraction), "material plain of /objects/0 has index 1.5");
    m.absorption.y = 1;
    m.fresnel = true;
    EXPECT_EQ(effects_of(scene),
              glassy | effect_opaque_shadows | effect_tint | effect_refraction | effect_absorption | effect_fresnel);
}

TEST(RequiredEffects, TotalReflectionAndFresnelCallForReflectionToo) {
    SceneDescription scene = lit_cube();
    auto& m = scene.materials[0];
    m.transmission = 0.5;
    m.index = 1.5;
    EXPECT_TRUE(effects_of(scene) & effect_reflection);
    EXPECT_EQ(because(scene, effect_reflection), "material plain of /objects/0 has index 1.5: total reflection");
    m.index = 1;
    EXPECT_FALSE(effects_of(scene) & effect_reflection);
    m.transmission = 0;
    m.reflection = 0.5;
    m.fresnel = true;
    EXPECT_TRUE(effects_of(scene) & effect_transmission);
}

/// No ray enters an opaque body, so that its index and absorption call for nothing.
TEST(RequiredEffects, OpaqueBodiesAreNoMedia) {
    SceneDescription scene = lit_cube();
    auto& m = scene.materials[0];
    m.index = 1.5;
    m.absorption.x = 1;
    const uint32_t opaque = effect_solids | effect_diffuse | effect_opaque_shadows;
    EXPECT_EQ(effects_of(scene), opaque);
    scene.materials.push_back(m);  // of a pane, which rays pass
    scene.materials[1].transmission = 0.5;
    scene.materials[1].absorption = glm::dvec3{0};
    add_object(scene, square(), 1);
    EXPECT_FALSE(effects_of(scene) & (effect_refraction | effect_absorption | effect_insides));
    scene.objects.pop_back();
    scene.materials[0].transmission = 0.5;
    scene.materials[0].tint = glm::dvec3{0};
    EXPECT_FALSE(effects_of(scene) & (effect_transmission | effect_insides | effect_absorption));
    scene.materials[0].fresnel = true;
    EXPECT_EQ(effects_of(scene) & (effect_reflection | effect_fresnel | effect_insides),
              effect_reflection | effect_fresnel);
}

TEST(RequiredEffects, SheetsHaveNoInside) {
    SceneDescription scene = empty_scene();
    auto& m = scene.materials[0];
    m.transmission = 0.5;
    m.index = 1.5;
    m.absorption.x = 1;
    add_object(scene, square());
    EXPECT_EQ(effects_of(scene), effect_triangles | effect_transmission);
    EXPECT_EQ(compile_scene<float>(scene)->warnings.size(), 1u);
    add_object(scene, torus(2, 0.5, 8, 6));
    EXPECT_EQ(effects_of(scene), effect_triangles | effect_insides | effect_transmission | effect_reflection |
                                     effect_refraction | effect_absorption);
}

TEST(RequiredEffects, TexturesWhereTheyShow) {
    SceneDescription scene = empty_scene();
    scene.textures.resize(1);
    auto& m = scene.materials[0];
    m.texture = 0;
    add_object(scene, square());
    EXPECT_EQ(effects_of(scene), effect_triangles | effect_texture);  // by ambient light
    scene.ambient = glm::dvec3{0};
    EXPECT_EQ(effects_of(scene), uint32_t(effect_triangles));
    add_light(scene, {0, 0, 2});
    EXPECT_EQ(effects_of(scene), effect_triangles | effect_texture | effect_diffuse | effect_opaque_shadows);
    m.reflection = 1;
    EXPECT_EQ(effects_of(scene), effect_triangles | effect_reflection);
}

TEST(RequiredEffects, LightsOnEdgesAndFalloff) {
    SceneDescription scene = empty_scene();
    SolidObject object = solid(PlatonicSolid::octahedron);
    object.edge_lights.count = 2;
    object.edge_lights.radius = 0.05;
    add_object(scene, object);
    const uint32_t seen =
        effect_solids | effect_diffuse | effect_opaque_shadows | effect_visible_lights | effect_lights_on_faces;
    EXPECT_EQ(effects_of(scene), seen);
    EXPECT_EQ(because(scene, effect_visible_lights), "the lights on the edges of /objects/0 are seen");
    std::get<SolidObject>(scene.objects[0].shape).edge_lights.falloff = true;
    EXPECT_EQ(effects_of(scene), seen | effect_light_falloff);
}

TEST(RequiredEffects, LightsOnFaces) {
    SceneDescription scene = lit_cube();
    EXPECT_FALSE(effects_of(scene) & effect_lights_on_faces);
    EXPECT_EQ(because(scene, effect_lights_on_faces), "no light with a color lies on a face or edge");
    EdgeLights& on_edges = std::get<SolidObject>(scene.objects[0].shape).edge_lights;
    on_edges.count = 1;
    EXPECT_TRUE(effects_of(scene) & effect_lights_on_faces);
    EXPECT_EQ(because(scene, effect_lights_on_faces), "the lights on the edges of /objects/0 lie on its faces");
    on_edges.color = glm::dvec3{0};
    EXPECT_FALSE(effects_of(scene) & effect_lights_on_faces);

    add_object(scene, square(3, -2));
    add_light(scene, {0.5, 0.25, -2});
    EXPECT_TRUE(effects_of(scene) & effect_lights_on_faces);
    EXPECT_EQ(because(scene, effect_lights_on_faces), "the light /lights/1 lies on a face of /objects/1");
    scene.lights[1].position.z += 1e-4;
    EXPECT_FALSE(effects_of(scene) & effect_lights_on_faces);
    scene.lights[1].position = {3.5, 0, -2};  // beside it
    EXPECT_FALSE(effects_of(scene) & effect_lights_on_faces);
    const double half = 1 / std::sqrt(3.0);
    scene.lights[1].position = {half, 0.1, 0.2};
    EXPECT_EQ(because(scene, effect_lights_on_faces), "the light /lights/1 lies on a face of /objects/0");
    for (MaterialDescription& material : scene.materials) material.diffuse = 0;
    EXPECT_FALSE(effects_of(scene) & effect_lights_on_faces);
    EXPECT_EQ(because(scene, effect_lights_on_faces), "no surface shows light of any lamp");
}

TEST(RequiredEffects, UnusedMaterialsCallForNothing) {
    SceneDescription scene = lit_cube();
    scene.materials.push_back(samples::material("glass", 0.5, 0.5));
    EXPECT_EQ(effects_of(scene), effect_solids | effect_diffuse | effect_opaque_shadows);
}

}  // namespace
}  // namespace cistula
