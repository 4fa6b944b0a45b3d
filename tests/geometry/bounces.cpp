// A ray that bounces inside a closed solid stays there: convex solids by state, meshes by starting toward the apex.
#include <gtest/gtest.h>

#include <cmath>

#include "cistula/shading/snell.h"
#include "cistula/shading/surface.h"
#include "cistula/transport/ray_tree.h"
#include "cistula/traversal/bvh.h"
#include "testing/support/intersectors.h"
#include "testing/support/scene.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

using glm::dvec3;
using test::Random;
using test::Triangle;

/// How rays leave a face: as the renderer starts them, or by leaving out the face just hit and nothing else.
enum class Start { as_rendered, skip_key_only };

template <class Real>
struct Bounces {
    int done = 0, lost = 0, counted = 0, miscounted = 0;
    double farthest_out = 0;  // of hit points of convex solids, in u M
};

/// `targets`: what to aim at now and then.
template <class Real, class Intersector>
void bounce(const SceneView<Real>& scene, const Intersector& intersector, const std::vector<Vec3<Real>>& targets,
            const Vec3<Real>& inside, int bounces, Start start, Random& random, Bounces<Real>& result) {
    const bool convex = scene.solids[0].kind == SolidKind::convex;
    Ray<Real> ray;
    bool fresh_start = true;
    for (int i = 0; i < bounces; ++i, ++result.done) {
        if (fresh_start) {
            const Vec3<Real> target = targets[random.below(uint32_t(targets.size()))];
            ray = test::ray_from(inside, normalized(i % 2 ? target - inside : Vec3<Real>(random.direction())));
            ray.media.add(0, 1);
            fresh_start = false;
        }
        const Hit<Real> hit = intersector.closest(ray);
        if (!hit.found() || key_kind(hit.key) != CrossingKind::leave) {
            ++result.lost;
            fresh_start = true;
            continue;
        }
        if (i % 16 == 0 && start == Start::as_rendered) {
            // By parity: where the ray starts is inside, exactly, without any memory of the face that it left.
            Ray<Real> line = ray;
            if (!convex) line.from_solid = no_solid;
            const test::Count count = test::cross_all(intersector, line);
            ++result.counted;
            result.miscounted += count.leaves != count.enters + 1;
        }
        const Surface<Real> s = surface_at<Real, Effects<0>>(scene, ray, hit);
        if (convex)
            for (uint32_t k = 0; k < scene.solids[0].slab_count; ++k) {
                const Slab<Real>& slab = scene.slabs[scene.solids[0].first_slab + k];
                const double n = double(dot(slab.normal, s.point));
                const double out = max_or_second(n - double(slab.high), double(slab.low) - n);
                result.farthest_out =
                    max_or_second(result.farthest_out, out / double(RealTraits<Real>::unit * scene.extent));
            }
        Vec3<Real> direction = reflected(ray.direction, s.normal);
        if (random.below(4) ==
            0) {  // at a corner, an edge or the middle of a triangle, where that is not behind the face
            const Vec3<Real> aimed = normalized(targets[random.below(uint32_t(targets.size()))] - s.viewer_side);
            if (dot(aimed, s.normal) > Real(0)) direction = aimed;
        }
        ray = test::spawn(start == Start::as_rendered ? s.viewer_side : s.point, direction, hit, ray.media);
        if (start == Start::skip_key_only) ray.after = {Real(0), 0};
    }
}

template <class Real>
std::vector<Vec3<Real>> targets_of(Random& random, const std::vector<Triangle<Real>>& triangles) {
    std::vector<Vec3<Real>> targets;
    for (const Triangle<Real>& t : triangles) {
        targets.push_back(t[0]);
        targets.push_back(t[1] + (t[2] - t[1]) * Real(0.5));
        targets.push_back(t[0] + (t[1] - t[0]) * Real(random.unit()));
        targets.push_back((t[0] + t[1] + t[2]) / Real(3));
    }
    return targets;
}

template <class Real>
class BouncesTest : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(BouncesTest, Precisions);

TYPED_TEST(BouncesTest, NoneIsLostInConvexSolids) {
    using Real = TypeParam;
    Random random(1);
    Bounces<Real> result;
    for (const double scale : {1.0, 1e-5})
        for (const PlatonicSolid solid : test::platonic_solids)
            for (const dvec3& turn : {dvec3(0), random.in_cube(180)}) {
                SceneDescription description, mesh;
                test::add_solid(description, solid, dvec3(0), scale, turn);
                test::add_object(mesh, test::solid_mesh(solid, dvec3(0), scale, turn), 0);
                const auto scene = test::compile<Real>(description), triangles = test::compile<Real>(mesh);
                const SceneView<Real> view = scene->view();
                bounce(view, test::Brute<Real>{view}, targets_of(random, test::all_triangles(*triangles)),
                       Vec3<Real>(random.in_cube(0.1)), 60000, Start::as_rendered, random, result);
            }
    std::printf("%s: %d bounces, %d lost, %d of %d miscounted, points at most %.1f u M outside\n",
                RealTraits<Real>::name, result.done, result.lost, result.miscounted, result.counted,
                result.farthest_out);
    EXPECT_GE(result.done, 1000000);
    EXPECT_EQ(result.lost, 0);
    EXPECT_EQ(result.miscounted, 0);
    EXPECT_LE(result.farthest_out, 64);  // what boxes allow for
}

struct MeshCase {
    const char* name;
    TrianglesObject mesh;
    dvec3 inside;
};

std::vector<MeshCase> meshes() {
    std::vector<MeshCase> cases;
    cases.push_back({"torus", torus(1, 0.4, 16, 12), dvec3(1, 0.05, 0.1)});
    cases.push_back({"coarse torus", torus(1, 0.5, 5, 3), dvec3(0.8, 0.05, 0.02)});
    cases.push_back({"star", star(), dvec3(0.01, 0.02, -0.03)});
    cases.push_back({"sharp star", star(0.2, 1), dvec3(0.01, 0.02, -0.03)});
    cases.push_back({"bumpy sphere", bumpy_sphere(500), dvec3(0.01, 0.02, -0.03)});
    for (const PlatonicSolid solid : test::platonic_solids)
        cases.push_back(
            {platonic_name(solid), test::solid_mesh(solid, dvec3(0), 1, dvec3(10, 20, 30)), dvec3(0.01, 0.02, -0.03)});
    return cases;
}

template <class Real>
Bounces<Real> bounce_in_meshes(int each, Start start) {
    Random random(2);
    Bounces<Real> all;
    for (const double scale : {1.0, 1e-5})
        for (const MeshCase& c : meshes()) {
            SceneDescription description;
            TrianglesObject mesh = c.mesh;
            for (dvec3& v : mesh.vertices) v *= scale;
            test::add_object(description, mesh, 0);
            const auto scene = test::compile<Real>(description, true);
            const SceneView<Real> view = scene->view();
            EXPECT_EQ(view.solids[0].kind, SolidKind::mesh) << c.name;
            const dvec3 inside = (c.inside * scale - scene->center) * std::ldexp(1.0, scene->scale);
            Bounces<Real> result;
            bounce(view, test::Bvh<Real>{view}, targets_of(random, test::all_triangles(*scene)), Vec3<Real>(inside),
                   each, start, random, result);
            if (start == Start::as_rendered && (result.lost || result.miscounted))
                ADD_FAILURE() << c.name << " at scale " << scale << ": " << result.lost << " lost, "
                              << result.miscounted << " miscounted of " << result.done;
            all.done += result.done;
            all.lost += result.lost;
            all.counted += result.counted;
            all.miscounted += result.miscounted;
        }
    return all;
}

TYPED_TEST(BouncesTest, NoneIsLostInMeshes) {
    using Real = TypeParam;
    const Bounces<Real> result = bounce_in_meshes<Real>(60000, Start::as_rendered);
    std::printf("%s: %d bounces, %d lost, %d of %d miscounted\n", RealTraits<Real>::name, result.done, result.lost,
                result.miscounted, result.counted);
    EXPECT_GE(result.done, 1000000);
}

// The test above would notice: without the offset rays do get lost.
TYPED_TEST(BouncesTest, LeavingOutTheFaceAloneLosesRays) {
    using Real = TypeParam;
    const Bounces<Real> result = bounce_in_meshes<Real>(10000, Start::skip_key_only);
    std::printf("%s: %d bounces by skipping the key alone, %d lost\n", RealTraits<Real>::name, result.done,
                result.lost);
    EXPECT_GT(result.lost, 0);
}

/// What a ray sees of a white background through a clear mesh, as a share of it.
template <class Real>
double seen_through(const SceneView<Real>& scene, const Ray<Real>& ray, uint32_t& flags) {
    using Intersector = test::Bvh<Real>;
    using Stack = BranchStack<Branch<Real>>;
    TreeSettings settings;
    settings.fixed_scale = 0x1p62;
    settings.fixed_unit = 0x1p-62;
    PixelRecord record = PixelRecord();
    PixelSums<Real> sums(settings, scene, record, flags);
    PixelRays rays;
    typename Stack::Storage storage;
    Stack stack(storage);
    struct Unnoted {
        void surface(const Hit<Real>&, const Surface<Real>&) const {}
        void light(const SceneView<Real>&, const VisibleLightHit<Real>&, const Ray<Real>&) const {}
    };
    RayTree<Real, Effects<all_effects>, Intersector, Stack>(scene, Intersector{scene}, 4, sums, rays, stack)
        .trace(ray, Unnoted());
    return double(record.radiance[0]) * 0x1p-62 / double(scene.background.x);
}

// A line from inside a mesh that grazes a reflex edge leaves it and enters it again, by rounding perhaps the other way
// round: it first meets the face by which it leaves, and has both behind it when it goes straight on.
TYPED_TEST(BouncesTest, CrossingsPassedOverCount) {
    using Real = TypeParam;
    Random random(3);
    int passed_over = 0, wrong_side = 0, wrong_length = 0;
    uint32_t flags = 0;
    for (const MeshCase& c : meshes()) {
        SceneDescription description;
        description.background = dvec3(1);
        test::add_object(description, c.mesh, test::add_material(description, 0, 1));
        description.materials[0].absorption = dvec3(0.5);
        const auto compiled = test::compile<Real>(description, true);
        const SceneView<Real> scene = compiled->view();
        const double sigma = double(scene.materials[0].absorption.x);
        const test::Bvh<Real> intersector{scene};
        const auto targets = targets_of(random, test::all_triangles(*compiled));
        const Vec3<double> middle = (c.inside - compiled->center) * std::ldexp(1.0, compiled->scale);
        for (int i = 0; i < 60000; ++i) {
            const Vec3<Real> origin(middle + random.in_cube(0.01));
            const Vec3<Real> target = targets[random.below(uint32_t(targets.size()))];
            Ray<Real> ray = test::ray_from(origin, normalized(target - origin));
            ray.media.add(0, 1);
            const Hit<Real> first = intersector.closest(ray);
            wrong_side += !first.found() || first.enters;
            passed_over += first.wrong_side_t <= first.t;
            double inside = 0;  // the length, by all crossings
            Ray<Real> line = ray;
            line.accept_both_sides();
            for (Hit<Real> hit = intersector.closest(line); hit.found(); hit = intersector.closest(line)) {
                inside += hit.enters ? -double(hit.t) : double(hit.t);
                test::pass(line, hit);
            }
            const double expected = std::exp(-sigma * inside);
            wrong_length += !(magnitude(seen_through(scene, ray, flags) - expected) <= 1e-5 * expected);
        }
    }
    EXPECT_GT(passed_over, 10);
    EXPECT_EQ(wrong_side, 0);
    EXPECT_EQ(wrong_length, 0);
    EXPECT_EQ(flags, 0u);
}

}  // namespace
}  // namespace cistula
