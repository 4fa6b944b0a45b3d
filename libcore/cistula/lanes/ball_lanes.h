// Lanes of rays against all balls of a small scene: one ball after the other against all rays from outside, each ray
// from inside against its own.
#pragma once

#include "cistula/geometry/ball.h"
#include "cistula/lanes/lane_hit.h"

namespace cistula {

/// Leaves the balls in `inside`, a bit each of their solids: all those of a ray in turn.
template <class T, int n>
CISTULA_NOINLINE void leave_balls(const BallColumns<T>& balls, const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray,
                                  const IndexOf<Lanes<T, n>>& inside, Hit<Lanes<T, n>>& best) {
    using Real = Lanes<T, n>;
    using Index = IndexOf<Real>;
    const Real least = max_or_second(ray.after.t, Real(0));
    LaneArray<Index> left(inside);
    for (MaskOf<Real> active = inside != 0; any(active); active = left.all() != 0) {
        LaneArray<Index> solids(Index(0));
        LaneVectors<Real> centers(ray.origin);
        LaneArray<Real> squares(Real(-1));
        for_each_lane(active, [&](int lane) {
            const uint32_t solid = lowest_bit(uint32_t(left.of[lane]));
            const uint32_t ball = balls.ball[solid];
            left.of[lane] &= left.of[lane] - 1;
            solids.of[lane] = int32_t(solid);
            centers.set(lane, {balls.center[0][ball], balls.center[1][ball], balls.center[2][ball]});
            squares.of[lane] = balls.square[ball];
        });
        const Index solid = solids.all();
        const auto chord = BallChord<Real>::of(centers.all(), squares.all(), ray.origin, ray.direction);
        const Real leave = select(ray.from_solid == solid, Real(2) * chord.middle, chord.middle + chord.half());
        const Real t = max_or_second(leave, least);
        const KeyOf<Real> key = KeyFormat<Real>::make(CrossingKind::leave, 0, 0) | solid << LaneKey::solid_bit;
        const MaskOf<Real> meets = active & (t < Real(RealTraits<Real>::infinity)) & best.improves(t, key);
        best.take(meets, t, key, Real(0), Real(0), 0, false);
    }
}

/// The next crossings of balls (closest_ball), for rays of `active`; those of `free` may enter more than they are in.
template <class T, int n>
CISTULA_INLINE void closest_balls(const BallColumns<T>& balls, const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray,
                                  const MaskOf<Lanes<T, n>>& active, const MaskOf<Lanes<T, n>>& free,
                                  Hit<Lanes<T, n>>& best) {
    using Real = Lanes<T, n>;
    using Index = IndexOf<Real>;
    const Index own =
        select(ray.from_solid < Index(int(LaneScene<T>::most_with_bits)), Index(1) << (ray.from_solid & 31), Index(0));
    const Index around = ray.media.bits | own;
    const Real least = max_or_second(ray.after.t, Real(0));
    Real nearest = RealTraits<Real>::infinity;
    Index solid = 0;
    for (uint32_t i = 0; i < balls.count; ++i) {
        const Vec3<Real> center(Real(balls.center[0][i]), Real(balls.center[1][i]), Real(balls.center[2][i]));
        const auto chord = BallChord<Real>::of(center, Real(balls.square[i]), ray.origin, ray.direction);
        const uint32_t index = balls.solid[i];
        const MaskOf<Real> ahead = free & chord.is_ahead & ((around & Index(int(1u << index))) == 0);
        if (!any(ahead)) continue;
        const Real half = chord.half();
        const Real t = max_or_second(chord.middle - half, least);
        const MaskOf<Real> enters = ahead & (chord.middle + half > ray.after.t) & (t < nearest);
        assign_where(enters, nearest, t);
        assign_where(enters, solid, Index(int(index)));
    }
    const KeyOf<Real> key = KeyFormat<Real>::make(CrossingKind::enter, 0, 0) | solid << LaneKey::solid_bit;
    const MaskOf<Real> meets = (nearest < Real(RealTraits<Real>::infinity)) & best.improves(nearest, key);
    best.take(meets, nearest, key, Real(0), Real(0), 0, true);
    const Index inside = select(active, ray.media.bits & Index(int(balls.solids)), Index(0));
    if (any(inside != 0)) leave_balls(balls, ray, inside, best);
}

/// The solids that are balls on the lines of some rays, or around them, a bit each; of many rays all of `balls`. Of
/// few, one ray after the other is tested against the balls in lanes.
template <class T, int n>
CISTULA_INLINE uint32_t balls_on_lines(const BallColumns<T>& balls, const Ray<Lanes<T, n>, LaneMedia<Lanes<T, n>>>& ray,
                                       const MaskOf<Lanes<T, n>>& active) {
    using Real = Lanes<T, n>;
    if (3 * uint32_t(__builtin_popcount(active.bits())) > uint32_t(n) || balls.count < 8) return balls.solids;
    uint32_t on_lines = 0;
    uint32_t solids = 0;
    for_each_lane(active, [&](int lane) {
        const Vec3<Real> origin = spread<Real>(lane_of(ray.origin, lane));
        const Vec3<Real> direction = spread<Real>(lane_of(ray.direction, lane));
        solids |= uint32_t(ray.media.bits[lane]);
        for (uint32_t first = 0; first < balls.count; first += n) {
            const Vec3<Real> center(Real::at(balls.center[0] + first), Real::at(balls.center[1] + first),
                                    Real::at(balls.center[2] + first));
            const auto chord = BallChord<Real>::of(center, Real::at(balls.square + first), origin, direction);
            on_lines |= (chord.square > Real(0)).bits() << first;
        }
    });
    for (; on_lines != 0; on_lines &= on_lines - 1) solids |= 1u << balls.solid[lowest_bit(on_lines)];
    return solids & balls.solids;
}

}  // namespace cistula
