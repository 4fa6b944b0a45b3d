// Ray trees in glass meshes with all kinds of normals (docs/rules.md, 17): of every line that leaves a face, on which
// side it goes, and whether one inside finds its way out.
#include "cistula/transport/pixel.h"
#include "cistula/traversal/bvh.h"
#include "scene/compile/scene_source.h"
#include "testing/support/contacts/contact_walk.h"
#include "testing/support/intersectors.h"
#include "verify/cases/smooth/round_mesh.h"

namespace cistula {
namespace {

using namespace test;
using verify::smooth::ring_mesh;
using verify::smooth::round_mesh;

struct SmoothCounts {
    size_t lines = 0, inward = 0, lost = 0, not_unit = 0;
};

/// Checks each line where it starts.
template <class Real>
struct CheckedSides {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const test::Bvh<Real> inner;
    const SceneView<Real>& scene;
    const std::vector<uint32_t>& slots;  // of triangles
    SmoothCounts& counts;

    template <class E = Effects<all_effects>>
    Hit<Real> closest(const Ray<Real>& ray) const {
        const Hit<Real> hit = inner.template closest<E>(ray);
        if (!ray.fresh() || ray.from_solid == no_solid) return hit;
        ++counts.lines;
        const bool inside = ray.media.contains(ray.from_solid);
        const uint32_t slot = slots[ray.from_face];
        const Vec3<Real> out = outward_normal(scene, slot);
        if (corner_normals(scene, slot))  // flat faces mirror to within rounding
            counts.inward += !((inside ? -dot(ray.direction, out) : dot(ray.direction, out)) > Real(0));
        counts.not_unit += !(magnitude(dot(ray.direction, ray.direction) - 1) < 16 * RealTraits<Real>::unit);
        counts.lost += inside && !hit.found();
        return hit;
    }
    template <class E>
    Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        return inner.template transmittance<E>(shadow);
    }
};

enum class Normals { given, zero, not_finite, noise, apart, random };

/// Spoils the normals of a mesh; at least half of them stay of use.
void spoil(TrianglesObject& mesh, Normals kind, Random& random) {
    for (size_t i = 0; i < mesh.normals.size(); ++i) {
        dvec3& n = mesh.normals[i];
        if (kind == Normals::zero && i % 3 == 0) n = dvec3(0);
        if (kind == Normals::not_finite && i % 3 == 0) n = {NAN, 0, 1};
        if (kind == Normals::noise) n = normalized(n + 0.8 * random.direction());
        if (kind == Normals::apart)  // neighbors are up to 165 degrees apart
            n = normalized(0.14 * n + (i % 2 == 0 ? 1.0 : -1.0) * normalized(cross(n, random.direction())));
        if (kind == Normals::random && i % 3 != 2) n = random.direction();
    }
}

template <class Real>
void walk_smooth(TrianglesObject mesh, Normals kind, size_t lines, SmoothCounts& counts) {
    Random random(11);
    spoil(mesh, kind, random);
    SceneDescription scene;
    scene.frame = FrameOfReference{};
    scene.background = dvec3(1);
    add_material(scene, 0, 1, dvec3(1), 1.5);
    scene.materials[0].fresnel = true;
    add_light(scene, {3, 2, 4});
    const std::vector<dvec3> vertices = mesh.vertices;
    const auto triangles = mesh.triangles;
    add_object(scene, std::move(mesh), 0);
    const auto compiled = compile<Real>(scene, true);
    const SceneView<Real> view = compiled->view();
    ASSERT_TRUE(is_smooth(view.solids[0]));
    std::vector<uint32_t> slots(triangles.size());
    for (uint32_t c = 0; c < view.clusters.size; ++c)
        for (uint32_t lane = 0; lane < view.clusters[c].count; ++lane)
            slots[view.clusters[c].triangle[lane]] = c * cluster_lanes + lane;
    const CheckedSides<Real> checked{{view}, view, slots, counts};
    const size_t end = counts.lines + lines;
    for (size_t turn = 0; turn < lines && counts.lines < end; ++turn) {
        const auto& t = triangles[random.below(uint32_t(triangles.size()))];
        const double a = random.unit(), b = random.unit() * (1 - a);
        const dvec3 p = vertices[t[0]] + a * (vertices[t[1]] - vertices[t[0]]) + b * (vertices[t[2]] - vertices[t[0]]);
        const dvec3 face = normalized(cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]));
        dvec3 o = 1.8 * random.direction();
        if (random.below(2) == 0)  // so flat that rounding counts
            o = p + 1.4 * normalized(normalized(cross(face, random.direction())) +
                                     std::pow(10, random.between(-8, 0)) * face);
        Ray<Real> ray;
        ray.origin = Vec3<Real>(o);
        ray.direction = Vec3<Real>(normalized(p - o));
        if (!camera_solids(view, checked.inner, o, ray.media)) continue;
        EXPECT_EQ(trace_tree(view, checked, ray, 10), 0u);
    }
}

template <class Real>
class SmoothMeshes : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(SmoothMeshes, Reals);

TYPED_TEST(SmoothMeshes, SendNoLineToTheWrongSide) {
    using Real = TypeParam;
    const auto ball = [](const dvec3&) { return 1.0; };
    const auto bumpy = [](const dvec3& d) {
        return 0.8 + 0.15 * std::sin(5 * d.x + 1) * std::sin(4 * d.y + 2) * std::cos(3 * d.z);
    };
    const auto lentil = [](const dvec3& d) { return 1 / std::sqrt(d.x * d.x + d.y * d.y + 900 * d.z * d.z); };
    const std::pair<const char*, TrianglesObject> shapes[] = {{"ball", round_mesh(2, ball)},
                                                              {"bumpy", round_mesh(2, bumpy)},
                                                              {"ring", ring_mesh(24, 12, 0.7, 0.3)},
                                                              {"lentil", round_mesh(2, lentil)}};
    SmoothCounts all;
    for (const auto& [name, mesh] : shapes)
        for (int kind = 0; kind <= int(Normals::random); ++kind) {
            SmoothCounts counts;
            walk_smooth<Real>(mesh, Normals(kind), 42'000, counts);
            std::printf("%-6s %-6s %d: %zu lines, inward %zu lost %zu not unit %zu\n", RealTraits<Real>::name, name,
                        kind, counts.lines, counts.inward, counts.lost, counts.not_unit);
            all.lines += counts.lines, all.inward += counts.inward, all.lost += counts.lost;
            all.not_unit += counts.not_unit;
        }
    EXPECT_GT(all.lines, 1'000'000u);
    EXPECT_EQ(all.inward, 0u);
    EXPECT_EQ(all.lost, 0u);
    EXPECT_EQ(all.not_unit, 0u);
}

}  // namespace
}  // namespace cistula
