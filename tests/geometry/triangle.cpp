// triangle.h: every ray meets a closed mesh exactly once going in and once going out, edges and vertices included.
#include "cistula/geometry/triangle.h"

#include <gtest/gtest.h>

#include "testing/support/intersectors.h"
#include "testing/support/scene.h"

namespace cistula {
namespace {

using glm::dvec3;
using test::Count;
using test::Random;
using test::Triangle;

template <class Real>
Real unit_of() {
    return RealTraits<Real>::unit;
}

/// The test that must not be used: edges belong to both triangles.
template <class Real>
Count cross_all_inclusively(const CompiledScene<Real>& scene, const Ray<Real>& ray) {
    Count count;
    const auto triangle_ray = TriangleRay<Real>::of(ray.origin, ray.direction);
    for (const Cluster<Real>& cluster : scene.clusters)
        for (uint32_t lane = 0; lane < cluster.count; ++lane) {
            const auto s = ShearedTriangle<Real>::of(cluster, int(lane), triangle_ray);
            const Real det = s.edge[0] + s.edge[1] + s.edge[2];
            if (s.within() && det != Real(0)) ++(det > Real(0) ? count.enters : count.leaves);
        }
    return count;
}

template <class Real>
struct Aimed {
    Vec3<Real> origin, direction;
};

/// From outside at a corner, along an edge, or at the middle of a triangle. Half of the directions are not rounded to
/// unit length, and origins lie on a coarse lattice, so that many sheared corners are exactly 0.
template <class Real>
Aimed<Real> aim(Random& random, const std::vector<Triangle<Real>>& triangles) {
    const Triangle<Real>& t = triangles[random.below(uint32_t(triangles.size()))];
    Vec3<Real> target = t[random.below(3)];
    const uint32_t what = random.below(4);
    if (what == 0) target = (t[0] + t[1] + t[2]) / Real(3);
    if (what >= 2) {
        const uint32_t c = random.below(3);
        const Real share = what == 2 ? Real(0.5) : Real(random.unit());
        target = along(t[c], share, t[(c + 1) % 3] - t[c]);
    }
    Vec3<Real> origin(random.direction() * 3.5);
    if (random.below(2))
        for (int k = 0; k < 3; ++k) origin[k] = floor_of(origin[k] * Real(64)) / Real(64);
    if (random.below(8) == 0) {  // parallel to an axis
        origin = target;
        origin[int(random.below(3))] = random.below(2) ? Real(3.5) : Real(-3.5);
    }
    const Vec3<Real> direction = target - origin;
    return {origin, random.below(2) ? direction : normalized(direction)};
}

template <class Real>
class TriangleTest : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(TriangleTest, Precisions);

TYPED_TEST(TriangleTest, ClosedSolidsAreEnteredAndLeftExactlyOnce) {
    using Real = TypeParam;
    Random random(1);
    int through = 0, silhouette = 0, inclusive_wrong = 0;
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const PlatonicSolid solid : test::platonic_solids)
            for (const dvec3& turn : {dvec3(0), dvec3(31, 47, 11), dvec3(random.in_cube(180))}) {
                SceneDescription description;
                test::add_object(description, test::solid_mesh(solid, dvec3(3, -2, 5) * scale, scale, turn), 0);
                const auto scene = test::compile<Real>(description);
                const SceneView<Real> view = scene->view();
                ASSERT_EQ(view.solids[0].kind, SolidKind::mesh);
                const auto triangles = test::all_triangles(*scene);
                // Where the compiled mesh stands in its frame.
                const double radius = std::ldexp(scale, scene->scale);
                const dvec3 center = (dvec3(3, -2, 5) * scale - scene->center) * std::ldexp(1.0, scene->scale);
                const test::Brute<Real> brute{view};
                for (int i = 0; i < 36000; ++i) {
                    const Aimed<Real> a = aim(random, triangles);
                    const Ray<Real> ray = test::ray_from(a.origin, a.direction);
                    const Count count = test::cross_all(brute, ray);
                    ASSERT_EQ(count.enters, count.leaves) << platonic_name(solid) << " " << i;
                    const double inside = test::chord(platonic_shape(solid), Rotation(turn), radius, 1e-4,
                                                      dvec3(a.origin) - center, normalized(dvec3(a.direction)));
                    if (inside > 1e-3) {
                        ASSERT_EQ(count.enters, 1) << platonic_name(solid) << " " << i;
                        ++through;
                        const Count other = cross_all_inclusively(*scene, ray);
                        inclusive_wrong += other.enters != 1 || other.leaves != 1;
                    } else {
                        // At the silhouette rounding may fold a sliver, but never opens one.
                        ASSERT_LE(count.enters, 3);
                        ++silhouette;
                    }
                }
            }
    std::printf("%s: %d through, %d at the silhouette; inclusive edges miscount %d\n", RealTraits<Real>::name, through,
                silhouette, inclusive_wrong);
    EXPECT_GT(through, 1000000);
    EXPECT_GT(silhouette, 1000);
    EXPECT_GT(inclusive_wrong, through / 20) << "the rays no longer test what they should";
}

/// Two fans of n triangles around a hub, joined at the rim: closed, with a vertex of n triangles on either side.
template <class Real>
std::vector<Triangle<Real>> lens(int n, const Vec3<Real>& hub, Real height) {
    std::vector<Vec3<Real>> rim;
    for (int i = 0; i < n; ++i) {
        const double a = 6.283185307179586 * i / n;
        rim.push_back(hub + Vec3<Real>(Real(elementary::cos(a)), Real(elementary::sin(a)), Real(0)));
    }
    std::vector<Triangle<Real>> triangles;
    for (int i = 0; i < n; ++i) {
        const Vec3<Real>&a = rim[size_t(i)], &b = rim[size_t((i + 1) % n)];
        triangles.push_back({hub + Vec3<Real>(0, 0, height), a, b});
        triangles.push_back({hub - Vec3<Real>(0, 0, height), b, a});
    }
    return triangles;
}

TYPED_TEST(TriangleTest, FansHoldAtHubAndSpokes) {
    using Real = TypeParam;
    Random random(2);
    for (const int n : {4, 5, 8, 31, 256, 4096}) {
        CompiledScene<Real> scene;
        const Vec3<Real> hub = n % 2 ? Vec3<Real>(Real(0.1), Real(0.3), Real(0.2)) : Vec3<Real>(Real(0));
        const auto triangles = lens<Real>(n, hub, Real(0.25));
        test::add_clusters(scene, triangles, SolidKind::mesh);
        const SceneView<Real> view = scene.view();
        const int rays = n > 1000 ? 300 : 20000;
        for (int i = 0; i < rays; ++i) {
            const Triangle<Real>& t = triangles[random.below(uint32_t(triangles.size()))];
            // t[0] is a hub; t[1] and t[2] are on the rim.
            const Vec3<Real> target = i % 2 ? t[0] : along(t[0], Real(random.between(0, 0.9)), t[1] - t[0]);
            Vec3<Real> origin = Vec3<Real>(random.direction() * 2.5);
            const double across = std::abs(double(normalized(target - origin).z));
            if (i % 16 < 2) origin = target, origin.z = i % 16 ? Real(2) : Real(-2);
            const Count count = test::cross_all(test::Brute<Real>{view}, test::ray_from(origin, target - origin));
            ASSERT_EQ(count.enters, count.leaves) << n << " " << i;
            if (across > 0.5 || i % 16 < 2) {
                ASSERT_EQ(count.enters, 1) << n << " " << i;
            }
        }
    }
}

// Directions so close to an axis that products of sheared corners reach the bottom of the exponent range.
TYPED_TEST(TriangleTest, TinyShearsKeepTheirSigns) {
    using Real = TypeParam;
    Random random(3);
    int through = 0;
    for (int i = 0; i < 200000; ++i) {
        // A tent whose ridge runs nearly along the ray: its ends are tiny numbers once sheared.
        const Real size = Real(std::ldexp(random.between(1, 2), -int(random.below(40)) - 25));
        const auto tiny = [&] { return Real(double(size) * random.between(-1, 1)); };
        const Vec3<Real> a(tiny(), tiny(), Real(1)), b(tiny(), tiny(), Real(-1));
        // A tetrahedron with the edge ab and one cd across it.
        const Vec3<Real> c(Real(1), Real(0.25), Real(0)), d(Real(-1), Real(0.5), Real(0)),
            e(Real(0.125), Real(-1), Real(0));
        CompiledScene<Real> scene;
        test::add_clusters<Real>(scene, {{a, c, d}, {a, d, e}, {a, e, c}, {b, d, c}, {b, e, d}, {b, c, e}},
                                 SolidKind::mesh);
        const SceneView<Real> view = scene.view();
        const Count count =
            test::cross_all(test::Brute<Real>{view},
                            test::ray_from(Vec3<Real>(tiny(), tiny(), Real(3)), Vec3<Real>(tiny(), tiny(), Real(-1))));
        ASSERT_EQ(count.enters, 1) << i;
        ASSERT_EQ(count.leaves, 1) << i;
        ++through;
    }
    EXPECT_EQ(through, 200000);
}

// What "exactly once" rests on: the sign of an edge function does not depend on which triangle asks.
TYPED_TEST(TriangleTest, EdgeFunctionsAreAntisymmetric) {
    using Real = TypeParam;
    Random random(4);
    const TriangleRay<Real> ray = TriangleRay<Real>::of(Vec3<Real>(Real(0)), Vec3<Real>(Real(0), Real(0), Real(1)));
    for (int i = 0; i < 1000000; ++i) {
        const Real size = Real(std::ldexp(1.0, -int(random.below(62))));
        const auto number = [&] { return Real(double(size) * random.between(-1, 1)); };
        Vec3<Real> a(number(), number(), Real(1)), b(number(), number(), Real(1));
        if (i % 2) {  // nearly in line with the ray
            const Real k = Real(random.between(0.25, 2));
            b = Vec3<Real>(a.x * k, a.y * k, Real(1));
        }
        Cluster<Real> cluster{};
        const Vec3<Real> other(Real(1), Real(0.5), Real(1)), corners[2][3] = {{a, b, other}, {b, a, -other}};
        for (int lane = 0; lane < 2; ++lane)
            for (int c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis) cluster.corner[c][axis][lane] = corners[lane][c][axis];
        const Real ab = ShearedTriangle<Real>::of(cluster, 0, ray).edge[2];
        const Real ba = ShearedTriangle<Real>::of(cluster, 1, ray).edge[2];
        ASSERT_EQ(ab > 0, ba < 0) << double(a.x) << " " << double(b.x);
        ASSERT_EQ(ab<0, ba> 0);
    }
}

TYPED_TEST(TriangleTest, RaysInThePlaneOfAFacePassItBy) {
    using Real = TypeParam;
    CompiledScene<Real> scene;
    const Vec3<Real> a(Real(0), Real(0), Real(0.5)), b(Real(1), Real(0), Real(0.5)), c(Real(0), Real(1), Real(0.5));
    test::add_clusters<Real>(scene, {{a, b, c}}, SolidKind::sheet);
    const SceneView<Real> view = scene.view();
    const test::Brute<Real> brute{view};
    Random random(5);
    for (int i = 0; i < 10000; ++i) {
        const Vec3<Real> origin(Real(random.between(-2, 2)), Real(random.between(-2, 2)), Real(0.5));
        const Vec3<Real> target(Real(random.unit() * 0.5), Real(random.unit() * 0.5), Real(0.5));
        ASSERT_FALSE(brute.closest(test::ray_from(origin, target - origin)).found());
    }
    // Faces of a cube, their edges and diagonals: in and out as often, whatever the plane's owner.
    SceneDescription description;
    test::add_object(description, test::solid_mesh(PlatonicSolid::cube), 0);
    const auto cube = test::compile<Real>(description);
    const SceneView<Real> cube_view = cube->view();
    const Real half = test::all_triangles(*cube)[0][0].x;
    for (int i = 0; i < 30000; ++i) {
        const int axis = int(random.below(3)), other = (axis + 1) % 3;
        Vec3<Real> origin(Real(0)), direction(Real(0));
        origin[axis] = random.below(2) ? half : -half;
        origin[other] = i % 3 == 0 ? half : Real(random.between(-1, 1));
        origin[(axis + 2) % 3] = -3;
        direction[other] = i % 3 == 1 ? Real(random.between(-0.3, 0.3)) : Real(0);
        direction[(axis + 2) % 3] = 1;
        const Count count = test::cross_all(test::Brute<Real>{cube_view}, test::ray_from(origin, direction));
        ASSERT_EQ(count.enters, count.leaves);
        ASSERT_LE(count.enters, 1);
    }
}

TYPED_TEST(TriangleTest, DegenerateAndNotFiniteTrianglesAreNeverHit) {
    using Real = TypeParam;
    const Real nan = std::numeric_limits<Real>::quiet_NaN(), inf = std::numeric_limits<Real>::infinity();
    const Vec3<Real> a(Real(-1), Real(-1), Real(0)), b(Real(1), Real(-1), Real(0)), c(Real(0), Real(1), Real(0));
    const auto v = [](Real x, Real y, Real z) { return Vec3<Real>(x, y, z); };
    CompiledScene<Real> scene;
    test::add_clusters<Real>(scene,
                             {{a, a, a},
                              {a, b, a},
                              {a, b, b},
                              {a, b, v(nan, nan, nan)},
                              {a, v(nan, 0, 0), c},
                              {v(0, 0, nan), b, c},
                              {a, b, v(0, inf, 0)},
                              {v(-inf, -inf, 0), v(inf, -inf, 0), v(0, inf, 0)}},
                             SolidKind::sheet);
    const SceneView<Real> view = scene.view();
    const test::Brute<Real> brute{view};
    Random random(6);
    for (int i = 0; i < 100000; ++i) {
        const Vec3<Real> origin(Vec3<Real>(random.direction() * 2.0));
        const Vec3<Real> target = i % 3 == 0   ? a
                                  : i % 3 == 1 ? along(a, Real(random.unit()), b - a)
                                               : Vec3<Real>(random.in_cube(1));
        ASSERT_FALSE(brute.closest(test::ray_from(origin, target - origin)).found()) << i;
    }
    // Nor does a ray that is not finite, or that goes nowhere, hit a triangle that is there.
    CompiledScene<Real> sound;
    test::add_clusters<Real>(sound, {{a, b, c}}, SolidKind::sheet);
    const SceneView<Real> sound_view = sound.view();
    const test::Brute<Real> through{sound_view};
    const Vec3<Real> origin(Real(0), Real(0), Real(1)), down(Real(0), Real(0), Real(-1));
    EXPECT_TRUE(through.closest(test::ray_from(origin, down)).found());
    for (int k = 0; k < 3; ++k)
        for (const Real bad : {nan, inf, -inf}) {
            Vec3<Real> broken = origin, skewed = down;
            broken[k] = skewed[k] = bad;
            EXPECT_FALSE(through.closest(test::ray_from(broken, down)).found());
            EXPECT_FALSE(through.closest(test::ray_from(origin, skewed)).found());
        }
    EXPECT_FALSE(through.closest(test::ray_from(origin, Vec3<Real>(Real(0)))).found());
}

TYPED_TEST(TriangleTest, TheSignOfDetTellsTheSide) {
    using Real = TypeParam;
    const Vec3<Real> a(Real(-1), Real(-1), Real(0)), b(Real(1), Real(-1), Real(0)), c(Real(0), Real(1), Real(0));
    for (int turn = 0; turn < 3; ++turn) {
        const auto permuted = [&](const Vec3<Real>& v) {
            return Vec3<Real>(v[turn], v[(turn + 1) % 3], v[(turn + 2) % 3]);
        };
        CompiledScene<Real> scene;
        test::add_clusters<Real>(scene, {{permuted(a), permuted(b), permuted(c)}}, SolidKind::mesh);
        const SceneView<Real> view = scene.view();
        for (const Real side : {Real(1), Real(-1)}) {
            const Vec3<Real> origin = permuted({Real(0.125), Real(-0.25), Real(2) * side});
            const Vec3<Real> direction = permuted({Real(0), Real(0), -side});
            Ray<Real> ray = test::ray_from(origin, direction);
            if (side > 0) ray.media.add(0, 1);  // first crossings come from the side that the list states
            const Hit<Real> refused = test::Brute<Real>{view}.closest(ray);
            EXPECT_FALSE(refused.found());
            EXPECT_EQ(refused.wrong_side_t, Real(2));
            ray.accept_both_sides();
            EXPECT_EQ(test::Brute<Real>{view}.closest(ray).t, Real(2));
            ray = test::ray_from(origin, direction);
            if (side < 0) ray.media.add(0, 1);
            const Hit<Real> hit = test::Brute<Real>{view}.closest(ray);
            ASSERT_TRUE(hit.found());
            EXPECT_EQ(hit.enters, side > 0);
            EXPECT_EQ(key_kind(hit.key), side > 0 ? CrossingKind::enter : CrossingKind::leave);
            EXPECT_EQ(hit.t, Real(2));
            const Vec3<Real> at = a * (Real(1) - hit.u - hit.v) + b * hit.u + c * hit.v;
            EXPECT_NEAR(double(at.x), 0.125, 4 * double(unit_of<Real>()));
            EXPECT_NEAR(double(at.y), -0.25, 4 * double(unit_of<Real>()));
        }
    }
}

// Eight lanes at once choose just the candidates that one lane at a time does.
TYPED_TEST(TriangleTest, ClusterPathEqualsTheOneLanePath) {
    using Real = TypeParam;
    Random random(7);
    int candidates = 0;
    for (int i = 0; i < 200000; ++i) {
        Cluster<Real> cluster{};
        cluster.count = 1 + random.below(cluster_lanes);
        // A coarse lattice, so that corners and edges are met exactly.
        for (auto& corner : cluster.corner)
            for (auto& axis : corner)
                for (Real& x : axis) x = Real(random.below(9)) / Real(4) - Real(1);
        const Vec3<Real> origin(Real(random.below(9)) / Real(4) - Real(1), Real(random.below(9)) / Real(4) - Real(1),
                                Real(-2));
        Vec3<Real> direction(Real(random.below(5)) / Real(4) - Real(0.5), Real(random.below(5)) / Real(4) - Real(0.5),
                             Real(1));
        if (i % 2) direction = Vec3<Real>(random.direction());
        const auto ray = TriangleRay<Real>::of(origin, direction);
        uint32_t one_by_one = 0;
        for (uint32_t lane = 0; lane < cluster.count; ++lane)
            one_by_one |= uint32_t(ShearedTriangle<Real>::of(cluster, int(lane), ray).within()) << lane;
        CandidateLanes<Real> lanes;
        ASSERT_EQ(cluster_candidates(cluster, ray, lanes), one_by_one);
        candidates += one_by_one != 0;
        // Alone in a cluster or among others, a triangle is crossed at the same bits, which are those of the scalar
        // test.
        for (uint32_t lane = 0; lane < cluster.count; ++lane) {
            if (!(one_by_one >> lane & 1u)) continue;
            const auto sheared = ShearedTriangle<Real>::of(cluster, int(lane), ray);
            for (int c = 0; c < 3; ++c) {
                ASSERT_EQ(lanes.edge[c][lane], sheared.edge[c]);
                ASSERT_EQ(lanes.z[c][lane], sheared.z[c]);
            }
            Cluster<Real> alone{};
            alone.count = 1;
            for (int c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis) alone.corner[c][axis][0] = cluster.corner[c][axis][lane];
            TriangleCrossing<Real> a{}, b{};
            CandidateLanes<Real> alone_lanes;
            ASSERT_EQ(cluster_candidates(alone, ray, alone_lanes), 1u);
            const bool crossed = cross_triangle(cluster, lanes, lane, ray, a);
            ASSERT_EQ(crossed, cross_triangle(alone, alone_lanes, 0, ray, b));
            if (!crossed) continue;
            ASSERT_TRUE(a.t == b.t && a.u() == b.u() && a.v() == b.v() && a.enters() == b.enters());
        }
    }
    EXPECT_GT(candidates, 20000);
}

// A ray and its reverse, both from outside, meet the same number of crossings, and the same faces away from edges.
TYPED_TEST(TriangleTest, BothDirectionsAgree) {
    using Real = TypeParam;
    SceneDescription description;
    test::add_object(description, test::solid_mesh(PlatonicSolid::icosahedron, dvec3(0), 1, dvec3(10, 20, 30)), 0);
    const auto scene = test::compile<Real>(description);
    const SceneView<Real> view = scene->view();
    const test::Brute<Real> brute{view};
    const auto triangles = test::all_triangles(*scene);
    Random random(8);
    int compared = 0;
    for (int i = 0; i < 50000; ++i) {
        const Aimed<Real> a = aim(random, triangles);
        const Vec3<Real> far = a.origin + a.direction * (Real(8) / length(a.direction));
        const Count there = test::cross_all(brute, test::ray_from(a.origin, a.direction));
        const Count back = test::cross_all(brute, test::ray_from(far, -a.direction));
        ASSERT_EQ(there.enters, there.leaves);
        ASSERT_EQ(back.enters, back.leaves);
        const double inside =
            test::chord(platonic_shape(PlatonicSolid::icosahedron), Rotation(dvec3(10, 20, 30)),
                        std::ldexp(1.0, scene->scale), 1e-4, dvec3(a.origin), normalized(dvec3(a.direction)));
        if (inside < 1e-3) continue;
        ++compared;
        ASSERT_EQ(there.enters, 1);
        ASSERT_EQ(back.enters, 1);
    }
    EXPECT_GT(compared, 30000);
}

}  // namespace
}  // namespace cistula
