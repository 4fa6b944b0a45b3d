// The generated scenes that backends are compared on are the same everywhere, and every intersector of the host renders
// them to the same integers. CISTULA_GENERATED_STEP=1 renders them all, not every eighth.
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "backend_embree/embree/embree_renderer.h"
#include "render/record/film_difference.h"
#include "scene/compile/scene_hash.h"
#include "scene/description/camera_path.h"
#include "testing/support/shipped_scenes.h"
#include "verify/reference_renderers.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;
using glm::dvec3;

namespace {

/// Hash of the numbers in a scene that come from random draws and formulas.
std::string digest(const SceneDescription& scene) {
    SceneHash hash;
    for (const ObjectDescription& object : scene.objects) {
        if (const auto* solid = std::get_if<SolidObject>(&object.shape)) {
            for (const dvec3& v : {solid->center, solid->rotation, dvec3(solid->radius, solid->edge_lights.count, 0)})
                hash.add(v);
        } else if (const auto* ball = std::get_if<SphereObject>(&object.shape)) {
            for (const dvec3& v : {ball->center, ball->rotation, dvec3(ball->radius)}) hash.add(v);
        } else if (const auto* disk = std::get_if<DiskObject>(&object.shape)) {
            for (const dvec3& v : {disk->center, disk->normal, dvec3(disk->radius)}) hash.add(v);
        } else if (const auto* mesh = std::get_if<TrianglesObject>(&object.shape)) {
            for (const dvec3& v : mesh->vertices) hash.add(v);
            hash.add_bytes(mesh->triangles.data(), mesh->triangles.size() * sizeof(mesh->triangles[0]));
        }
    }
    for (const MaterialDescription& m : scene.materials)
        for (const dvec3& v : {m.color, m.tint, m.absorption, dvec3(m.reflection, m.transmission, m.index),
                               dvec3(m.diffuse, m.specular, m.exponent)})
            hash.add(v);
    for (const LightDescription& light : scene.lights)
        for (const dvec3& v : {light.position, light.color, dvec3(light.radius)}) hash.add(v);
    const Camera camera = camera_at(scene.camera, 0).camera;
    for (const dvec3& v : {camera.position, camera.forward, camera.up, dvec3(scene.depth, scene.cutoff, 0)})
        hash.add(v);
    return hash.hex();
}

/// Other compilers, other machines: these very scenes. Whoever changes how they are made puts the new number here.
TEST(GeneratedScenes, AreTheSameEverywhere) {
    SceneHash all;
    for (uint64_t seed = 0; seed < generated_scene_count; ++seed) {
        const std::string hash = digest(generated_scene(seed));
        all.add_bytes(hash.data(), hash.size());
    }
    EXPECT_EQ(all.hex(), "05955c0e9fe99709022ab344e54e0dfc");
}

// ---- what they look like

uint64_t step() {
    const char* text = std::getenv("CISTULA_GENERATED_STEP");
    const long value = text ? std::atol(text) : 0;
    return value > 0 ? uint64_t(value) : 8;
}

Film film_of(Renderer& renderer, const SceneDescription& scene) {
    Film film;
    RenderProgress progress;
    renderer.render(camera_at(scene.camera, 0), generated_settings(scene), film, progress);
    return film;
}

template <class Real>
class GeneratedImages : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(GeneratedImages, Reals);

TYPED_TEST(GeneratedImages, AreEqualBitForBitByEveryIntersector) {
    using Real = TypeParam;
    uint64_t rays = 0, scenes = 0, seen = 0;
    for (uint64_t seed = 0; seed < generated_scene_count; seed += step()) {
        const SceneDescription scene = generated_scene(seed, test::scene_folder);
        const std::shared_ptr<const CompiledScene<Real>> plain = compile_scene<Real>(scene);
        std::shared_ptr<CompiledScene<Real>> treed = compile_scene<Real>(scene);
        build_primitive_tree(*treed, 1);
        EmbreeOptions always;
        always.always_tree = true;
        const Film expected = film_of(*make_host_renderer<Real>(plain, HostIntersector::brute), scene);
        const std::string hash = record_hash(expected);
        EXPECT_EQ(expected.flags, 0u) << "seed " << seed;
        const auto check = [&](std::unique_ptr<Renderer> renderer, const char* name) {
            const Film film = film_of(*renderer, scene);
            EXPECT_EQ(film.flags, 0u) << "seed " << seed << ", " << name;
            EXPECT_EQ(record_hash(film), hash) << "seed " << seed << ", " << name;
            EXPECT_EQ(film.rays.total(), expected.rays.total()) << "seed " << seed << ", " << name;
        };
        check(make_embree_renderer<Real>(plain), "embree");
        check(make_embree_renderer<Real>(plain, always), "embree with a tree always");
        check(make_host_renderer<Real>(treed, HostIntersector::bvh), "bvh");
        ++scenes;
        rays += expected.rays.total();
        size_t hit = 0;
        for (const PixelRecord& pixel : expected.pixels) hit += pixel.hits > 0;
        seen += 20 * hit > expected.pixels.size();
    }
    EXPECT_GE(20 * seen, 19 * scenes) << "scenes that show something";
    EXPECT_GE(rays, 10000 * scenes);
}

}  // namespace
