#include "scene/light_roots.h"

#include "cistula/light_tree.h"
#include "scene/edge_light_reach.h"

namespace cistula {
namespace {

template <class Visit>
void for_each_child(const LightNode& node, const Visit& visit) {
    for (int i = 0; i < LightNode::width; ++i)
        if (node.has_child(i)) visit(node.children.of[i]);
}

/// Whether a light may reach into a convex solid.
template <class Real>
bool touches(const SceneView<Real>& scene, const Solid& solid, const SeenLight<Real>& light) {
    const Real reach = light.radius + Real(light_slack) * scene.extent;
    for (uint32_t i = 0; i < solid.slab_count; ++i) {
        const Slab<Real>& slab = scene.slabs[solid.first_slab + i];
        const Real at = dot(slab.normal, light.center);
        if (at > slab.high + reach || at < slab.low - reach) return false;
    }
    return true;
}

/// Whether any light does that is `child`, or below it.
template <class Real>
bool any_touches(const SceneView<Real>& scene, const Solid& solid, int32_t child) {
    if (child < 0) return touches(scene, solid, scene.seen_lights[uint32_t(~child)]);
    bool any = false;
    for_each_child(scene.seen_tree[uint32_t(child)],
                   [&](int32_t next) { any = any || any_touches(scene, solid, next); });
    return any;
}

template <class Real>
int32_t light_root(const SceneView<Real>& scene, const Solid& solid) {
    for (int32_t root = LightStack::root;;) {
        int count = 0;
        int32_t last = root;
        for_each_child(scene.seen_tree[uint32_t(root)], [&](int32_t child) {
            if (any_touches(scene, solid, child)) ++count, last = child;
        });
        if (count == 0) return LightStack::root;
        if (count > 1 || last < 0) return root;
        root = last;
    }
}

}  // namespace

template <class Real>
void find_light_roots(const SceneView<Real>& scene, int32_t (&roots)[ShadowPlan::solids]) {
    for (uint32_t i = 0; i < ShadowPlan::solids; ++i) {
        const bool has = i < scene.solids.size && scene.solids[i].kind == SolidKind::convex && !scene.seen_tree.empty();
        roots[i] = has ? light_root(scene, scene.solids[i]) : LightStack::root;
    }
}

template void find_light_roots<float>(const SceneView<float>&, int32_t (&)[ShadowPlan::solids]);
template void find_light_roots<double>(const SceneView<double>&, int32_t (&)[ShadowPlan::solids]);

}  // namespace cistula
