#include "scene/compile/constant_scene.h"

#include "cistula/model/scene_access.h"
#include "scene/compile/shadow_plan.h"

namespace cistula {
namespace {

template <class Real>
IndexedSolid<Real> indexed(const SceneView<Real>& scene, uint32_t index) {
    return {BoundingSphere<Real>::of(scene.solids[index]), index, scene.solids[index]};
}

template <class Real>
SheetPlane<Real> boxed_plane(const SceneView<Real>& scene, uint32_t index) {
    SheetPlane<Real> plane = plane_of(scene, index);
    const Cluster<Real>& cluster = scene.clusters[index];
    for (int axis = 0; axis < 3; ++axis) {
        Real low = cluster.corner[0][axis][0], high = low;
        for (uint32_t lane = 0; lane < cluster.count; ++lane)
            for (int c = 0; c < 3; ++c) {
                low = min_or_second(low, cluster.corner[c][axis][lane]);
                high = max_or_second(high, cluster.corner[c][axis][lane]);
            }
        plane.center[axis] = (low + high) * Real(0.5);
        plane.half[axis] = (high - low) * Real(0.5) + Real(plane_padding);
    }
    return plane;
}

/// Tabulates the transmitted shares by number of crossings: one crossing of each material first, then two of each, ...
template <class Real>
void cache_transmittances(ConstantScene<Real>& to) {
    int found = 0;
    for (CachedTransmittance<Real>& known : to.cached_transmittances) known = {0, Real(1)};
    const auto is_known = [&](uint64_t loss) {
        bool is = loss == 0;
        for (int i = 0; i < found; ++i) is |= to.cached_transmittances[i].loss == loss;
        return is;
    };
    for (uint64_t crossings = 1; crossings <= 4; ++crossings)
        for (const Material<Real>& material : to.materials)
            for (int c = 0; c < 3; ++c) {
                const uint64_t once = material.filter_loss[c];
                if (found == 4 || once > largest_loss / 4 || is_known(crossings * once)) continue;
                to.cached_transmittances[found++] = {crossings * once, transmittance_of<Real>(crossings * once)};
            }
}

/// Fills `to`; false if the scene does not fit.
template <class Real>
bool assign(const SceneView<Real>& here, const SceneView<Real>& there, ConstantScene<Real>& to) {
    if (!here.shared_planes.empty()) return false;
    for (const Solid& solid : here.solids)
        if (solid.kind == SolidKind::mesh || solid.may_touch) return false;
    if (!to.solids.assign(here.solids) || !to.slabs.assign(here.slabs) ||
        !to.convex.assign(here.convex.size, [&](uint32_t i) { return indexed(here, here.convex[i]); }) ||
        !to.clusters.assign(here.clusters) || !to.materials.assign(here.materials) || !to.lights.assign(here.lights) ||
        !to.textures.assign(here.textures))
        return false;
    to.slab_groups = there.slab_groups;
    to.facets = there.facets;
    to.uvs = there.uvs;
    to.incidents = there.incidents;
    to.visible_lights = there.visible_lights;
    to.texels = there.texels;
    to.tree = there.tree;
    to.tree_items = there.tree_items;
    to.visible_light_tree = there.visible_light_tree;
    to.light_groups = there.light_groups;
    to.planes.assign(to.clusters.size, [&](uint32_t i) { return boxed_plane(here, i); });
    to.sides.assign(to.clusters.size * cluster_lanes, [&](uint32_t slot) {
        const bool is_used = slot % cluster_lanes < to.clusters[slot / cluster_lanes].count;
        return is_used ? TriangleSides<Real>::of(here, slot) : TriangleSides<Real>();
    });
    cache_transmittances(to);
    to.clear_solids = to.transmitting_solids = 0;
    for (uint32_t i = 0; i < to.solids.size; ++i) {
        to.clear_solids |= uint32_t(is_clear(here, i)) << i;
        to.transmitting_solids |= uint32_t(transmits(here, i)) << i;
    }
    to.plan.clear(to.convex.size, to.clusters.size);
    to.background = here.background;
    to.bound = here.bound;
    to.largest_bound = here.largest_bound;
    to.extent = here.extent;
    return true;
}

}  // namespace

template <class Real>
std::unique_ptr<ConstantScene<Real>> constant_scene(const SceneView<Real>& here, const SceneView<Real>& there) {
    auto scene = std::make_unique<ConstantScene<Real>>();
    if (!assign(here, there, *scene)) return nullptr;
    plan_shadows(here, scene->plan);
    return scene;
}

template <class Real>
bool fits_constant_scene(const SceneView<Real>& scene) {
    return assign(scene, scene, *std::make_unique<ConstantScene<Real>>());
}

template bool fits_constant_scene(const SceneView<float>&);
template bool fits_constant_scene(const SceneView<double>&);
template std::unique_ptr<ConstantScene<float>> constant_scene(const SceneView<float>&, const SceneView<float>&);
template std::unique_ptr<ConstantScene<double>> constant_scene(const SceneView<double>&, const SceneView<double>&);

}  // namespace cistula
