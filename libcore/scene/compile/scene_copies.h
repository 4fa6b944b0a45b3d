// Parts of a scene that are copied or tabulated in advance, for the forms of it that are traced fastest.
#pragma once

#include "cistula/shading/surface.h"

namespace cistula {

/// A convex solid with its number and bounding sphere.
template <class Real>
IndexedSolid<Real> indexed_solid(const SceneView<Real>& scene, uint32_t index) {
    return {BoundingSphere<Real>::of(scene.solids[index]), index, scene.solids[index]};
}

/// The plane of the flat sheet to which a cluster belongs, with a box around the cluster.
template <class Real>
SheetPlane<Real> boxed_plane(const SceneView<Real>& scene, uint32_t index) {
    SheetPlane<Real> plane = plane_of(scene, index);
    const Cluster<Real>& cluster = scene.clusters[index];
    for (int axis = 0; axis < 3; ++axis) {
        Real low = cluster.corner[0][axis][0];
        Real high = low;
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
void cache_transmittances(const Span<Material<Real>>& materials, CachedTransmittance<Real> (&cache)[4]) {
    int found = 0;
    for (CachedTransmittance<Real>& known : cache) known = {0, Real(1)};
    const auto is_known = [&](uint64_t loss) {
        bool is = loss == 0;
        for (int i = 0; i < found; ++i) is |= cache[i].loss == loss;
        return is;
    };
    for (uint64_t crossings = 1; crossings <= 4; ++crossings)
        for (const Material<Real>& material : materials)
            for (int c = 0; c < 3; ++c) {
                const uint64_t once = material.filter_loss[c];
                if (found == 4 || once > largest_loss / 4 || is_known(crossings * once)) continue;
                cache[found++] = {crossings * once, transmittance_of<Real>(crossings * once)};
            }
}

/// The normal and apexes of the triangle in a slot, if there is one; empty for other slots.
template <class Real>
TriangleSides<Real> sides_of(const SceneView<Real>& scene, uint32_t slot) {
    const Cluster<Real>& cluster = scene.clusters[slot / cluster_lanes];
    const uint32_t lane = slot % cluster_lanes;
    if (lane >= cluster.count) return {};
    return TriangleSides<Real>::of(scene, slot,
                                   shared_normal(scene, cluster.triangle[lane], outward_normal(scene, slot)));
}

}  // namespace cistula
