// misses_flat_sheet spares rays the triangles of flat sheets: it never hides a hit, and leaves out most that have none.
#include <gtest/gtest.h>

#include "cistula/traversal/brute.h"
#include "scene/compile/constant_scene.h"
#include "testing/support/scene.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using glm::dvec3;
using test::Random;

/// A triangle and a four-sided sheet at any angle, or across z, beside a solid.
SceneDescription sheets_scene(Random& random, bool across_z) {
    SceneDescription scene = samples::empty_scene();
    samples::add_object(scene, samples::solid(PlatonicSolid::tetrahedron, random.in_cube(3), 0.5));
    for (const size_t corners : {size_t(3), size_t(4)}) {
        const dvec3 across = across_z ? dvec3(1, 0, 0) : random.direction();
        const dvec3 other = across_z ? dvec3(0, 1, 0) : random.direction();
        const dvec3 middle = random.in_cube(2), a = across * random.between(0.05, 3);
        const dvec3 b = (other - across * dot(across, other)) * random.between(0.05, 3);
        TrianglesObject sheet;
        sheet.vertices = {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
        sheet.vertices.resize(corners);
        sheet.triangles = {{0, 1, 2}};
        if (corners == 4) sheet.triangles.push_back({0, 2, 3});
        samples::add_object(scene, sheet);
    }
    return scene;
}

/// Lines at all distances from a sheet's border, half of them within a few u of it, at slants from 1 to below 2^-10.
template <class Real>
Ray<Real, SingleInterior> aimed(Random& random, const ConstantScene<Real>& scene, uint32_t index) {
    const Cluster<Real>& cluster = scene.clusters[index];
    const uint32_t lane = random.below(cluster.count), c = random.below(3), d = (c + 1) % 3;
    dvec3 from, to, third;
    for (int axis = 0; axis < 3; ++axis) {
        from[axis] = double(cluster.corner[c][axis][lane]);
        to[axis] = double(cluster.corner[d][axis][lane]);
        third[axis] = double(cluster.corner[(c + 2) % 3][axis][lane]);
    }
    const dvec3 on_border = from + (to - from) * random.unit();
    const double reach = std::exp2(-random.between(0, random.below(2) ? 6 : 26));
    const dvec3 target = on_border + (third - on_border) * random.between(-reach, reach);
    const dvec3 normal(scene.planes[index].normal), away = random.direction();
    const dvec3 direction = normalized(away + normal * (std::exp2(-random.between(0, 12)) - dot(away, normal)));
    Ray<Real, SingleInterior> ray;
    ray.origin = Vec3<Real>(target - direction * random.between(0, 2) * double(scene.extent));
    ray.direction = Vec3<Real>(direction);
    return ray;
}

/// Called: inlined, GCC takes the lack of a solid for an index out of bounds.
template <class Real>
[[gnu::noinline]] bool is_hit(const ConstantScene<Real>& scene, uint32_t index, const Ray<Real, SingleInterior>& ray) {
    Hit<Real> hit;
    closest_triangles(scene, index, ray, TriangleRay<Real>::of(ray.origin, ray.direction), hit);
    return hit.found();
}

template <class Real>
class FlatSheets : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(FlatSheets, Reals);

TYPED_TEST(FlatSheets, NoHitIsHidden) {
    using Real = TypeParam;
    Random random(20);
    int hits = 0, hidden = 0, misses = 0, spared = 0;
    for (int n = 0; n < 60; ++n) {
        const auto compiled = compile_scene<Real>(sheets_scene(random, n % 3 == 0));
        const auto scene = constant_scene(compiled->view());
        ASSERT_TRUE(scene);
        for (int i = 0; i < 10000; ++i) {
            const uint32_t index = random.below(scene->clusters.size);
            ASSERT_EQ(scene->planes[index].flat, 1u);
            const Ray<Real, SingleInterior> ray = aimed(random, *scene, index);
            const bool found = is_hit(*scene, index, ray);
            const bool is_left_out = misses_flat_sheet(*scene, index, ray, RealTraits<Real>::infinity);
            hits += found;
            misses += !found;
            hidden += found && is_left_out;
            spared += !found && is_left_out;
        }
    }
    EXPECT_EQ(hidden, 0) << "of " << hits;
    EXPECT_GT(hits, 100000);
    EXPECT_GT(misses, 100000);
    std::printf("%s: %d hits, %d misses, of which %d are left out\n", RealTraits<Real>::name, hits, misses, spared);
}

// What it is for: of lines that go anywhere through the scene most are spared.
TYPED_TEST(FlatSheets, MostMissesAreSpared) {
    using Real = TypeParam;
    Random random(21);
    int misses = 0, spared = 0;
    for (int n = 0; n < 60; ++n) {
        const auto compiled = compile_scene<Real>(sheets_scene(random, true));
        const auto scene = constant_scene(compiled->view());
        ASSERT_TRUE(scene);
        for (int i = 0; i < 2000; ++i) {
            Ray<Real, SingleInterior> ray;
            ray.origin = Vec3<Real>(random.in_cube(double(scene->extent)));
            ray.direction = Vec3<Real>(random.direction());
            const uint32_t index = random.below(scene->clusters.size);
            const bool found = is_hit(*scene, index, ray);
            misses += !found;
            spared += !found && misses_flat_sheet(*scene, index, ray, RealTraits<Real>::infinity);
        }
    }
    EXPECT_GT(spared, misses * 0.9) << "of " << misses;
}

}  // namespace
}  // namespace cistula
