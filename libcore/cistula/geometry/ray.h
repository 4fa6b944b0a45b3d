// A ray and its state: the media around it, the face that it left, and the last crossing behind it.
#pragma once

#include "cistula/geometry/hit.h"
#include "cistula/model/scene_access.h"

namespace cistula {

inline constexpr uint32_t no_solid = 0xffffffu;
inline constexpr uint32_t no_plane = 0xffffffffu;

/// The interior list: the solids that contain a point, each with its signed count of entries minus exits. A straight
/// ray takes every crossing of a mesh in order of t, which rounding may reverse at a grazed edge, so a count of -1 is
/// legal.
struct InteriorList {
    static constexpr bool contacts = true;  // a point may be inside several solids
    static constexpr bool meshes = true;    // some may be meshes
    static constexpr int capacity =
        8;  // solids inside one another; going over it fails the render (flag_media_overflow)

    uint32_t entries[capacity];  // solid << 8 | (count + 128)
    uint32_t size = 0;

    CISTULA_INLINE static uint32_t solid_of(uint32_t entry) { return entry >> 8; }
    CISTULA_INLINE static int count_of(uint32_t entry) { return int(entry & 0xffu) - 128; }

    CISTULA_INLINE int count(uint32_t solid) const {
        for (uint32_t i = 0; i < size; ++i)
            if (solid_of(entries[i]) == solid) return count_of(entries[i]);
        return 0;
    }

    CISTULA_INLINE bool contains(uint32_t solid) const { return size != 0 && count(solid) > 0; }
    CISTULA_INLINE bool empty() const { return size == 0; }

    /// The only solid in the list, if the point is inside it; else no_solid.
    CISTULA_INLINE uint32_t only() const {
        return size == 1 && count_of(entries[0]) > 0 ? solid_of(entries[0]) : no_solid;
    }

    /// Calls visit(solid, count) for every entry.
    template <class Visit>
    CISTULA_INLINE void for_each(const Visit& visit) const {
        for (uint32_t i = 0; i < size; ++i) visit(solid_of(entries[i]), count_of(entries[i]));
    }

    /// Adds +-1 to the solid's count. False if the list is full, which leaves it unchanged.
    CISTULA_INLINE bool add(uint32_t solid, int change) {
        for (uint32_t i = 0; i < size; ++i) {
            if (solid_of(entries[i]) != solid) continue;
            const int count = count_of(entries[i]) + change;
            if (count < -128 || count > 127) return false;
            if (count == 0)
                entries[i] = entries[--size];
            else
                entries[i] = solid << 8 | uint32_t(count + 128);
            return true;
        }
        if (size == capacity) return false;
        entries[size++] = solid << 8 | uint32_t(change + 128);
        return true;
    }

    /// Records that a solid is entered or left, or neither. False if the list is full, which leaves it unchanged.
    CISTULA_INLINE bool cross(bool enters, bool leaves, uint32_t solid) {
        return !(enters || leaves) || add(solid, enters ? 1 : -1);
    }

    /// Removes the solids whose count is below 0: a ray that starts anew knows where it is.
    CISTULA_INLINE void drop_negative() {
        for (uint32_t i = size; i-- > 0;)
            if (count_of(entries[i]) < 0) entries[i] = entries[--size];
    }

    /// The transparent solid of highest priority that contains the point, or no_solid.
    template <class Scene>
    CISTULA_INLINE uint32_t medium(const Scene& scene) const {
        uint32_t best = no_solid;
        for (uint32_t i = 0; i < size; ++i) {
            const uint32_t solid = solid_of(entries[i]);
            if (count_of(entries[i]) > 0 && (best == no_solid || solid > best) && !is_opaque(scene, solid))
                best = solid;
        }
        return best;
    }
};

/// The interior list of scenes whose closed solids are all convex and do not touch, so that a ray is inside at most
/// one. Its state lets a ray enter only from outside and leave only from inside.
struct SingleInterior {
    static constexpr bool contacts = false;
    static constexpr bool meshes = false;

    uint32_t solid = no_solid;

    CISTULA_INLINE bool contains(uint32_t index) const { return solid == index; }
    CISTULA_INLINE bool empty() const { return solid == no_solid; }
    CISTULA_INLINE uint32_t only() const { return solid; }
    template <class Scene>
    CISTULA_INLINE uint32_t medium(const Scene& scene) const {
        return solid == no_solid || is_opaque(scene, solid) ? no_solid : solid;
    }

    /// Records that a solid is entered or left. False, without a change, where the solids touch after all.
    CISTULA_INLINE bool cross(bool enters, bool leaves, uint32_t index) {
        const bool fits = solid == (enters ? no_solid : index);
        if (enters & fits) solid = index;
        if (leaves & fits) solid = no_solid;
        return fits | !(enters | leaves);
    }

    template <class Visit>
    CISTULA_INLINE void for_each(const Visit& visit) const {
        if (solid != no_solid) visit(solid, 1);
    }
};

/// Converts an InteriorList to the form of `to`.
CISTULA_INLINE void assign(InteriorList& to, const InteriorList& from) {
    to = from;
}
CISTULA_INLINE void assign(SingleInterior& to, const InteriorList& from) {
    to.solid = from.only();
}

/// A ray. Where it passes a face without bending it keeps its origin and direction, and `after` moves on.
template <class Real, class Media = InteriorList>
struct Ray {
    Vec3<Real> origin;
    Vec3<Real> direction;                 // unit to within a few u
    IndexOf<Real> from_solid = no_solid;  // the solid on whose face the ray starts, if any
    IndexOf<Real> from_face = 0;          // that face: 2 slab + side, or the scene-wide triangle number
    IndexOf<Real> from_plane = no_plane;  // the shared plane on which that face lies, if any
    Crossing<Real> after;                 // the last crossing that the ray has passed
    Media media;                          // the interior list at `after`

    CISTULA_INLINE bool fresh() const { return after.t < Real(0); }
    /// Takes another ray where `active` holds; in lanes.
    CISTULA_INLINE void take_where(const MaskOf<Real>& active, const Ray& other) {
        assign_where(active, origin, other.origin);
        assign_where(active, direction, other.direction);
        assign_where(active, from_solid, other.from_solid);
        assign_where(active, from_face, other.from_face);
        assign_where(active, after.t, other.after.t);
        assign_where(active, after.key, other.after.key);
        media.take_where(active, other.media);
    }
    /// Whether the ray's first crossing of a mesh must come from the side on which the ray starts.
    CISTULA_INLINE bool by_side() const { return after.t <= Real(-1); }
    /// Makes the ray meet all crossings, from whichever side; used to count them.
    CISTULA_INLINE void accept_both_sides() { after.t = Real(-0.5); }
};

/// Whether a ray is finite; one that is not meets nothing.
template <class Real>
CISTULA_INLINE MaskOf<Real> is_finite(const Vec3<Real>& origin, const Vec3<Real>& direction) {
    return nothing_of(origin) + nothing_of(direction) == Real(0);
}
template <class Real, class Media>
CISTULA_INLINE MaskOf<Real> is_finite(const Ray<Real, Media>& ray) {
    return is_finite(ray.origin, ray.direction);
}

}  // namespace cistula
