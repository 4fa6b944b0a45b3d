// convex.h: one way in, one way out, whatever rounding says at edges, corners and in planes; and from far away.
#include "cistula/geometry/convex.h"

#include <gtest/gtest.h>
#include <quadmath.h>

#include "cistula/transport/pixel.h"
#include "testing/support/intersectors.h"
#include "testing/support/scene.h"

namespace cistula {
namespace {

using glm::dvec3;
using Quad = __float128;
using test::Count;
using test::Random;

/// A solid's corners in the frame of a scene that holds it alone.
std::vector<dvec3> corners(const Polyhedron& shape, const Rotation& rotation, double radius) {
    std::vector<dvec3> points;
    for (const dvec3& p : shape.vertices) points.push_back(rotation(p * radius));
    return points;
}

/// A corner, a point of an edge or its middle, the middle of a face, or a point close to the silhouette.
dvec3 target_on(Random& random, const Polyhedron& shape, const std::vector<dvec3>& points) {
    const auto& face = shape.faces[random.below(uint32_t(shape.faces.size()))];
    const auto& edge = shape.edges[random.below(uint32_t(shape.edges.size()))];
    const dvec3 &a = points[edge.vertices[0]], &b = points[edge.vertices[1]];
    switch (random.below(4)) {
        case 0:
            return points[random.below(uint32_t(points.size()))];
        case 1:
            return a + (b - a) * (random.below(2) ? 0.5 : random.unit());
        case 2:
            return (a + (b - a) * random.unit()) * (1 + random.between(-1, 1) * 0x1p-20);
        default: {
            dvec3 sum(0);
            for (const uint32_t v : face.vertices) sum += points[v];
            return sum / double(face.vertices.size());
        }
    }
}

template <class Real>
class ConvexTest : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ConvexTest, Precisions);

TYPED_TEST(ConvexTest, SolidsAreEnteredAndLeftExactlyOnce) {
    using Real = TypeParam;
    Random random(1);
    int rays = 0, through = 0, missed = 0;
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const PlatonicSolid solid : test::platonic_solids)
            for (const dvec3& turn : {dvec3(0), dvec3(31, 47, 11), dvec3(random.in_cube(180))}) {
                SceneDescription description;
                test::add_solid(description, solid, dvec3(3, -2, 5) * scale, scale, turn);
                const auto scene = test::compile<Real>(description);
                const SceneView<Real> view = scene->view();
                ASSERT_EQ(view.convex.size, 1u);
                const Polyhedron& shape = platonic_shape(solid);
                const double radius = std::ldexp(scale, scene->scale);
                const dvec3 center = (dvec3(3, -2, 5) * scale - scene->center) * std::ldexp(1.0, scene->scale);
                const auto points = corners(shape, Rotation(turn), radius);
                const test::Brute<Real> brute{view};
                for (int i = 0; i < 24000; ++i, ++rays) {
                    const dvec3 target = center + target_on(random, shape, points);
                    dvec3 from = random.direction() * 3.5;
                    if (i % 8 == 0) from = target, from[int(random.below(3))] = random.below(2) ? 3.5 : -3.5;
                    const Vec3<Real> origin(from);
                    const Vec3<Real> direction = normalized(Vec3<Real>(target) - origin);
                    const Count count = test::cross_all(brute, test::ray_from(origin, direction));
                    ASSERT_EQ(count.enters, count.leaves) << platonic_name(solid) << " " << i;
                    ASSERT_LE(count.enters, 1);
                    const double inside =
                        test::chord(shape, Rotation(turn), radius, 1e-4, dvec3(origin) - center, dvec3(direction));
                    const double around =
                        test::chord(shape, Rotation(turn), radius, -1e-4, dvec3(origin) - center, dvec3(direction));
                    if (inside > 1e-3) {
                        ASSERT_EQ(count.enters, 1) << platonic_name(solid) << " " << i;
                        ++through;
                    }
                    if (around < 0) {
                        ASSERT_EQ(count.enters, 0);
                    }
                    missed += count.enters == 0;
                    // From a point inside, anywhere on the same line or at a face: out once, never in.
                    Ray<Real> ray = test::ray_from(Vec3<Real>(center + (target - center) * (i % 3 ? random.unit() : 1)),
                                                   i % 2 ? direction : Vec3<Real>(random.direction()));
                    ray.media.add(0, 1);
                    const Count out = test::cross_all(brute, ray);
                    ASSERT_EQ(out.enters, 0) << platonic_name(solid) << " " << i;
                    ASSERT_EQ(out.leaves, 1) << platonic_name(solid) << " " << i;
                }
            }
    std::printf("%s: %d rays, %d through, %d past\n", RealTraits<Real>::name, rays, through, missed);
    EXPECT_GT(rays, 1000000);
    EXPECT_GT(through, 500000);
    EXPECT_GT(missed, 10000);
}

// The sphere that spares rays the slabs never takes a hit away.
TYPED_TEST(ConvexTest, TheSphereAroundASolidDecidesNothing) {
    using Real = TypeParam;
    Random random(2);
    int hits = 0, grazed = 0;
    for (const PlatonicSolid solid : test::platonic_solids)
        for (const double size : {1.0, 0.01, 0.0001}) {
            SceneDescription description;
            const dvec3 turn = random.in_cube(180), place = random.in_cube(0.5);
            description.frame = FrameOfReference{dvec3(0), 0, {}};
            test::add_solid(description, solid, place, size, turn);
            const auto scene = test::compile<Real>(description);
            const SceneView<Real> view = scene->view();
            CompiledScene<Real> bare = *scene;
            for (Solid& s : bare.solids) s.padded_square = 1e30f;
            const SceneView<Real> bare_view = bare.view();
            const Polyhedron& shape = platonic_shape(solid);
            const auto points = corners(shape, Rotation(turn), size);
            for (int i = 0; i < 40000; ++i) {
                const Vec3<Real> origin(random.direction() * 3.9);
                Vec3<Real> target(place + target_on(random, shape, points));
                if (i % 2) target += Vec3<Real>(random.in_cube(1e-6));
                const Ray<Real> ray = test::ray_from(origin, normalized(target - origin));
                const Hit<Real> a = test::Brute<Real>{view}.closest(ray), b = test::Brute<Real>{bare_view}.closest(ray);
                ASSERT_TRUE(a.t == b.t && a.key == b.key) << platonic_name(solid) << " " << size << " " << i;
                hits += a.found();
                grazed += !a.found();
            }
        }
    EXPECT_GT(hits, 100000);
    EXPECT_GT(grazed, 10000);
}

TYPED_TEST(ConvexTest, ParallelRaysAndSignedZeros) {
    using Real = TypeParam;
    SceneDescription description;
    test::add_solid(description, PlatonicSolid::cube);
    const auto scene = test::compile<Real>(description);
    const SceneView<Real> view = scene->view();
    const test::Brute<Real> brute{view};
    const Real half = view.slabs[0].high;
    const Real smallest = std::numeric_limits<Real>::denorm_min(), least_normal = std::numeric_limits<Real>::min();
    for (int axis = 0; axis < 3; ++axis)
        for (const Real sign : {Real(1), Real(-1)})
            for (const Real tiny : {Real(0), -Real(0), smallest, -smallest, least_normal / 4, -least_normal / 4,
                                    least_normal, -least_normal, Real(0x1p-100), Real(-0x1p-100)})
                for (const Real other : {Real(0), -Real(0)})
                    for (const Real at : {Real(0), half / 2, half, -half, std::nextafter(half, Real(2)),
                                          std::nextafter(half, Real(0))}) {
                        Vec3<Real> origin(Real(0)), direction(other);
                        origin[axis] = -2 * sign;
                        origin[(axis + 1) % 3] = at;
                        direction[axis] = sign;
                        direction[(axis + 1) % 3] = tiny;
                        const Ray<Real> ray = test::ray_from(origin, direction);
                        const Hit<Real> hit = brute.closest(ray);
                        const Count count = test::cross_all(brute, ray);
                        ASSERT_EQ(count.enters, count.leaves);
                        // In a face's plane, or beyond it, a ray that does not come in misses.
                        const bool outward = at >= half ? tiny >= 0 : at <= -half && tiny <= 0;
                        if (magnitude(at) < half) {
                            ASSERT_TRUE(hit.found()) << axis << " " << double(at) << " " << double(tiny);
                            ASSERT_EQ(hit.t, Real(2) - half);
                        } else if (outward) {
                            ASSERT_FALSE(hit.found()) << axis << " " << double(at) << " " << double(tiny);
                        }
                    }
    // From the inside a parallel plane says nothing, even where the origin lies on it.
    for (const Real at : {Real(0), half, -half})
        for (const Real tiny : {Real(0), -Real(0), smallest, -smallest}) {
            Ray<Real> ray = test::ray_from(Vec3<Real>(at, Real(0), Real(0)), Vec3<Real>(tiny, Real(0), Real(1)));
            ray.media.add(0, 1);
            const Hit<Real> hit = brute.closest(ray);
            ASSERT_TRUE(hit.found());
            ASSERT_EQ(key_kind(hit.key), CrossingKind::leave);
            ASSERT_TRUE(hit.t == half || (hit.t == Real(0) && magnitude(at) == half));
        }
}

TYPED_TEST(ConvexTest, TouchingSolidsShareTheirFace) {
    using Real = TypeParam;
    Random random(3);
    int shared = 0;
    for (const PlatonicSolid solid :
         {PlatonicSolid::cube, PlatonicSolid::octahedron, PlatonicSolid::dodecahedron, PlatonicSolid::icosahedron})
        for (int placement = 0; placement < 6; ++placement) {
            const Polyhedron& shape = platonic_shape(solid);
            const dvec3 turn = placement == 0 ? dvec3(0) : random.in_cube(180), center = random.in_cube(1);
            const dvec3 normal = Rotation(turn)(shape.faces[random.below(uint32_t(shape.faces.size()))].normal);
            SceneDescription description;
            test::add_solid(description, solid, center, 1, turn);
            test::add_solid(description, solid, center + normal * (2 * shape.inradius), 1, turn);
            const auto scene = test::compile<Real>(description);
            const SceneView<Real> view = scene->view();
            const test::Brute<Real> brute{view};
            const double factor = std::ldexp(1.0, scene->scale);
            for (int i = 0; i < 5000; ++i) {
                // Through the shared face well inside its edges, from either side.
                const dvec3 across = random.direction();
                const dvec3 middle =
                    (center + normal * shape.inradius + (across - dot(across, normal) * normal) * 0.1 - scene->center) *
                    factor;
                const dvec3 way = normalized(normal * (i % 2 ? 1.0 : -1.0) + random.in_cube(0.2));
                Ray<Real> ray = test::ray_from(Vec3<Real>(middle - way * 3.0), Vec3<Real>(way));
                Hit<Real> hits[4];
                for (Hit<Real>& hit : hits) {
                    hit = brute.closest(ray);
                    ASSERT_TRUE(hit.found());
                    test::pass(ray, hit);
                }
                ASSERT_FALSE(brute.closest(ray).found());
                // Enter one; enter the other and leave the first at one t, in this order; leave the other.
                ASSERT_EQ(hits[1].t, hits[2].t);
                ASSERT_EQ(key_kind(hits[1].key), CrossingKind::enter);
                ASSERT_EQ(key_kind(hits[2].key), CrossingKind::leave);
                ASSERT_EQ(key_solid(hits[0].key), key_solid(hits[2].key));
                ASSERT_EQ(key_solid(hits[1].key), key_solid(hits[3].key));
                ++shared;
            }
        }
    EXPECT_EQ(shared, 4 * 6 * 5000);
}

// Against 113 bits: a camera far away sees the right face wherever the point is farther from an edge than rounding
// goes: 8 u of double times the distance for the line, 16 u of Real for its start in the scene.
TYPED_TEST(ConvexTest, FarCamerasSeeTheRightFace) {
    using Real = TypeParam;
    Random random(4);
    int compared = 0, close = 0;
    for (const PlatonicSolid solid : test::platonic_solids)
        for (const double distance : {1.9, 1e3, 1e5, 1e7, 1e9}) {
            SceneDescription description;
            test::add_solid(description, solid, dvec3(0), 1.5, random.in_cube(180));
            const auto scene = test::compile<Real>(description);
            const SceneView<Real> view = scene->view();
            const Solid& record = view.solids[0];
            FrameView frame;
            const dvec3 forward = random.direction();
            const dvec3 right = normalized(cross(forward, random.direction())), up = cross(right, forward);
            frame.camera = {forward * -distance, forward, right, up, 1.6 / distance};
            frame.camera_sides[0].start = frame.camera.position;
            frame.is_far = is_far(frame.camera.position, double(view.extent));
            frame.width = frame.height = 100;
            const Quad doubt = Quad(8 * 0x1p-53 * distance) + Quad(16 * double(RealTraits<Real>::unit));
            for (int i = 0; i < 4000; ++i) {
                const double x = random.between(0, 100), y = random.between(0, 100);
                Ray<Real> ray;
                dvec3 direction;
                double start;
                const bool meets = primary_ray(view, frame, x, y, ray, direction, start);
                const Hit<Real> hit = meets ? test::Brute<Real>{view}.closest(ray) : Hit<Real>();
                const Quad sx = (2 * Quad(x) / 100 - 1) * Quad(frame.camera.tan_half_width);
                const Quad sy = (1 - 2 * Quad(y) / 100) * Quad(frame.camera.tan_half_width);
                Quad d[3], o[3], square = 0;
                for (int k = 0; k < 3; ++k) {
                    d[k] = Quad(forward[k]) + sx * Quad(right[k]) + sy * Quad(up[k]);
                    o[k] = Quad(frame.camera.position[k]);
                    square += d[k] * d[k];
                }
                for (Quad& c : d) c /= sqrtq(square);
                // The farthest entering plane and the nearest leaving one, each with its doubt along the ray.
                struct Plane {
                    Quad t, doubt;
                    uint32_t face;
                };
                std::vector<Plane> entering;
                Quad leave = 1e30, certain_leave = 1e30;
                for (uint32_t s = 0; s < record.slab_count; ++s) {
                    const Slab<Real>& slab = view.slabs[record.first_slab + s];
                    Quad nd = 0, no = 0;
                    for (int k = 0; k < 3; ++k) nd += Quad(slab.normal[k]) * d[k], no += Quad(slab.normal[k]) * o[k];
                    const Quad low = (Quad(slab.low) - no) / nd, high = (Quad(slab.high) - no) / nd,
                               slack = doubt / fabsq(nd);
                    const Quad in = nd > 0 ? low : high, out = nd > 0 ? high : low;
                    if (finiteq(in)) entering.push_back({in, slack, 2 * s + (nd > 0 ? 0 : 1)});
                    leave = fminq(leave, out + slack);
                    certain_leave = fminq(certain_leave, out - slack);
                }
                const Plane* best = &entering[0];
                for (const Plane& p : entering) best = p.t > best->t ? &p : best;
                bool clear = true;
                for (const Plane& p : entering) clear &= &p == best || p.t + p.doubt < best->t - best->doubt;
                if (best->t - best->doubt > leave) {
                    ASSERT_FALSE(hit.found()) << distance;
                } else if (clear && best->t + best->doubt < certain_leave) {
                    ASSERT_TRUE(hit.found()) << distance << " " << platonic_name(solid);
                    ASSERT_EQ(key_face(hit.key), best->face) << distance;
                    ASSERT_LE(double(fabsq(Quad(start) + Quad(hit.t) - best->t)), double(best->doubt)) << distance;
                    ++compared;
                } else {
                    ++close;
                }
            }
        }
    std::printf("%s: %d compared, %d too close to an edge\n", RealTraits<Real>::name, compared, close);
    EXPECT_GT(compared, 20000);
    EXPECT_LT(close, compared / 100);
}

}  // namespace
}  // namespace cistula
