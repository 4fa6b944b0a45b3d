// Rays that look for no lights along edges would have met none, and most look for none.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "cistula/lights/visible_light.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/constant_scene.h"
#include "testing/support/shipped_scenes.h"

namespace cistula {
namespace {

/// benchmark.json with `count` lights of a radius on every edge, its solids `size` times as large.
SceneDescription edge_lit(int count, double radius, double size = 1) {
    SceneDescription scene = test::shipped_scene("benchmark");
    for (ObjectDescription& object : scene.objects)
        if (auto* solid = std::get_if<SolidObject>(&object.shape)) {
            solid->radius *= size;
            solid->edge_lights.count = count;
            solid->edge_lights.radius = radius;
            solid->edge_lights.color = Vec3<double>(0);
            solid->edge_lights.glow = Vec3<double>(1);
        }
    return scene;
}

/// What closest_visible_light is to find.
template <class Real>
VisibleLightHit<Real> found_by_loop(const SceneView<Real>& scene, const Ray<Real>& ray, Real limit) {
    VisibleLightHit<Real> best;
    best.t = limit;
    for (uint32_t i = 0; i < scene.visible_lights.size; ++i) intersect_visible_light(scene, i, ray, best);
    return best;
}

struct Seen {
    int rays = 0, lights = 0, looked = 0, inside = 0;
};

template <class Real>
class EdgeLights : public ::testing::Test {
  public:
    /// `count` rays of all kinds against a loop over all lights.
    Seen compare(const SceneDescription& description, int count) {
        const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(description);
        const SceneView<Real> scene = compiled->view();
        const auto small = constant_scene(scene);  // null where solids touch
        Seen seen;
        for (int i = 0; i < count; ++i) {
            Real limit = RealTraits<Real>::infinity;
            Ray<Real> ray = i % 2 == 0 ? any_ray(scene) : grazing_ray(scene);
            if (i % 3 == 0) limit = scene.extent * Real(uniform(0, 2));
            seen.inside += enter_solids(scene, ray, limit, i % 5 == 0);
            const VisibleLightHit<Real> expected = found_by_loop(scene, ray, limit),
                                        found = closest_visible_light(scene, ray, limit);
            EXPECT_EQ(found.light, expected.light) << "ray " << i;
            EXPECT_EQ(found.t, expected.t) << "ray " << i;
            if (small) {
                const VisibleLightHit<Real> in_small = closest_visible_light(*small, ray, limit);
                EXPECT_EQ(in_small.light, expected.light) << "ray " << i;
                EXPECT_EQ(in_small.t, expected.t) << "ray " << i;
            }
            ++seen.rays;
            seen.lights += expected.light != no_light;
            Real from = max_or_second(ray.after.t, Real(0));
            if (i % 2 == 0) seen.looked += may_hit_visible_lights(scene, ray, from, limit);
        }
        return seen;
    }

  private:
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    Vec3<double> in_cube() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }

    Ray<Real> ray_through(const Vec3<double>& from, const Vec3<double>& to) {
        Ray<Real> ray;
        ray.origin = Vec3<Real>(from);
        ray.direction = Vec3<Real>(normalized(to - from));
        if (uniform(0, 1) < 0.2) ray.after.t = Real(uniform(0, 1));  // straight on through a face
        return ray;
    }
    Ray<Real> any_ray(const SceneView<Real>& scene) {
        Vec3<double> from = in_cube() * double(scene.extent);
        if (uniform(0, 1) < 0.3) {  // perhaps from within a solid
            const Solid& solid = scene.solids[scene.convex[uint32_t(uniform(0, scene.convex.size - 0.5))]];
            from = Vec3<double>(solid.center) + in_cube() * std::sqrt(double(solid.padded_square));
        }
        return ray_through(from, in_cube() * double(scene.extent));
    }
    /// A ray that starts in solids knows them, and no light counts for it beyond its way out, if it does not go on
    /// there. Whether it starts in any.
    bool enter_solids(const SceneView<Real>& scene, Ray<Real>& ray, Real& limit, bool goes_on) {
        ray.after.t = max_or_second(ray.after.t, Real(0));
        const Vec3<Real> start = ray.origin + ray.after.t * ray.direction;
        for (const uint32_t index : scene.convex)
            if (inside_convex(scene, scene.solids[index], start)) ray.media.add(index, 1);
        if (ray.media.empty()) return false;
        limit =
            goes_on ? RealTraits<Real>::infinity : min_or_second(limit, BruteIntersector<Real>{scene}.closest(ray).t);
        return true;
    }
    /// Through the rim of a light, from near or far: within rounding of it, or a little off.
    Ray<Real> grazing_ray(const SceneView<Real>& scene) {
        const auto& light = scene.visible_lights[uint32_t(uniform(0, scene.visible_lights.size - 0.5))];
        const Vec3<double> center(light.center), from = center + in_cube() * (uniform(0, 1) < 0.5 ? 0.2 : 2.0);
        const Vec3<double> side = normalized(cross(center - from, in_cube()));
        const double off = uniform(0, 1) < 0.5 ? 1e-7 * uniform(-1, 1) : 0.1 * uniform(-1, 1);
        return ray_through(from, center + side * (double(light.radius) * (1 + off)));
    }

    std::mt19937_64 random_{1};
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(EdgeLights, Reals);

TYPED_TEST(EdgeLights, AreFoundByAllThatMeetThem) {
    for (const double radius : {0.001, 0.03, 0.3}) {
        const Seen seen = this->compare(edge_lit(6, radius), 200000);
        EXPECT_GT(seen.lights, seen.rays / 10) << radius;
        EXPECT_GT(seen.inside, seen.rays / 20) << radius;
    }
    this->compare(edge_lit(3, 0.02, 2.5), 200000);  // solids through one another
    for (const char* name : {"platonic", "infinity", "glass", "hard/lights-on-edges", "hard/tiny-beside-unit"}) {
        const SceneDescription scene = test::shipped_scene(name);
        if (compile_scene<TypeParam>(scene)->visible_lights.empty()) continue;
        this->compare(scene, 100000);
    }
}

TYPED_TEST(EdgeLights, AreLookedForByFewRays) {
    const Seen seen = this->compare(edge_lit(6, 0.03), 100000);
    EXPECT_LT(seen.looked, seen.rays / 10);
    EXPECT_GT(seen.looked, 0);
}

/// A light anywhere else is looked for by every ray.
TYPED_TEST(EdgeLights, LeaveOtherLightsToTheTree) {
    SceneDescription scene = edge_lit(6, 0.03);
    scene.lights[0].radius = 0.2;
    const Seen seen = this->compare(scene, 100000);
    EXPECT_EQ(seen.looked, seen.rays / 2);
}

TYPED_TEST(EdgeLights, AFewAreInNoTree) {
    SceneDescription scene = test::shipped_scene("benchmark");
    for (LightDescription& light : scene.lights) light.radius = 0.5;
    ASSERT_TRUE(compile_scene<TypeParam>(scene)->visible_light_tree.empty());
    const Seen seen = this->compare(scene, 100000);
    EXPECT_GT(seen.lights, seen.rays / 10);
}

}  // namespace
}  // namespace cistula
