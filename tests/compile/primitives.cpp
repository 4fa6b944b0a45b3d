// Clusters, boxes and trees of compiled scenes.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "scene/compile/compiled_scene.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using samples::add_light;
using samples::add_object;
using samples::empty_scene;
using samples::solid;

template <class Real>
class CompilePrimitives : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CompilePrimitives, Precisions);

TYPED_TEST(CompilePrimitives, EveryTriangleIsInExactlyOneLane) {
    SceneDescription scene = empty_scene();
    add_object(scene, torus(1, 0.3, 40, 30));
    add_object(scene, triangle_soup(1000, 0.2, 7));
    const auto compiled = compile_scene<TypeParam>(scene);
    ASSERT_EQ(compiled->solids[0].kind, SolidKind::mesh);
    ASSERT_EQ(compiled->solids[1].kind, SolidKind::sheet);
    EXPECT_EQ(compiled->solids[1].first_triangle, 2400u);
    std::set<uint32_t> seen;
    for (const auto& cluster : compiled->clusters) {
        ASSERT_GE(cluster.count, 1u);
        ASSERT_LE(cluster.count, 8u);
        for (uint32_t lane = 0; lane < 8; ++lane) {
            const bool zero = [&] {
                for (int axis = 0; axis < 3; ++axis)
                    for (int c = 1; c < 3; ++c)
                        if (cluster.corner[c][axis][lane] != cluster.corner[0][axis][lane]) return false;
                return true;
            }();
            EXPECT_EQ(zero, lane >= cluster.count);
            if (lane >= cluster.count) continue;
            EXPECT_TRUE(seen.insert(cluster.triangle[lane]).second);
            EXPECT_EQ(cluster.solid, cluster.triangle[lane] < 2400 ? 0u : 1u);
        }
    }
    EXPECT_EQ(seen.size(), 3400u);
    EXPECT_EQ(*seen.rbegin(), 3399u);
}

template <class Real>
void check_tree(const SceneView<Real>& scene, int32_t node, int depth, std::multiset<uint32_t>& found,
                PaddedBox& whole) {
    ASSERT_LE(depth, max_tree_depth);
    const TreeNode& n = scene.tree[static_cast<uint32_t>(node)];
    whole = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int side = 0; side < 2; ++side) {
        PaddedBox child = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        if (n.child[side] >= 0) {
            check_tree(scene, n.child[side], depth + 1, found, child);
        } else {
            EXPECT_LE(n.count[side], 2u);
            for (uint32_t i = 0; i < n.count[side]; ++i) {
                const uint32_t item = scene.tree_items[static_cast<uint32_t>(~n.child[side]) + i];
                found.insert(item);
                const PaddedBox box = primitive_box(scene, item);
                for (int axis = 0; axis < 3; ++axis) {
                    child.low[axis] = std::min(child.low[axis], box.low[axis]);
                    child.high[axis] = std::max(child.high[axis], box.high[axis]);
                }
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(n.low[side][axis], child.low[axis]);
            EXPECT_GE(n.high[side][axis], child.high[axis]);
            whole.low[axis] = std::min(whole.low[axis], n.low[side][axis]);
            whole.high[axis] = std::max(whole.high[axis], n.high[side][axis]);
        }
    }
}

TYPED_TEST(CompilePrimitives, TreesHoldEveryPrimitiveOnceInNestedBoxes) {
    for (const int quality : {0, 1}) {
        for (const uint32_t triangles : {0u, 5u, 3000u}) {
            SceneDescription scene = empty_scene();
            add_object(scene, solid(PlatonicSolid::dodecahedron, {2, 0, 0}));
            if (triangles > 0) add_object(scene, triangle_soup(triangles, 0.3, 3));
            const auto compiled = compile_scene<TypeParam>(scene);
            build_primitive_tree(*compiled, quality);
            const auto view = compiled->view();
            std::multiset<uint32_t> found;
            PaddedBox whole;
            check_tree(view, 0, 1, found, whole);
            EXPECT_EQ(found.size(), view.convex.size + view.clusters.size);
            EXPECT_EQ(std::set<uint32_t>(found.begin(), found.end()).size(), found.size());
        }
    }
}

TYPED_TEST(CompilePrimitives, BoxesOfConvexSolidsHoldTheirCornersPushedOut) {
    for (int kind = 0; kind < 5; ++kind) {
        SceneDescription scene = empty_scene();
        SolidObject object = solid(static_cast<PlatonicSolid>(kind), {0.5, 0.25, 0}, 0.75);
        object.rotation = {11, 22, 33};
        add_object(scene, object);
        scene.frame = FrameOfReference{{0, 0, 0}, 0, {}};
        const auto compiled = compile_scene<TypeParam>(scene);
        const PaddedBox box = primitive_box(compiled->view(), 0);
        const TrianglesObject corners = triangulated_solid(object);
        for (int axis = 0; axis < 3; ++axis) {
            double low = INFINITY, high = -INFINITY;
            for (const auto& p : corners.vertices) low = std::min(low, p[axis]), high = std::max(high, p[axis]);
            const double pad = (0x1p-18 + 64 * 0x1p-24) * double(compiled->extent);
            EXPECT_LE(box.low[axis], low - pad * 0.99);
            EXPECT_GE(box.high[axis], high + pad * 0.99);
            EXPECT_GE(box.low[axis], low - 8 * pad);
            EXPECT_LE(box.high[axis], high + 8 * pad);
        }
    }
}

/// Every light and every node but the first is one node's child.
template <class Real>
void expect_each_once(const CompiledScene<Real>& compiled) {
    std::multiset<int32_t> children;
    for (const LightNode& node : compiled.visible_light_tree)
        for (int i = 0; i < LightNode::width; ++i)
            if (node.has_child(i)) children.insert(node.children.of[i]);
    const auto lights = static_cast<int32_t>(compiled.visible_lights.size()),
               nodes = static_cast<int32_t>(compiled.visible_light_tree.size());
    for (int32_t light = 0; light < lights; ++light) EXPECT_EQ(children.count(~light), 1u) << light;
    for (int32_t node = 1; node < nodes; ++node) EXPECT_EQ(children.count(node), 1u) << node;
    EXPECT_EQ(children.size(), static_cast<size_t>(lights + nodes - 1));
}

TYPED_TEST(CompilePrimitives, VisibleLightsInOnePlaceAreAllInTheTree) {
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 21; ++i) add_light(scene, {i == 7 ? 2.0 : 1.0, 0, 0}).radius = 0.01;
    const auto compiled = compile_scene<TypeParam>(scene);
    ASSERT_EQ(compiled->visible_lights.size(), 21u);
    expect_each_once(*compiled);
}

TYPED_TEST(CompilePrimitives, VisibleLightsGetATreeWhereThereAreMany) {
    SceneDescription scene = empty_scene();
    SolidObject object = solid(PlatonicSolid::icosahedron);
    object.edge_lights.count = 6;
    object.edge_lights.radius = 0.01;
    add_object(scene, object);
    const auto compiled = compile_scene<TypeParam>(scene);
    ASSERT_EQ(compiled->visible_lights.size(), 180u);
    expect_each_once(*compiled);
    EXPECT_LT(compiled->visible_light_tree.size(), 2 * 60u);  // 60 would be full
}

}  // namespace
}  // namespace cistula
