// A scene small enough to be passed as a kernel parameter: its arrays lie in constant memory, which all threads of a
// warp read at once. Members have the names of SceneView's, so that the same code reads either.
#pragma once

#include "cistula/model/triangle_sides.h"
#include "cistula/numerics/transmittance.h"

namespace cistula {

/// Bytes of a line of the constant cache, which holds few lines.
inline constexpr int constant_line = 64;

/// A Span with inline storage for up to `capacity` elements.
template <class T, uint32_t capacity>
struct InlineSpan {
    alignas(constant_line) T data[capacity];
    uint32_t size;

    CISTULA_INLINE const T& operator[](uint32_t i) const { return data[i]; }
    CISTULA_INLINE const T* begin() const { return data; }
    CISTULA_INLINE const T* end() const { return data + size; }
    CISTULA_INLINE bool empty() const { return size == 0; }

    /// Copies the elements; false if they do not fit. `from` must be readable on this side (host or device).
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

/// Which primitives a shadow ray may meet, precomputed for each pair of solid and light (plan_shadows in
/// libcore/scene).
struct ShadowPlan {
    static constexpr uint32_t solids = 24;
    static constexpr uint32_t lights = 8;
    static constexpr uint32_t convex = 16;
    static constexpr uint32_t clusters = 4;
    static constexpr uint32_t first_cluster = convex;
    static_assert(solids <= 32 && first_cluster + clusters <= 32);

    uint32_t all_convex, all_clusters;  // bit p: convex[p]; bit first_cluster + p: clusters[p]
    uint32_t beyond[lights];            // bit i: the light is well outside of convex solid i
    uint32_t near[solids][lights];      // mask of primitives that may lie between that solid's surface and that light

    /// Sets the plan to exclude nothing.
    void clear(uint32_t convex_count, uint32_t cluster_count) {
        all_convex = (1u << convex_count) - 1;
        all_clusters = ((1u << cluster_count) - 1) << first_cluster;
        for (uint32_t& of_light : beyond) of_light = 0;
        for (auto& of_solid : near)
            for (uint32_t& primitives : of_solid) primitives = ~0u;
    }
};

template <class Real>
struct ConstantScene {
    using Scalar = Real;
    static constexpr uint32_t most_slabs = 96;
    static constexpr uint32_t most_materials = 16;

    InlineSpan<Solid, ShadowPlan::solids> solids;
    InlineSpan<Slab<Real>, most_slabs> slabs;
    InlineSpan<IndexedSolid<Real>, ShadowPlan::convex> convex;  // copies, to avoid an indirection
    InlineSpan<SheetPlane<Real>, ShadowPlan::clusters> planes;  // of the clusters, also copies
    InlineSpan<Cluster<Real>, ShadowPlan::clusters> clusters;
    InlineSpan<TriangleSides<Real>, ShadowPlan::clusters * cluster_lanes> sides;  // by slot
    InlineSpan<Material<Real>, most_materials> materials;
    InlineSpan<Light<Real>, ShadowPlan::lights> lights;
    CachedTransmittance<Real> cached_transmittances[4];  // precomputed for crossings of transparent faces
    ShadowPlan plan;
    uint32_t opaque_solids, clear_solids, transmitting_solids;  // bit i: solid i's material is opaque; is clear;
                                                                // transmits
    InlineSpan<Texture, 8> textures;
    // Arrays outside of this struct, as in the view that it was made from:
    Span<SlabGroup<Real>> slab_groups;
    Span<Facet<Real>> facets;
    Span<Vec2<Real>> uvs;
    Span<Incident> incidents;
    Span<VisibleLight<Real>> visible_lights;
    Span<Vec3<float>> texels;
    Span<TreeNode> tree;
    Span<uint32_t> tree_items;
    Span<LightNode> visible_light_tree;
    Span<uint32_t> light_groups;
    Span<SkyStop> sky_stops;
    Sky sky;
    Vec3<Real> background;
    Vec3<Real> bound;
    Real largest_bound;
    Real extent;
};

/// A small scene of balls that at most touch one another and sheets. What all threads of a warp read at once lies here,
/// in constant memory; what each reads for its own hit lies in device memory, as constant memory would serve one
/// address after the other.
template <class Real>
struct BallScene : SceneView<Real> {
    static constexpr uint32_t most_balls = 32;
    static constexpr uint32_t most_bodies = 8;
    static constexpr uint32_t most_clusters = 4;

    /// What the search for hits reads of a ball.
    struct alignas(16) Sphere {
        Vec3<Real> center;
        Real square;  // of the radius
    };

    InlineSpan<Sphere, most_balls> spheres;
    InlineSpan<uint32_t, most_balls> sphere_solids;      // their solids, in ascending order
    InlineSpan<uint32_t, most_bodies> bodies;            // the other convex solids
    InlineSpan<SheetPlane<Real>, most_clusters> planes;  // of the clusters
};

/// Whether a scene's form has room for balls.
template <class Scene>
inline constexpr bool holds_balls = requires(const Scene& scene) {
    scene.balls;
};

}  // namespace cistula
