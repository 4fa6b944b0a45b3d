// A scene small enough to travel with a kernel's parameters: its arrays lie in constant memory, which all threads of a
// warp read at once. The same names as in SceneView, so that the same code reads either.
#pragma once

#include "cistula/surface.h"
#include "cistula/transmittance.h"
#include "cistula/triangle.h"

namespace cistula {

/// Bytes of a line of the cache of constants, which holds few of them.
inline constexpr int constant_line = 64;

/// Up to `capacity` elements in place.
template <class T, uint32_t capacity>
struct InlineSpan {
    alignas(constant_line) T data[capacity];
    uint32_t size;

    CISTULA_INLINE const T& operator[](uint32_t i) const { return data[i]; }
    CISTULA_INLINE const T* begin() const { return data; }
    CISTULA_INLINE const T* end() const { return data + size; }
    CISTULA_INLINE bool empty() const { return size == 0; }

    /// False if they do not fit. `from` must be readable here.
    bool assign(const Span<T>& from) {
        return assign(from.size, [&](uint32_t i) { return from[i]; });
    }
    template <class Get>
    bool assign(uint32_t count, const Get& get) {
        if (count > capacity) return false;
        size = count;
        for (uint32_t i = 0; i < size; ++i) data[i] = get(i);
        return true;
    }
};

/// What is known of shadow rays before they are shot (plan_shadows, scene/shadow_plan.h).
struct ShadowPlan {
    static constexpr uint32_t solids = 24, lights = 8, convex = 16, clusters = 4;
    static constexpr uint32_t first_cluster = convex;
    static_assert(solids <= 32 && first_cluster + clusters <= 32);

    uint32_t all_convex, all_clusters;  // bit p: convex[p]; bit first_cluster + p: clusters[p]
    uint32_t beyond[lights];            // bit i: the light is well outside of convex solid i
    uint32_t near[solids][lights];      // the primitives that may lie between that solid's surface and that light

    /// Nothing is known.
    void clear(uint32_t convex_count, uint32_t cluster_count) {
        all_convex = (1u << convex_count) - 1;
        all_clusters = ((1u << cluster_count) - 1) << first_cluster;
        for (uint32_t& of_light : beyond) of_light = 0;
        for (auto& of_solid : near)
            for (uint32_t& primitives : of_solid) primitives = ~0u;
    }
};

template <class Real>
struct SmallScene {
    using Scalar = Real;
    static constexpr uint32_t most_slabs = 96, most_materials = 16;

    InlineSpan<Solid, ShadowPlan::solids> solids;
    InlineSpan<Slab<Real>, most_slabs> slabs;
    InlineSpan<NumberedSolid<Real>, ShadowPlan::convex> convex;  // copies: a look at one needs no other first
    InlineSpan<SheetPlane<Real>, ShadowPlan::clusters> planes;   // of the clusters: such copies too
    InlineSpan<Cluster<Real>, ShadowPlan::clusters> clusters;
    InlineSpan<TriangleSides<Real>, ShadowPlan::clusters * cluster_lanes> sides;  // by slot
    InlineSpan<Material<Real>, most_materials> materials;
    InlineSpan<Light<Real>, ShadowPlan::lights> lights;
    KnownShare<Real> known_shares[4];  // of light that has crossed one face or more of the transparent materials
    ShadowPlan plan;
    uint32_t clear_solids, transmitting_solids;  // bit i: solid i is of a clear material, or of one that transmits
    InlineSpan<Texture, 8> textures;
    // Elsewhere, as in the view that it was made of:
    Span<SlabGroup<Real>> slab_groups;
    Span<Facet<Real>> facets;
    Span<Vec2<Real>> uvs;
    Span<Incident> incidents;
    Span<SeenLight<Real>> seen_lights;
    Span<Vec3<float>> texels;
    Span<TreeNode> tree;
    Span<uint32_t> tree_items;
    Span<LightNode> seen_tree;
    Vec3<Real> background;
    Vec3<Real> bound;
    Real largest_bound;
    Real extent;

    /// False if `here`, a view that can be read, is too large, or if a ray in it may be inside more than one solid or a
    /// mesh: OneMedium asks for that. `there`: the same scene where kernels read it.
    bool assign(const SceneView<Real>& here, const SceneView<Real>& there) {
        for (const Solid& solid : here.solids)
            if (solid.kind == SolidKind::mesh || solid.touched) return false;
        if (!solids.assign(here.solids) || !slabs.assign(here.slabs) ||
            !convex.assign(here.convex.size, [&](uint32_t i) { return numbered(here, here.convex[i]); }) ||
            !clusters.assign(here.clusters) || !materials.assign(here.materials) || !lights.assign(here.lights) ||
            !textures.assign(here.textures))
            return false;
        slab_groups = there.slab_groups;
        facets = there.facets;
        uvs = there.uvs;
        incidents = there.incidents;
        seen_lights = there.seen_lights;
        texels = there.texels;
        tree = there.tree;
        tree_items = there.tree_items;
        seen_tree = there.seen_tree;
        planes.assign(clusters.size, [&](uint32_t i) { return boxed_plane(here, i); });
        sides.assign(clusters.size * cluster_lanes, [&](uint32_t slot) {
            const bool is_used = slot % cluster_lanes < clusters[slot / cluster_lanes].count;
            return is_used ? TriangleSides<Real>::of(here, slot) : TriangleSides<Real>();
        });
        find_shares();
        clear_solids = transmitting_solids = 0;
        for (uint32_t i = 0; i < solids.size; ++i) {
            clear_solids |= uint32_t(is_clear(here, i)) << i;
            transmitting_solids |= uint32_t(transmits(here, i)) << i;
        }
        plan.clear(convex.size, clusters.size);
        background = here.background;
        bound = here.bound;
        largest_bound = here.largest_bound;
        extent = here.extent;
        return true;
    }

  private:
    static NumberedSolid<Real> numbered(const SceneView<Real>& scene, uint32_t index) {
        return {Ball<Real>::of(scene.solids[index]), index, scene.solids[index]};
    }

    static SheetPlane<Real> boxed_plane(const SceneView<Real>& scene, uint32_t index) {
        SheetPlane<Real> plane = plane_of<Real>(scene, index);
        const Cluster<Real>& cluster = scene.clusters[index];
        for (int axis = 0; axis < 3; ++axis) {
            Real low = cluster.corner[0][axis][0], high = low;
            for (uint32_t lane = 0; lane < cluster.count; ++lane)
                for (int c = 0; c < 3; ++c) {
                    low = least(low, cluster.corner[c][axis][lane]);
                    high = greatest(high, cluster.corner[c][axis][lane]);
                }
            plane.center[axis] = (low + high) * Real(0.5);
            plane.half[axis] = (high - low) * Real(0.5) + Real(plane_padding);
        }
        return plane;
    }

    /// One crossing of each material first, then two of each, ...
    void find_shares() {
        int found = 0;
        for (KnownShare<Real>& known : known_shares) known = {0, Real(1)};
        const auto is_known = [&](uint64_t loss) {
            bool is = loss == 0;
            for (int i = 0; i < found; ++i) is |= known_shares[i].loss == loss;
            return is;
        };
        for (uint64_t crossings = 1; crossings <= 4; ++crossings)
            for (const Material<Real>& material : materials)
                for (int c = 0; c < 3; ++c) {
                    const uint64_t once = material.filter_loss[c];
                    if (found == 4 || once > largest_loss / 4 || is_known(crossings * once)) continue;
                    known_shares[found++] = {crossings * once, share_of<Real>(crossings * once)};
                }
    }
};

}  // namespace cistula
