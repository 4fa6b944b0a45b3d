// Lights on the edges of an opaque convex solid lie in the planes of two of its faces and behind all others: they light
// none of them, exactly.
#include <gtest/gtest.h>

#include "cistula/numerics/fixed_sum.h"
#include "scene/compile/compiled_scene.h"
#include "scene/description/platonic.h"
#include "testing/support/golden.h"
#include "testing/support/scene.h"
#include "testing/support/scene_samples.h"

using namespace cistula;

namespace {

constexpr int lights_on_an_edge = 3;

/// Off center and turned, so that planes, corners and lights are all rounded.
SolidObject lit_solid(PlatonicSolid kind) {
    SolidObject solid = samples::solid(kind, {0.3, -0.2, 0.7}, 1.1);
    solid.rotation = {17, 41, 73};
    return solid;
}

/// No light but that of the edges; the same solid as planes, or as a closed mesh with plain lights.
SceneDescription lit_by_its_edges(PlatonicSolid kind, bool mesh, double exponent) {
    SceneDescription scene = samples::empty_scene();
    scene.ambient = glm::dvec3{0};
    scene.materials[0].specular = 1;
    scene.materials[0].exponent = exponent;
    SolidObject solid = lit_solid(kind);
    if (!mesh) {
        solid.edge_lights.count = lights_on_an_edge;
        samples::add_object(scene, solid);
        return scene;
    }
    const TrianglesObject triangles = triangulated_solid(solid);
    for (const auto& edge : platonic_shape(kind).edges) {
        const glm::dvec3 &a = triangles.vertices[edge.vertices[0]], &b = triangles.vertices[edge.vertices[1]];
        for (int i = 0; i < lights_on_an_edge; ++i)
            samples::add_light(scene, a + (i + 1.0) / (lights_on_an_edge + 1.0) * (b - a));
    }
    samples::add_object(scene, triangles);
    return scene;
}

struct Seen {
    size_t solid = 0, lit = 0;  // pixels
    double brightest = 0;       // of the sums, in the scene's units
};

template <class Real>
Seen look(const SceneDescription& scene) {
    FrameSettings settings;
    settings.set_size(120, 90);
    settings.depth = 2;
    Seen seen;
    const auto renderer = make_embree_renderer<Real>(compile_scene<Real>(scene));
    for (const glm::dvec3& position : {glm::dvec3{0.4, -4, 1.5}, glm::dvec3{3.1, 2.2, 2.9}, glm::dvec3{-2, 1.3, -2.4},
                                       glm::dvec3{0.31, -0.22, 5.7}}) {
        SceneDescription from = scene;
        from.camera.position = position;
        from.camera.target = {0.3, -0.2, 0.7};
        from.camera.field_of_view = 45;
        const Film film = golden::render_with(*renderer, from, settings);
        EXPECT_EQ(film.flags, 0u);
        const double unit = elementary::power_of_two(film.radiance_exponent) / fixed_scale(film.fixed_shift);
        for (const PixelRecord& pixel : film.pixels) {
            seen.solid += pixel.id != 0;
            const int64_t most = std::max({pixel.radiance[0], pixel.radiance[1], pixel.radiance[2]});
            seen.lit += most != 0;
            seen.brightest = std::max(seen.brightest, double(most) * unit);
        }
    }
    return seen;
}

template <class Real>
class LightsOnFaces : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(LightsOnFaces, Reals);

TYPED_TEST(LightsOnFaces, LeaveTheirSolidBlack) {
    for (const PlatonicSolid kind : test::platonic_solids)
        for (const bool mesh : {false, true})
            for (const double exponent : {2.0, 110.0}) {
                const Seen seen = look<TypeParam>(lit_by_its_edges(kind, mesh, exponent));
                EXPECT_EQ(seen.lit, 0u) << platonic_name(kind) << (mesh ? " of triangles" : " of planes")
                                        << ", exponent " << exponent << ": the brightest sum is " << seen.brightest;
                EXPECT_GT(seen.solid, 4000u);
            }
}

/// A light off the faces does light these scenes: they are not black for another reason.
TYPED_TEST(LightsOnFaces, OneThatStandsOffLightsTheSolid) {
    for (const PlatonicSolid kind : test::platonic_solids)
        for (const bool mesh : {false, true}) {
            SceneDescription scene = lit_by_its_edges(kind, mesh, 2);
            samples::add_light(scene, {0.4, -4, 5});
            const Seen seen = look<TypeParam>(scene);
            EXPECT_GT(seen.lit, seen.solid / 4) << platonic_name(kind);
            EXPECT_GT(seen.brightest, 0.25) << platonic_name(kind);
        }
}

}  // namespace
