// shadow.h: light through faces is an exact product, lights on edges light the right half-space, absorption is
// exponential.
#include "cistula/shading/shadow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cistula/shading/surface.h"
#include "cistula/traversal/brute.h"
#include "testing/support/scene.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

using glm::dvec3;
using test::Random;
using All = Effects<all_effects>;

template <class Real>
class ShadowTest : public testing::Test {
  public:
    static Vec3<double> in_frame(const CompiledScene<Real>& scene, const dvec3& world) {
        return (world - scene.center) * std::ldexp(1.0, scene.scale);
    }
    /// A shadow ray to a light, from a point in space.
    static ShadowRay<Real> toward(const Light<Real>& light, const Vec3<Real>& origin, const InteriorList& media = {}) {
        const Vec3<Real> to_light = light.position - origin;
        const Real distance = length(to_light);
        ShadowRay<Real> shadow{test::ray_from(origin, to_light / distance), distance, &light};
        shadow.ray.media = media;
        return shadow;
    }
    static Vec3<Real> light_at(const SceneView<Real>& scene, const ShadowRay<Real>& shadow) {
        return BruteIntersector<Real>{scene}.template transmittance<All>(shadow);
    }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ShadowTest, Precisions);

/// A square at height z, cut into n x n cells of two triangles each.
TrianglesObject sheet(double z, int n, bool flip) {
    TrianglesObject mesh;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) mesh.vertices.push_back({2.0 * x / n - 1, 2.0 * y / n - 1, z});
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const auto a = uint32_t(y * (n + 1) + x), b = a + 1, c = a + uint32_t(n) + 1, d = c + 1;
            if (flip) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({b, d, c});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({d, c, a});
            }
        }
    return mesh;
}

// Faces of transmission 2^-k: exactly 2^-(the sum), also along the edges and through the corners of triangles.
TYPED_TEST(ShadowTest, PowersOfTwoMultiplyExactly) {
    using Real = TypeParam;
    Random random(1);
    for (const int sheets : {1, 2, 5, 20})
        for (int solids = 0; solids <= 4; solids += 2) {
            SceneDescription description;
            int loss[2] = {0, 0};
            const auto glass = [&](int crossings) {
                const int k = int(random.below(2)), g = int(random.below(3));
                loss[0] += crossings * k;
                loss[1] += crossings * (k + g);
                return test::add_material(description, 0, std::ldexp(1.0, -k),
                                          dvec3(1, std::ldexp(1.0, -g), random.below(4) ? 1 : 0));
            };
            for (int i = 0; i < sheets; ++i) test::add_object(description, sheet(0.02 * i - 0.5, 4, i % 2), glass(1));
            for (int i = 0; i < solids; ++i) {
                const dvec3 center(0, 0, 0.05 + 0.1 * i);
                if (i % 2)
                    test::add_object(description, test::solid_mesh(PlatonicSolid::octahedron, center, 0.7), glass(2));
                else
                    test::add_solid(description, PlatonicSolid::dodecahedron, center, 0.6, random.in_cube(180),
                                    glass(2));
            }
            bool blue_stopped = false;
            for (const auto& m : description.materials) blue_stopped |= m.tint.z == 0;
            test::add_light(description, {0, 0, 2});
            const auto scene = test::compile<Real>(description);
            const SceneView<Real> view = scene->view();
            // Blue: tint 1 or 0, so the loss is that of red.
            const Vec3<Real> expected(Real(std::ldexp(1.0, -loss[0])), Real(std::ldexp(1.0, -loss[1])),
                                      blue_stopped ? Real(0) : Real(std::ldexp(1.0, -loss[0])));
            for (int i = 0; i < 2000; ++i) {
                // Straight below the light through the middle of all, at lattice points and lines, or anywhere near.
                dvec3 point(0, 0, -0.9);
                if (i % 4 == 1) point.x = random.between(-0.1, 0.1);
                if (i % 4 == 2) point.x = point.y = random.between(-0.1, 0.1);
                if (i % 4 == 3) point += dvec3(random.between(-0.1, 0.1), random.between(-0.1, 0.1), 0);
                const Vec3<Real> origin(TestFixture::in_frame(*scene, point));
                ASSERT_EQ(TestFixture::light_at(view, TestFixture::toward(view.lights[0], origin)), expected)
                    << sheets << " " << solids << " " << i;
            }
        }
}

TYPED_TEST(ShadowTest, OpaqueChannelsAreBlackAndTheOthersExact) {
    using Real = TypeParam;
    for (int stopped = 0; stopped < 8; ++stopped) {
        SceneDescription description;
        dvec3 tint(0.5);
        for (int c = 0; c < 3; ++c)
            if (stopped >> c & 1) tint[c] = 0;
        test::add_material(description, 0, 0.5, tint);
        test::add_solid(description, PlatonicSolid::cube);
        test::add_light(description, {0, 0, 5});
        const auto scene = test::compile<Real>(description);
        const SceneView<Real> view = scene->view();
        const auto shadow =
            TestFixture::toward(view.lights[0], Vec3<Real>(TestFixture::in_frame(*scene, {0.1, 0.1, -0.9})));
        const Vec3<Real> light = TestFixture::light_at(view, shadow);
        for (int c = 0; c < 3; ++c) EXPECT_EQ(light[c], stopped >> c & 1 ? Real(0) : Real(0.0625));
        // Where nothing is taken to be transparent, any face stops everything.
        EXPECT_EQ(BruteIntersector<Real>{view}.template transmittance<Effects<opaque_bodies>>(shadow), Real(0));
    }
}

// A light on a face, an edge or a corner: seen from outside any plane that it lies on, nothing of that solid is
// between; from behind all of them just the way in; from inside nothing.
TYPED_TEST(ShadowTest, LightsOnASolidObeyItsHalfSpaces) {
    using Real = TypeParam;
    Random random(2);
    int outside = 0, behind = 0, from_within = 0;
    for (const bool as_mesh : {false, true})
        for (const PlatonicSolid solid : test::platonic_solids)
            for (int where = 0; where < 9; ++where)
                for (const double transmission : {0.0, 0.25}) {
                    const Polyhedron& shape = platonic_shape(solid);
                    const dvec3 turn = where < 3 ? dvec3(0) : random.in_cube(180), center = random.in_cube(1);
                    const Rotation rotation(turn);
                    const auto& edge = shape.edges[random.below(uint32_t(shape.edges.size()))];
                    const auto& face = shape.faces[random.below(uint32_t(shape.faces.size()))];
                    dvec3 place = shape.vertices[edge.vertices[0]];
                    if (where % 3 == 1)
                        place += (shape.vertices[edge.vertices[1]] - place) * (where == 1 ? 0.5 : random.unit());
                    if (where % 3 == 2) place = face.normal * shape.inradius;
                    SceneDescription description;
                    test::add_material(description, 0, transmission);
                    if (as_mesh)
                        test::add_object(description, test::solid_mesh(solid, center, 1, turn), 0);
                    else
                        test::add_solid(description, solid, center, 1, turn);
                    test::add_light(description, center + rotation(place));
                    const auto scene = test::compile<Real>(description);
                    const SceneView<Real> view = scene->view();
                    ASSERT_GE(view.lights[0].incident_count, where % 3 == 2 ? 1u : where % 3 == 1 ? 2u : 3u);
                    for (int i = 0; i < 600; ++i) {
                        const dvec3 p = random.in_cube(2);
                        bool in_front = false, inside = true, clear = true;
                        for (const auto& f : shape.faces) {
                            const double out = dot(f.normal, p) - shape.inradius;
                            const bool incident = magnitude(dot(f.normal, place) - shape.inradius) < 1e-9;
                            in_front |= incident && out > 0;
                            inside &= out < 0;
                            clear &= magnitude(out) > 1e-3;
                        }
                        if (!clear) continue;
                        const Vec3<Real> origin(TestFixture::in_frame(*scene, center + rotation(p)));
                        InteriorList media;
                        if (inside) media.add(0, 1);
                        const Vec3<Real> light =
                            TestFixture::light_at(view, TestFixture::toward(view.lights[0], origin, media));
                        const Real expected = in_front || inside ? Real(1) : Real(transmission);
                        ASSERT_EQ(light, Vec3<Real>(expected))
                            << platonic_name(solid) << (as_mesh ? " mesh " : " ") << where;
                        ++(inside ? from_within : in_front ? outside : behind);
                    }
                }
    EXPECT_GT(outside, 10000);
    EXPECT_GT(behind, 10000);
    EXPECT_GT(from_within, 1000);
}

// exp(-sigma L) with L known: the chord's ends are planes met at a cosine of at least 1/2, so L is within 32 u M, the
// exponent within sigma times that and what Q31.32 rounds (meshes), and the share within 2 ulps more.
TYPED_TEST(ShadowTest, AbsorptionIsExponential) {
    using Real = TypeParam;
    Random random(3);
    const double u = double(RealTraits<Real>::unit);
    double worst = 0;
    for (const bool as_mesh : {false, true})
        for (const double sigma : {0.01, 1.0, 7.0, 30.0}) {
            SceneDescription description;
            test::add_material(description, 0, 1);
            description.materials[0].absorption = {sigma, 0, 2 * sigma};
            if (as_mesh)
                test::add_object(description, test::solid_mesh(PlatonicSolid::cube), 0);
            else
                test::add_solid(description, PlatonicSolid::cube);
            test::add_light(description, {0, 0, 1});
            test::add_light(description, {0.05, -0.03, 0.2});
            const auto scene = test::compile<Real>(description);
            const SceneView<Real> view = scene->view();
            const double half = 1 / std::sqrt(3.0), unit = std::ldexp(1.0, scene->scale);
            for (int i = 0; i < 4000; ++i) {
                const bool inside = i % 2;
                const bool light_inside = i / 2 % 2;
                const dvec3 light = light_inside ? dvec3(0.05, -0.03, 0.2) : dvec3(0, 0, 1);
                // Below the cube or in it, so that the line runs through the top and the bottom.
                const dvec3 p(random.between(-0.2, 0.2), random.between(-0.2, 0.2),
                              inside ? random.between(-0.5, 0.1) : -0.9);
                const double slope = length(light - p) / (light.z - p.z);
                const double top = min_or_second(light.z, half), bottom = max_or_second(p.z, -half);
                const double inner = (top - bottom) * slope;
                InteriorList media;
                if (inside) media.add(0, 1);
                const Vec3<Real> origin(TestFixture::in_frame(*scene, p));
                const Vec3<Real> found =
                    TestFixture::light_at(view, TestFixture::toward(view.lights[light_inside ? 1 : 0], origin, media));
                EXPECT_EQ(found.y, Real(1));
                for (int c = 0; c < 3; c += 2) {
                    const double s = c == 0 ? sigma : 2 * sigma, exact = std::exp(-s * inner);
                    const double doubt = s / unit * 32 * u * double(view.extent) + (as_mesh ? 0x1p-31 : 0) + 4 * u;
                    const double error = std::abs(double(found[c]) / exact - 1);
                    worst = max_or_second(worst, error / doubt);
                    ASSERT_LE(error, doubt) << as_mesh << " " << sigma << " " << i;
                }
            }
        }
    std::printf("%s: absorption is off by at most %.2f of the bound\n", RealTraits<Real>::name, worst);
}

// A face and its light's other side: a sheet that holds the light stops nothing, the next one does.
TYPED_TEST(ShadowTest, ASheetThatHoldsTheLightStopsNothing) {
    using Real = TypeParam;
    SceneDescription description;
    test::add_material(description);
    test::add_object(description, sheet(0, 1, false), 0);
    test::add_object(description, sheet(-0.5, 1, true), 0);
    test::add_light(description, {0.25, 0.1, 0});
    const auto scene = test::compile<Real>(description);
    const SceneView<Real> view = scene->view();
    const auto at = [&](double z) {
        return TestFixture::light_at(
            view, TestFixture::toward(view.lights[0], Vec3<Real>(TestFixture::in_frame(*scene, {0.3, 0.2, z}))));
    };
    EXPECT_EQ(at(0.4), Vec3<Real>(Real(1)));
    EXPECT_EQ(at(-0.4), Vec3<Real>(Real(1)));
    EXPECT_EQ(at(-0.8), Vec3<Real>(Real(0)));
}

/// Bodies of one glass that overlap take from light what their union does: half at each of its faces.
TYPED_TEST(ShadowTest, FacesBetweenEqualIndicesDoNotDarken) {
    using Real = TypeParam;
    Random random(5);
    size_t lines = 0, gained = 0;
    for (int turn = 0; turn < 200; ++turn) {
        SceneDescription description;
        test::add_material(description, 0.5, 0.5, dvec3(1), 1.5);
        description.materials[0].fresnel = true;
        struct Body {
            dvec3 center;
            double size;  // radius, or half the side of a cube
            bool is_ball;
        };
        std::vector<Body> bodies;
        for (uint32_t i = 0; i < 2 + random.below(3); ++i) {
            const Body body{0.6 * random.direction(), random.between(0.3, 0.9), random.below(2) == 0};
            if (body.is_ball) {
                SphereObject ball;
                ball.center = body.center, ball.radius = body.size;
                test::add_object(description, ball, 0);
            } else {
                TrianglesObject cube = triangulated_solid(
                    {.solid = PlatonicSolid::cube, .center = body.center, .radius = body.size * std::sqrt(3.0)});
                cube.keep_triangles = random.below(2) == 0;
                test::add_object(description, cube, 0);
            }
            bodies.push_back(body);
        }
        const dvec3 lamp = 3.0 * random.direction();
        test::add_light(description, lamp);
        const auto compiled = test::compile<Real>(description);
        const SceneView<Real> scene = compiled->view();
        for (int n = 0; n < 50; ++n) {
            const dvec3 from = 2.5 * random.direction(), way = lamp - from;
            std::vector<std::pair<double, double>> chords;
            bool clear_of_edges = true;
            for (const Body& body : bodies) {
                double enter = 0, leave = 1;
                const dvec3 off = from - body.center;
                if (body.is_ball) {
                    const double b = dot(off, way), a = dot(way, way),
                                 square = b * b - a * (dot(off, off) - body.size * body.size);
                    clear_of_edges &= std::abs(square) > 1e-2;
                    if (square < 0) continue;
                    enter = (-b - std::sqrt(square)) / a, leave = (-b + std::sqrt(square)) / a;
                } else {
                    for (int axis = 0; axis < 3; ++axis) {
                        const double u = (-body.size - off[axis]) / way[axis], v = (body.size - off[axis]) / way[axis];
                        enter = std::max(enter, std::min(u, v)), leave = std::min(leave, std::max(u, v));
                    }
                    clear_of_edges &= std::abs(leave - enter) > 1e-3;
                    if (enter > leave) continue;
                }
                if (enter > 0 && enter < leave && leave < 1) chords.emplace_back(enter, leave);
                clear_of_edges &= std::abs(enter) > 1e-3 && std::abs(leave - 1) > 1e-3;
            }
            std::sort(chords.begin(), chords.end());
            int faces = 0;
            double end = -1;
            for (const auto& [enter, leave] : chords) {
                clear_of_edges &= std::abs(enter - end) > 1e-4;
                faces += enter > end ? 2 : 0;
                end = std::max(end, leave);
            }
            if (!clear_of_edges) continue;
            const auto shadow =
                TestFixture::toward(scene.lights[0], Vec3<Real>(TestFixture::in_frame(*compiled, from)));
            const BruteIntersector<Real> brute{scene};
            Vec3<Real> arrives = brute.template transmittance<All>(shadow);
            const Real before = arrives.x;
            gain_unseen_faces<All>(scene, brute, shadow, true, arrives);
            EXPECT_EQ(arrives.x, Real(std::ldexp(1.0, -faces))) << turn << " " << n;
            EXPECT_TRUE(scene.unseen_faces || arrives.x == before) << "frames ask only then";
            ++lines, gained += arrives.x > before;
        }
    }
    EXPECT_GT(lines, 5000u);
    EXPECT_GT(gained, 400u);
}

}  // namespace
}  // namespace cistula
