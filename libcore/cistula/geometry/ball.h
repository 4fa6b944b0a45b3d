// Balls, solid spheres (docs/rules.md, 14): where a line meets one follows from its closest approach to the center,
// whether it enters or leaves from the list of the solids around it. There are no epsilons, and no line is refused for
// what touches the ball.
#pragma once

#include "cistula/geometry/ray.h"
#include "cistula/model/effects.h"

namespace cistula {

/// Whether rays of a kernel may meet balls.
template <class E, class Scene>
inline constexpr bool meets_balls = E::has(effect_spheres) && holds_balls<Scene>;

/// The part of a line inside a ball.
template <class Real>
struct BallChord {
    Real middle;            // t of the point nearest to the center
    Real square;            // of half the length; below 0 for a line that misses
    MaskOf<Real> is_ahead;  // whether the line is inside anywhere, and the center ahead

    /// Half the length; 0 for a line that misses.
    CISTULA_INLINE Real half() const { return square_root(max_or_second(square, Real(0))); }

    CISTULA_INLINE static BallChord of(const Ball<ScalarOf<Real>>& ball, const Vec3<Real>& origin,
                                       const Vec3<Real>& direction) {
        return of(spread<Real>(ball.center), Real(ball.radius * ball.radius), origin, direction);
    }
    CISTULA_INLINE static BallChord of(const Vec3<Real>& center, const Real& radius_square, const Vec3<Real>& origin,
                                       const Vec3<Real>& direction) {
        const Vec3<Real> to_center = center - origin;
        const Real middle = dot(to_center, direction);
        const Vec3<Real> across = along(to_center, -middle, direction);
        const Real square = radius_square - dot(across, across);
        const MaskOf<Real> is_ahead = (middle > Real(0)) & (square > Real(0));
        return {middle, square, is_ahead};
    }
};

/// Whether a ray starts on a ball, or on one of its family.
template <class Real, class Media, class Scene>
CISTULA_INLINE MaskOf<Real> starts_on_ball(const Scene& scene, uint32_t index, const Ball<ScalarOf<Real>>& ball,
                                           const Ray<Real, Media>& ray) {
    MaskOf<Real> on = ray.from_solid == index;
    if (ball.has_kin != 0)
        for (const uint32_t other : scene.convex)
            if (is_ball(scene.solids[other]) && scene.balls[scene.solids[other].first_slab].family == ball.family)
                on = on | (ray.from_solid == other);
    return on;
}
template <class Real, class Media>
CISTULA_INLINE bool starts_on_ball(const BallScene<Real>&, uint32_t index, const Ball<Real>&,
                                   const Ray<Real, Media>& ray) {
    return ray.from_solid == index;
}

/// Takes the next crossing of a ball as `best` if it is less, for rays inside it and for others outside.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_ball(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray,
                                 const MaskOf<Real>& inside, const MaskOf<Real>& outside, Hit<Real>& best) {
    const Ball<ScalarOf<Real>>& ball = scene.balls[scene.solids[index].first_slab];
    const BallChord<Real> chord = BallChord<Real>::of(ball, ray.origin, ray.direction);
    if (!any(inside | (outside & chord.is_ahead))) return;
    const Real half = chord.half();
    const Real far = chord.middle + half;
    const MaskOf<Real> enters = outside & chord.is_ahead & (far > ray.after.t);
    const MaskOf<Real> on = starts_on_ball(scene, index, ball, ray);
    const Real leave = select(on, Real(2) * chord.middle, far);  // 2 b needs no root
    const Real least = max_or_second(ray.after.t, Real(0));
    const Real t = max_or_second(select(inside, leave, chord.middle - half), least);
    const MaskOf<Real> meets = (inside | (enters & !on)) & (t <= best.t) & (t < RealTraits<Real>::infinity);
    if (!any(meets)) return;
    const KeyOf<Real> key = select(inside, KeyFormat<Real>::make(CrossingKind::leave, index, 0),
                                   KeyFormat<Real>::make(CrossingKind::enter, index, 0));
    best.take(meets & best.improves(t, key), t, key, Real(0), Real(0), 0, !inside);
}

/// A ball's outward unit normal where a ray crosses it at t, from which the point follows: both agree with t.
template <class Real, class Media>
CISTULA_INLINE Vec3<Real> ball_normal(const Vec3<Real>& center, const Ray<Real, Media>& ray, const Real& t) {
    return normalized(along(ray.origin - center, t, ray.direction));
}

/// What a ray that starts on a ball knows of the planes of flat sheets there: on which side of them it is, where
/// rounding might say otherwise. Up to three of them, in ten bits of Ray::from_face each: 2 (1 + plane) + (1: the side
/// to which the normal points).
struct BallSides {
    static constexpr int field_bits = 10;
    static constexpr int fields = 3;
    static constexpr uint32_t most_planes = (1u << (field_bits - 1)) - 1;

    uint32_t bits = 0;

    /// 1 above a plane, -1 below, 0 if unknown.
    CISTULA_INLINE int of(uint32_t plane) const {
        for (uint32_t left = bits; left != 0; left >>= field_bits)
            if ((left >> 1 & most_planes) == plane + 1) return (left & 1u) != 0 ? 1 : -1;
        return 0;
    }
    CISTULA_INLINE void add(uint32_t plane, bool above) {
        if ((bits >> (fields - 1) * field_bits) == 0) bits = bits << field_bits | 2 * (plane + 1) | uint32_t(above);
    }
    /// Those of a ray.
    template <class Real, class Media, class Scene>
    CISTULA_INLINE static BallSides at_start(const Scene& scene, const Ray<Real, Media>& ray) {
        const bool known = ray.from_face != 0 && ray.from_solid != no_solid && is_ball(scene.solids[ray.from_solid]);
        return {known ? ray.from_face : 0};
    }
};

}  // namespace cistula
