// Embree, our own tree and the plain loop find the same hits and the same light, bit for bit.
#include <gtest/gtest.h>

#include <functional>

#include "backend_embree/embree/embree_tree.h"
#include "cistula/shading/snell.h"
#include "cistula/shading/surface.h"
#include "cistula/transport/ray_tree.h"
#include "testing/support/intersectors.h"
#include "testing/support/scene.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

using glm::dvec3;
using test::Random;
using test::Triangle;

int coloured_glass(SceneDescription& scene, Random& random) {
    const int m = test::add_material(scene, 0.1, 0.9 * random.unit(), dvec3(random.unit(), 1, random.below(2)));
    scene.materials.back().absorption = dvec3(random.unit(), 0, random.below(2));
    return m;
}

TrianglesObject moved(TrianglesObject mesh, const dvec3& center, const dvec3& scale) {
    for (dvec3& v : mesh.vertices) v = center + v * scale;
    return mesh;
}

struct Case {
    const char* name;
    SceneDescription scene;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    const auto add = [&](const char* name, const std::function<void(SceneDescription&, Random&)>& build) {
        Random random(all.size() + 1);
        SceneDescription scene;
        scene.materials.reserve(64);
        build(scene, random);
        test::add_light(scene, {3, 4, 5});
        test::add_light(scene, {0.1, 0.05, -0.02});
        all.push_back({name, scene});
    };
    add("soup", [](auto& s, auto& r) { test::add_object(s, triangle_soup(1500, 0.4, 1), coloured_glass(s, r)); });
    add("slivers", [](auto& s, auto& r) {
        test::add_object(s, moved(triangle_soup(400, 0.8, 2), dvec3(0), {1, 1e-6, 1}), coloured_glass(s, r));
        test::add_object(s, moved(triangle_soup(400, 1, 3), dvec3(0.1), {1e-7, 1, 1e-4}), coloured_glass(s, r));
        TrianglesObject flat = triangle_soup(200, 0.5, 4);  // with zero-area triangles and tiny ones among them
        for (size_t i = 0; i + 2 < flat.vertices.size(); i += 9) flat.vertices[i + 2] = flat.vertices[i];
        for (size_t i = 3; i + 2 < flat.vertices.size(); i += 9)
            flat.vertices[i + 2] = flat.vertices[i] + (flat.vertices[i + 1] - flat.vertices[i]) * 0.5;
        test::add_object(s, flat, coloured_glass(s, r));
    });
    add("closed meshes", [](auto& s, auto& r) {
        test::add_object(s, bumpy_sphere(1200), coloured_glass(s, r));
        test::add_object(s, moved(torus(1, 0.4, 24, 16), dvec3(0), dvec3(0.6)), coloured_glass(s, r));
        test::add_object(s, moved(star(), {0.7, 0, 0}, dvec3(0.8)), coloured_glass(s, r));
    });
    add("nested solids", [](auto& s, auto& r) {
        for (int i = 0; i < 5; ++i)
            test::add_solid(s, test::platonic_solids[i], dvec3(0), 1.0 / (1 + i * i), r.in_cube(180),
                            coloured_glass(s, r));
        for (int i = 0; i < 3; ++i)
            test::add_object(s, test::solid_mesh(PlatonicSolid::cube, dvec3(0.02 * i), 0.8 - 0.2 * i),
                             coloured_glass(s, r));
    });
    add("many solids", [](auto& s, auto& r) {
        for (int i = 0; i < 60; ++i) {
            test::add_solid(s, test::platonic_solids[i % 5], r.in_cube(2), r.between(0.05, 0.6),
                            i % 3 ? r.in_cube(180) : dvec3(0), i < 30 ? coloured_glass(s, r) : int(r.below(20)));
            std::get<SolidObject>(s.objects.back().shape).edge_lights.count = i == 7 ? 1 : 0;
        }
    });
    add("touching cubes", [](auto& s, auto& r) {
        const double half = 1 / std::sqrt(3.0);
        for (int x = 0; x < 3; ++x)
            for (int y = 0; y < 3; ++y)
                test::add_solid(s, PlatonicSolid::cube, {2 * half * x, 2 * half * y, 0}, 1, dvec3(0),
                                coloured_glass(s, r));
    });
    add("mixed", [](auto& s, auto& r) {
        test::add_object(s, moved(triangle_soup(100, 1, 5), dvec3(0), dvec3(2)), coloured_glass(s, r));
        test::add_object(s, bumpy_sphere(300), coloured_glass(s, r));
        for (int i = 0; i < 12; ++i)
            test::add_solid(s, test::platonic_solids[i % 5], r.in_cube(1.5), 0.5, r.in_cube(180), coloured_glass(s, r));
        std::get<SolidObject>(s.objects.back().shape).edge_lights.count = 2;
        test::add_object(s, test::solid_mesh(PlatonicSolid::octahedron, dvec3(0.3), 0.7), coloured_glass(s, r));
        test::add_light(s, dvec3(0.3) + dvec3(0.35, 0.35, 0));  // the middle of an edge of that octahedron
    });
    return all;
}

template <class Real>
bool same(const Hit<Real>& a, const Hit<Real>& b) {
    return a.t == b.t && a.key == b.key && a.u == b.u && a.v == b.v && a.enters == b.enters && a.slot == b.slot;
}

/// All the rays of one scene, met by brute force once: what every other intersector must repeat.
template <class Real>
struct Record {
    std::vector<std::pair<Ray<Real>, Hit<Real>>> closest;
    struct Shadow {
        ShadowRay<Real> ray;
        Vec3<Real> all;
        Real opaque;
    };
    std::vector<Shadow> shadows;
};

using AllEffects = Effects<all_effects>;
using OpaqueOnly = Effects<opaque_bodies>;

template <class Real>
Record<Real> record(const CompiledScene<Real>& compiled, const SceneView<Real>& scene, int paths) {
    Record<Real> result;
    Random random(99);
    const test::Brute<Real> brute{scene};
    const auto triangles = test::all_triangles(compiled);
    for (int i = 0; i < paths; ++i) {
        const double far = i % 5 ? 1.9 : 0.9;
        const Vec3<Real> origin(random.direction() * (far * double(scene.extent)));
        Vec3<Real> target(random.in_cube(0.9 * double(scene.extent)));
        if (i % 2 && !triangles.empty()) {
            const Triangle<Real>& t = triangles[random.below(uint32_t(triangles.size()))];
            target = i % 4 == 1 ? t[0] : along(t[0], Real(random.unit()), t[1] - t[0]);
        }
        Vec3<Real> direction = normalized(target - origin);
        if (i % 16 == 0) direction = Vec3<Real>(Real(0)), direction[int(random.below(3))] = random.below(2) ? 1 : -1;
        Ray<Real> ray = test::ray_from(origin, direction);
        for (int crossing = 0; crossing < 6; ++crossing) {
            const Hit<Real> hit = brute.closest(ray);
            result.closest.push_back({ray, hit});
            if (!hit.found()) break;
            const Surface<Real> s = surface_at<Real, AllEffects>(scene, ray, hit);
            const Light<Real>& light = scene.lights[random.below(scene.lights.size)];
            const Vec3<Real> to_light = light.position - s.viewer_side;
            const Real distance = length(to_light);
            const ShadowRay<Real> shadow{test::spawn(s.viewer_side, to_light / distance, hit, ray.media), distance,
                                         &light};
            result.shadows.push_back({shadow, brute.template transmittance<AllEffects>(shadow),
                                      brute.template transmittance<OpaqueOnly>(shadow)});
            if (random.below(3) == 0)
                ray = test::spawn(s.viewer_side, reflected(ray.direction, s.normal), hit, ray.media);
            else
                test::pass(ray, hit);
        }
    }
    return result;
}

template <class Real, class Intersector>
void expect_same(const Record<Real>& record, const Intersector& intersector, const std::string& name) {
    int different = 0;
    for (const auto& [ray, hit] : record.closest) different += !same(intersector.closest(ray), hit);
    EXPECT_EQ(different, 0) << name << ": hits of " << record.closest.size();
    different = 0;
    for (const auto& shadow : record.shadows) {
        different += intersector.template transmittance<AllEffects>(shadow.ray) != shadow.all;
        different += intersector.template transmittance<OpaqueOnly>(shadow.ray) != shadow.opaque;
    }
    EXPECT_EQ(different, 0) << name << ": shadows of " << record.shadows.size();
}

std::vector<EmbreeOptions> embree_options() {
    std::vector<EmbreeOptions> all;
    const auto add = [&](const char* config, int quality) {
        EmbreeOptions options;
        options.device_config = config;
        options.tree_quality = quality;
        options.always_tree = true;
        all.push_back(options);
    };
    add("", 0);
    add("", 1);
    add("isa=sse2", 1);
    add("isa=avx2", 1);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
        add("isa=avx512", 1);
    else
        std::printf("this processor has no AVX-512: isa=avx512 is left out\n");
    return all;
}

template <class Real>
class IntersectorsTest : public testing::Test {};
using Precisions = testing::Types<float, double>;
/// Finds hits, but not the light that passes.
struct WithoutShadows {
    using Media = InteriorList;
    using Scene = SceneView<float>;
    template <class E>
    Hit<float> closest(const Ray<float>&) const;
};
using All = Effects<all_effects>;
static_assert(Intersects<EmbreeIntersector<double>, double, All> && Intersects<BvhIntersector<float>, float, All>);
static_assert(!Intersects<WithoutShadows, float, All> && !FindsHits<WithoutShadows, float, InteriorList>);
static_assert(StacksBranches<BranchStack<Branch<float>>, float, Branch<float>>);
static_assert(!StacksBranches<BranchStack<Branch<float>>, double, Branch<double>>);
static_assert(!ObservesLights<WithoutShadows, float, All, InteriorList>);

TYPED_TEST_SUITE(IntersectorsTest, Precisions);

TYPED_TEST(IntersectorsTest, AllFindTheSameBits) {
    using Real = TypeParam;
    size_t rays = 0, hits = 0, partly_lit = 0;
    for (const Case& c : cases()) {
        const auto compiled = test::compile<Real>(c.scene, true, 1);
        const SceneView<Real> scene = compiled->view();
        const Record<Real> expected = record(*compiled, scene, 24000);
        rays += expected.closest.size() + 2 * expected.shadows.size();
        for (const auto& [ray, hit] : expected.closest) hits += hit.found();
        for (const auto& s : expected.shadows)
            partly_lit += s.all != Vec3<Real>(Real(0)) && s.all != Vec3<Real>(Real(1));
        expect_same(expected, test::Bvh<Real>{scene}, std::string(c.name) + ", bvh");
        const auto quick = test::compile<Real>(c.scene, true, 0);
        const SceneView<Real> quick_scene = quick->view();
        // The lights that shadow rays name are the first view's; both scenes are the same but for the tree.
        ASSERT_EQ(compiled->hashes.of(0), quick->hashes.of(0));
        expect_same(expected, test::Bvh<Real>{quick_scene}, std::string(c.name) + ", quick bvh");
        for (const EmbreeOptions& options : embree_options()) {
            const EmbreeTree<Real> tree(scene, options);
            expect_same(
                expected, EmbreeIntersector<Real>{scene, tree.scene()},
                std::string(c.name) + ", Embree " + options.device_config + " " + std::to_string(options.tree_quality));
        }
    }
    std::printf("%s: %zu rays, %zu hits, %zu partly lit\n", RealTraits<Real>::name, rays, hits, partly_lit);
    EXPECT_GT(rays, 500000u);
    EXPECT_GT(hits, 200000u);
    EXPECT_GT(partly_lit, 10000u);
}

// Primitives in another order are the same scene: hits differ in their slot alone.
TYPED_TEST(IntersectorsTest, TheOrderOfPrimitivesChangesNothing) {
    using Real = TypeParam;
    for (const Case& c : cases()) {
        const auto compiled = test::compile<Real>(c.scene);
        const SceneView<Real> scene = compiled->view();
        const Record<Real> expected = record(*compiled, scene, 1500);
        CompiledScene<Real> shuffled = *compiled;
        Random random(5);
        for (size_t i = shuffled.clusters.size(); i > 1; --i)
            std::swap(shuffled.clusters[i - 1], shuffled.clusters[random.below(uint32_t(i))]);
        for (size_t i = shuffled.convex.size(); i > 1; --i)
            std::swap(shuffled.convex[i - 1], shuffled.convex[random.below(uint32_t(i))]);
        const SceneView<Real> other = shuffled.view();
        const test::Brute<Real> brute{other};
        for (const auto& [ray, hit] : expected.closest) {
            Hit<Real> found = brute.closest(ray);
            found.slot = hit.slot;
            ASSERT_TRUE(same(found, hit)) << c.name;
        }
        for (const auto& shadow : expected.shadows)
            ASSERT_EQ(brute.template transmittance<AllEffects>(shadow.ray), shadow.all) << c.name;
    }
}

// Rays that are not finite meet nothing, and never reach Embree.
TYPED_TEST(IntersectorsTest, RaysThatAreNotFiniteMeetNothing) {
    using Real = TypeParam;
    SceneDescription description;
    test::add_solid(description, PlatonicSolid::cube);
    test::add_light(description, {3, 0, 0});
    const auto compiled = test::compile<Real>(description, true);
    const SceneView<Real> scene = compiled->view();
    const EmbreeTree<Real> tree(scene, embree_options()[0]);
    const EmbreeIntersector<Real> embree{scene, tree.scene()};
    const Real inf = RealTraits<Real>::infinity;
    for (const Real bad : {std::numeric_limits<Real>::quiet_NaN(), inf, -inf})
        for (int k = 0; k < 6; ++k) {
            Ray<Real> ray =
                test::ray_from(Vec3<Real>(Real(2), Real(0), Real(0)), Vec3<Real>(Real(-1), Real(0), Real(0)));
            (k < 3 ? ray.origin[k] : ray.direction[k - 3]) = bad;
            const ShadowRay<Real> shadow{ray, Real(1), &scene.lights[0]};
            EXPECT_FALSE(embree.closest(ray).found());
            EXPECT_FALSE(test::Bvh<Real>{scene}.closest(ray).found());
            EXPECT_FALSE(test::Brute<Real>{scene}.closest(ray).found());
            EXPECT_EQ(embree.template transmittance<AllEffects>(shadow), Vec3<Real>(Real(0)));
            EXPECT_EQ(test::Bvh<Real>{scene}.template transmittance<AllEffects>(shadow), Vec3<Real>(Real(0)));
        }
}

}  // namespace
}  // namespace cistula
