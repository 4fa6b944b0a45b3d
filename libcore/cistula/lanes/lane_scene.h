// The form of a scene that rays in lanes trace.
#pragma once

#include "cistula/model/constant_scene.h"

namespace cistula {

/// The fields of a crossing's key in lanes, which has 31 bits: kind, solid, face.
struct LaneKey {
    static constexpr int solid_bit = 17, kind_bit = 29;
    static constexpr uint32_t solids = (1u << (kind_bit - solid_bit)) - 1, faces = (1u << solid_bit) - 1;
    static constexpr int32_t none = 0x7fffffff;
};

/// The convex solids with a face on a shared plane, a bit each: those that lie where its normal points, and the others.
struct PlaneBodies {
    uint32_t above = 0, below = 0;

    CISTULA_INLINE uint32_t all() const { return above | below; }
};

/// A table with an entry for each of the first 16 solids: a register holds those of float, two or four those of double.
template <class T>
struct alignas(64) SolidTable {
    T of[16] = {};
};

/// What shading reads of the first solids and their materials.
template <class Real>
struct SolidTables {
    using Integer = std::conditional_t<sizeof(Real) == 4, int32_t, int64_t>;
    SolidTable<Real> color[3], ambient[3], specular[3], filter[3], tint[3];
    SolidTable<Real> diffuse, local, reflection, transmission;
    SolidTable<Integer> integer_exponent, fresnel, material, texture;
    SolidTable<Integer> first_slab, is_convex;
    SolidTable<Integer> near[ShadowPlan::lights];  // of a ShadowPlan
};

/// A scene with at most 31 closed solids, of which only opaque meshes have faces in others' planes. Its solids are
/// numbered anew, closed ones before sheets, so that a bit each says which of them a ray is inside. The order within
/// either kind is kept, and with it that of crossings at equal t.
template <class Real>
struct LaneScene : SceneView<Real> {
    static constexpr uint32_t most_closed = 31;

    Span<IndexedSolid<Real>> convex_copies;  // of `convex`, to avoid an indirection
    Span<SheetPlane<Real>> planes;           // of the clusters
    Span<TriangleSides<Real>> sides;         // by slot
    CachedTransmittance<Real> cached_transmittances[4];
    const ShadowPlan* plan = nullptr;           // of a scene that is small enough for one
    uint32_t closed = 0;                        // solids i < closed are closed, others sheets
    int least_lanes = 1;                        // with fewer, one ray after the other is faster
    uint32_t meshes = 0, isolated = 0;          // bit i: solid i is a closed mesh; convex, nothing else near it
    uint32_t transparent = 0, absorbing = 0;    // bit i: light passes closed solid i; loses by its absorption there
    Span<uint32_t> clear_solids, transmitting;  // of each solid, 1 if its material is clear; if it transmits
    uint32_t clear_bits = 0, transmitting_bits = 0;  // the same of the first 32, a bit each
    Span<uint32_t> numbers;                          // of the solids in the scene's own order
    Span<PlaneBodies> plane_bodies;                  // of each of shared_planes
    bool has_opaque_fresnel = false;                 // whether any opaque material is
    SolidTables<Real> tables;

    CISTULA_INLINE bool is_mesh(uint32_t solid) const { return solid < closed && (meshes >> solid & 1u) != 0; }
    /// The place of a convex solid among them: how many come before it.
    CISTULA_INLINE uint32_t convex_before(uint32_t solid) const {
        return solid - uint32_t(__builtin_popcount(meshes & ((1u << solid) - 1u)));
    }
};

}  // namespace cistula
