// The form of a scene that rays in lanes trace.
#pragma once

#include <algorithm>

#include "cistula/geometry/ray.h"
#include "cistula/model/constant_scene.h"

namespace cistula {

/// The fields of a crossing's key in lanes, which has 31 bits: kind, solid, face.
struct LaneKey {
    static constexpr int solid_bit = 17;
    static constexpr int kind_bit = 29;
    static constexpr uint32_t solids = (1u << (kind_bit - solid_bit)) - 1;
    static constexpr uint32_t faces = (1u << solid_bit) - 1;
    static constexpr int32_t none = 0x7fffffff;
};

/// The convex solids with a face on a shared plane, a bit each: those that lie where its normal points, and the others.
struct PlaneBodies {
    uint32_t above = 0;
    uint32_t below = 0;

    CISTULA_INLINE uint32_t all() const { return above | below; }
};

/// What a solid is, in tables.
enum SolidForm : int { form_triangles, form_slabs, form_ball, form_disk };
CISTULA_INLINE int form_of(const Solid& solid) {
    if (solid.kind != SolidKind::convex) return is_disk(solid) ? form_disk : form_triangles;
    return is_ball(solid) ? form_ball : form_slabs;
}

/// What shading reads of a solid.
struct SolidShading {
    int32_t material, form, first_slab;
};

/// Balls in columns, so that they may be tested in lanes. Those from `count` on are missed by every line.
template <class Real>
struct BallColumns {
    static constexpr uint32_t most = 32;
    alignas(64) Real center[3][most] = {};
    alignas(64) Real square[most];  // of the radius; -1: no ball
    uint32_t count = 0;
    uint32_t solids = 0;       // a bit each
    uint8_t solid[most] = {};  // of each ball
    uint8_t ball[most] = {};   // of each solid that is one

    BallColumns() { std::fill(square, square + most, Real(-1)); }

    void add(const Ball<Real>& added, uint32_t of_solid) {
        for (int k = 0; k < 3; ++k) center[k][count] = added.center[k];
        square[count] = added.radius * added.radius;
        solid[count] = static_cast<uint8_t>(of_solid);
        ball[of_solid] = static_cast<uint8_t>(count++);
        solids |= 1u << of_solid;
    }
};

/// A table of 16 entries: a register holds those of float, two or four those of double.
template <class T>
struct alignas(64) LaneTable {
    T of[16] = {};
};

/// What shading reads of the first solids and of the first materials.
template <class Real>
struct ShadingTables {
    using Integer = std::conditional_t<sizeof(Real) == 4, int32_t, int64_t>;
    LaneTable<Real> color[3], ambient[3], specular[3], filter[3], tint[3];
    LaneTable<Real> diffuse, local, reflection, transmission;
    LaneTable<Integer> integer_exponent, fresnel, texture;
    LaneTable<Integer> material, form, first_slab;  // of solids
};

/// Some of the solids of a LaneScene: a bit each of the first 31, and 1 for each that is among them.
struct SolidSet {
    uint32_t bits = 0;
    bool any = false;
    Span<uint32_t> each;

    CISTULA_INLINE bool has(uint32_t solid) const { return each[solid] != 0; }
};

/// An index of refraction, and the closed solids that have it.
struct SolidsOfIndex {
    double index;
    SolidSet solids;
};

/// The closed solids of a LaneScene that contain a point: a bit each or, where the scene has too many for that
/// (`named`), up to three of them by number, 1 + solid in ten bits each, 0 for none.
struct InteriorSet {
    static constexpr uint32_t most_named = 3;
    static constexpr uint32_t number_bits = 10;
    static constexpr uint32_t number_mask = (1u << number_bits) - 1;

    uint32_t bits = 0;
    bool named = false;

    /// Calls visit(solid, 1) for every solid.
    template <class Visit>
    CISTULA_INLINE void for_each(const Visit& visit) const {
        if (named)
            for (uint32_t left = bits; left != 0; left >>= number_bits) {
                if ((left & number_mask) != 0) visit((left & number_mask) - 1, 1);
            }
        else
            for (uint32_t left = bits; left != 0; left &= left - 1) visit(lowest_bit(left), 1);
    }
    CISTULA_INLINE uint32_t count() const {
        uint32_t count = 0;
        for_each([&](uint32_t, int) { ++count; });
        return count;
    }
    /// The last of them, or no_solid.
    CISTULA_INLINE uint32_t last() const {
        uint32_t last = no_solid;
        for_each([&](uint32_t solid, int) { last = last == no_solid || solid > last ? solid : last; });
        return last;
    }
    CISTULA_INLINE uint32_t only() const { return count() == 1 ? last() : no_solid; }
    CISTULA_INLINE bool contains(uint32_t solid) const {
        bool contains = false;
        for_each([&](uint32_t own, int) { contains |= own == solid; });
        return contains;
    }
    /// Those for which keeps(solid) holds.
    template <class Keeps>
    CISTULA_INLINE InteriorSet among(const Keeps& keeps) const {
        InteriorSet kept{0, named};
        for_each([&](uint32_t solid, int) {
            if (keeps(solid)) kept.add(solid);
        });
        return kept;
    }
    /// The solids of an interior list; of one that does not fit, the first.
    CISTULA_INLINE static InteriorSet of(const InteriorList& list, bool named) {
        InteriorSet set{0, named};
        list.for_each([&](uint32_t solid, int) { set.add(solid); });
        return set;
    }
    /// Whether an interior list fits: all its counts are 1, and they are few enough.
    CISTULA_INLINE static bool holds(const InteriorList& list, bool named) {
        bool holds = !named || list.size <= most_named;
        list.for_each([&](uint32_t, int count) { holds &= count == 1; });
        return holds;
    }
    CISTULA_INLINE InteriorList list() const {
        InteriorList list;
        for_each([&](uint32_t solid, int count) { list.add(solid, count); });
        return list;
    }

  private:
    CISTULA_INLINE void add(uint32_t solid) {
        if (!named)
            bits |= 1u << solid;
        else if ((bits >> (most_named - 1) * number_bits) == 0)
            bits = bits << number_bits | (solid + 1);
    }
};

/// A scene with at most 1,022 closed solids, of which only opaque meshes have faces in others' planes. Its solids are
/// numbered anew, closed ones before sheets, so that a bit each says which of up to 31 a ray is inside; of more, their
/// numbers do (InteriorSet). The order within either kind is kept, and with it that of crossings at equal t.
template <class Real>
struct LaneScene : SceneView<Real> {
    static constexpr uint32_t most_with_bits = 31;
    static constexpr uint32_t most_closed = 1022;

    Span<IndexedSolid<Real>> convex_copies;  // of `convex`, to avoid an indirection
    Span<SheetPlane<Real>> planes;           // of the clusters
    Span<TriangleSides<Real>> sides;         // by slot
    CachedTransmittance<Real> cached_transmittances[4];
    uint32_t closed = 0;              // solids i < closed are closed, others sheets
    int least_lanes = 1;              // with fewer, one ray after the other is faster
    bool named = false;               // whether InteriorSets are numbers, not bits
    SolidSet meshes, isolated;        // closed meshes; convex solids near which nothing else is
    SolidSet transparent, absorbing;  // closed solids that light passes; in which it is absorbed
    SolidSet clear, transmitting;     // of all solids, those of a clear material; of one that transmits
    Span<SolidsOfIndex> indices;      // of closed solids, unless they are many
    SolidSet kin;                     // balls that coincide with others
    SolidSet from_balls;              // balls from which new rays may know more than lanes hold
    BallColumns<Real> columns;        // all balls, if they are tested before all else
    Span<uint32_t> numbers, places;   // the scene's own number of each solid, and the reverse
    Span<uint32_t> convex_places;     // of each convex solid, its place among them
    Span<SolidShading> shading;       // of each solid
    Span<PlaneBodies> plane_bodies;   // of each of shared_planes, if InteriorSets are bits
    bool has_opaque_fresnel = false;  // whether any opaque material is
    bool loops = false;               // whether a loop over the primitives is quicker than the tree
    ShadingTables<Real> tables;

    /// Whether lanes may give rays back, to be traced by themselves.
    CISTULA_INLINE bool may_stray() const { return meshes.any || named || from_balls.any || kin.any; }
};

}  // namespace cistula
