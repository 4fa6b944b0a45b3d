// A light that is seen has an id, a depth and a normal of its own, in each intersector, precision and kind of sampling.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/compile/compiled_scene.h"
#include "scene/compile/scene_names.h"
#include "testing/support/golden.h"
#include "testing/support/scene_samples.h"
#include "verify/reference_renderers.h"

namespace cistula {
namespace {

constexpr int width = 64, height = 48;

/// A sheet at y = 4, a cube with lights on its edges, which stand out, and lights before, behind and beside them.
SceneDescription lit() {
    SceneDescription scene = samples::empty_scene();
    scene.materials.push_back(samples::material("clear", 0, 1));
    scene.camera.position = {0.25, -6, 0.5};
    scene.camera.target = {0, 0, 0.25};
    scene.background = glm::dvec3(0.125);
    TrianglesObject wall = samples::square(2, 0);
    for (glm::dvec3& corner : wall.vertices) corner = {corner.x, 4, corner.y};
    samples::add_object(scene, wall);
    SolidObject cube = samples::solid(PlatonicSolid::cube, {0.5, 0.5, 0}, 1.5);
    cube.rotation = {10, 20, 30};
    cube.edge_lights.count = 2;
    cube.edge_lights.radius = 0.125;
    samples::add_object(scene, cube);
    samples::add_object(scene, samples::solid(PlatonicSolid::octahedron, {-1, -2, 0.7}, 0.75), 1);  // clear: not seen
    const struct {
        glm::dvec3 position;
        double radius;
    } lights[] = {
        {{-2, 1, 1}, 0.5},     {{2, 0, 2}, 0},        {{-1, -3, -0.75}, 0.25}, {{0.25, 2, 2.5}, 0.75},
        {{0.5, 0.5, 0}, 0.25}, {{0.25, -6, 0.5}, 0.5}};  // the last but one in the cube, the last around the camera
    for (const auto& one : lights) {
        LightDescription& light = samples::add_light(scene, one.position);
        light.radius = one.radius;
        light.glow = glm::dvec3(1, 0.5, 0.25);
    }
    return scene;
}

FrameSettings frame(int supersample, double target = 0) {
    FrameSettings settings;
    settings.set_size(width, height);
    settings.depth = 2;
    settings.supersample = supersample;
    settings.target_error = target;
    return settings;
}

/// Spheres that are seen, in the order of their ids, in scene units.
template <class Real>
struct Spheres {
    std::vector<glm::dvec3> centers;
    std::vector<double> radii;

    explicit Spheres(const CompiledScene<Real>& scene) {
        const double unit = std::ldexp(1.0, -scene.scale);
        for (const VisibleLight<Real>& light : scene.visible_lights) {
            centers.push_back(Vec3<double>(light.center) * unit + scene.center);
            radii.push_back(double(light.radius) * unit);
        }
    }
};

template <class Real>
class SeenLights : public ::testing::Test {
  protected:
    /// Points are rounded to some 2^-20 of the scene in float, and where a ray grazes a sphere that grows by its radius
    /// over the half chord, 15 at most, and by the inverse radius in normals. In double, depth and normal are floats.
    static constexpr double tolerance = sizeof(Real) == 4 ? 0x1p-10 : 0x1p-20;

    /// Each pixel whose middle sample goes to a sphere says which, where and which way it faces. Returns their number.
    static int check(const SceneDescription& description, const CompiledScene<Real>& scene, const Film& film, int k) {
        const Spheres<Real> spheres(scene);
        const int solids = int(scene.solids.size());
        const Camera camera = camera_at(description.camera, 0).camera;
        std::vector<int> seen(spheres.radii.size());
        int lights = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const PixelRecord& pixel = film.pixels[size_t(y * width + x)];
                if (pixel.id <= solids) {
                    EXPECT_EQ(pixel.id == 0, std::isinf(pixel.z));
                    continue;
                }
                ++lights;
                const size_t light = size_t(pixel.id - solids - 1);
                if (light >= seen.size()) {
                    ADD_FAILURE() << "id " << pixel.id;
                    continue;
                }
                ++seen[light];
                const double off = (k / 2 + 0.5) / k;  // the middle sample
                const glm::dvec3 direction = camera_direction(camera, x + off, y + off, width, height);
                const glm::dvec3 to = spheres.centers[light] - camera.position;
                const double closest = dot(to, direction), square = spheres.radii[light] * spheres.radii[light];
                const double half = std::sqrt(square - (dot(to, to) - closest * closest));
                const glm::dvec3 point = (closest - half) * direction;
                if (!(half > 0.05)) continue;  // at the rim rounding is amplified
                EXPECT_NEAR(pixel.z, (closest - half) * dot(direction, camera.forward), tolerance);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(pixel.normal[c], ((point - to) / spheres.radii[light])[c], tolerance) << x << ", " << y;
            }
        EXPECT_GT(seen[0], 20);
        EXPECT_GT(seen[1], 20);
        EXPECT_GT(seen[2], 20);
        EXPECT_EQ(seen[3] + seen[4], 0) << "inside the cube, around the camera";
        const int on_edges = lights - seen[0] - seen[1] - seen[2];
        EXPECT_GT(on_edges, 20);
        return lights;
    }
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SeenLights, Reals);

TYPED_TEST(SeenLights, HaveAnIdADepthAndANormal) {
    const SceneDescription scene = lit();
    for (const HostIntersector which : {HostIntersector::brute, HostIntersector::bvh}) {
        std::unique_ptr<CompiledScene<TypeParam>> compiled = compile_scene<TypeParam>(scene);
        build_primitive_tree(*compiled, 1);
        const std::shared_ptr<const CompiledScene<TypeParam>> shared = std::move(compiled);
        const auto renderer = make_host_renderer<TypeParam>(shared, which);
        for (const int k : {1, 2}) this->check(scene, *shared, golden::render_with(*renderer, scene, frame(k)), k);
    }
    const std::shared_ptr<const CompiledScene<TypeParam>> compiled = compile_scene<TypeParam>(scene);
    const auto renderer = make_embree_renderer<TypeParam>(compiled);
    const Film film = golden::render_with(*renderer, scene, frame(1));
    const int lights = this->check(scene, *compiled, film, 1);
    int hits = 0;
    for (const PixelRecord& pixel : film.pixels) {
        EXPECT_EQ(pixel.hits != 0, pixel.id != 0);
        hits += int(pixel.hits);
    }
    EXPECT_LT(lights, hits);
    this->check(scene, *compiled, golden::render_with(*renderer, scene, frame(16)), 16);
    this->check(scene, *compiled, golden::render_with(*renderer, scene, frame(16, 0.004)), 16);
}

TYPED_TEST(SeenLights, AreNumberedAfterTheSolidsAsTheirNames) {
    const SceneDescription scene = lit();
    const auto compiled = compile_scene<TypeParam>(scene);
    const SceneNames names = name_scene(gather_scene(scene));
    ASSERT_EQ(names.visible_lights.size(), compiled->visible_lights.size());
    ASSERT_EQ(compiled->visible_lights.size(), 5u + 2 * 12);
    EXPECT_EQ(names.visible_lights[1].name, "light 2");  // light 1 is not seen
    EXPECT_EQ(names.visible_lights[5].name, "object 1 edge 0 light 0");
    EXPECT_EQ(names.visible_lights[28].name, "object 1 edge 11 light 1");
}

/// From afar, where rays start at a sphere around the scene, and in one with thousands of lights.
TYPED_TEST(SeenLights, FromAfarToo) {
    SceneDescription scene = lit();
    scene.camera.position = {0.25, -600, 0.5};
    scene.camera.field_of_view = 0.7;
    const std::shared_ptr<const CompiledScene<TypeParam>> compiled = compile_scene<TypeParam>(scene);
    const auto renderer = make_embree_renderer<TypeParam>(compiled);
    const Film film = golden::render_with(*renderer, scene, frame(1));
    int lights = 0;
    for (const PixelRecord& pixel : film.pixels) {
        if (pixel.id <= 3) continue;
        ++lights;
        EXPECT_GT(pixel.z, 593);
        EXPECT_LT(pixel.z, 603);
        const Vec3<float> normal(pixel.normal[0], pixel.normal[1], pixel.normal[2]);
        EXPECT_NEAR(length(normal), 1, 1e-5);
        EXPECT_LT(normal.y, 0);  // toward the camera
    }
    EXPECT_GT(lights, 60);
}

/// In one frame of reference the same pictures, but for the pixels of the lights.
TYPED_TEST(SeenLights, HiddenOnesLightAsTheyDoWhereTheyAreSeen) {
    SceneDescription scene = lit();
    for (LightDescription& light : scene.lights) light.falloff = light.radius > 0;
    std::get<SolidObject>(scene.objects[1].shape).edge_lights.falloff = true;
    std::shared_ptr<const CompiledScene<TypeParam>> seen = compile_scene<TypeParam>(scene);
    const double bound = std::ldexp(1.0, seen->radiance_exponent + 1);
    scene.frame = FrameOfReference{seen->center, seen->scale, 0.75 * bound};
    seen = compile_scene<TypeParam>(scene);
    const Film with = golden::render_with(*make_embree_renderer<TypeParam>(seen), scene, frame(1));
    for (LightDescription& light : scene.lights) light.visible = false;
    std::get<SolidObject>(scene.objects[1].shape).edge_lights.visible = false;
    const std::shared_ptr<const CompiledScene<TypeParam>> hidden = compile_scene<TypeParam>(scene);
    ASSERT_EQ(hidden->radiance_exponent, seen->radiance_exponent);
    const Film without = golden::render_with(*make_embree_renderer<TypeParam>(hidden), scene, frame(1));
    const auto solids = static_cast<int32_t>(scene.objects.size());
    int lights = 0, lit_alike = 0;
    for (size_t i = 0; i < with.pixels.size(); ++i) {
        const PixelRecord &a = with.pixels[i], &b = without.pixels[i];
        EXPECT_LE(b.id, solids);
        if (a.id > solids) {
            ++lights;
            continue;
        }
        EXPECT_EQ(a.id, b.id);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(a.radiance[c], b.radiance[c]) << i;
        lit_alike += a.id != 0;
    }
    EXPECT_GT(lights, 100);
    EXPECT_GT(lit_alike, 400);
}

}  // namespace
}  // namespace cistula
