// The work of the ray benchmark for one ray, for host and device: primary rays, rays that bounce off their hits, and
// shadow rays from there.
#pragma once

#include "cistula/numerics/trigonometry.h"
#include "cistula/shading/lighting.h"
#include "cistula/transport/pixel.h"
#include "cistula/traversal/bvh.h"
#include "testing/draw/draw.h"

namespace cistula::bench {

inline constexpr int picture_width = 3840, picture_height = 2160;
inline constexpr uint32_t ray_count = uint32_t(picture_width) * uint32_t(picture_height);

/// Layout: a block of threads takes 2 x 2 tiles of 8 x 4 pixels and a warp one tile, since neighbors see the same
/// things.
inline constexpr int warp_rays = 32, block_rays = 128, tile_width = 8, tile_height = 4;
inline constexpr int blocks_across = picture_width / (2 * tile_width);
static_assert(picture_width % (2 * tile_width) == 0 && picture_height % (2 * tile_height) == 0);

/// The pixel of ray `index`.
CISTULA_HD inline void ray_pixel(uint32_t index, int& x, int& y) {
    const int block = int(index / block_rays), tile = int(index / warp_rays) % 4, lane = int(index % warp_rays);
    x = block % blocks_across * 2 * tile_width + tile % 2 * tile_width + lane % tile_width;
    y = block / blocks_across * 2 * tile_height + tile / 2 * tile_height + lane / tile_width;
}

/// A ray outside of all solids, as stored in memory.
template <class Real>
struct alignas(16) StoredRay {
    Vec3<Real> origin{Real(0)};
    Real distance = -1;  // length; below 0: there is no such ray
    Vec3<Real> direction{Real(0)};
    uint32_t from_face = no_face;  // face of solid 0; no_face: it starts on none
    static constexpr size_t used_bytes = 7 * sizeof(Real) + sizeof(uint32_t);  // without padding

    CISTULA_HD bool exists() const { return distance >= Real(0); }
    CISTULA_HD Ray<Real> ray() const {
        Ray<Real> r;
        r.origin = origin;
        r.direction = direction;
        if (from_face != no_face) r.from_solid = 0, r.from_face = from_face;
        return r;
    }
};

template <class Real>
struct StoredHit {
    uint64_t key = no_key;
    Real t = RealTraits<Real>::infinity, u = 0, v = 0;
    uint32_t slot = 0;
    static constexpr size_t used_bytes = sizeof(uint64_t) + 3 * sizeof(Real) + sizeof(uint32_t);

    /// Whether something was hit from outside; further rays start there.
    CISTULA_HD bool enters() const { return key != no_key && key_kind(key) == CrossingKind::enter; }
    CISTULA_HD Hit<Real> hit() const { return {t, key, u, v, slot, enters()}; }
};

inline constexpr uint8_t light_arrives = 1, light_is_stopped = 0, no_light_ray = 2;

/// The rays and their results, ray by ray, in memory of either side.
template <class Real>
struct RayArrays {
    StoredRay<Real>*primary = nullptr, *bounced = nullptr, *shadow = nullptr;
    StoredHit<Real>*primary_hits = nullptr, *bounced_hits = nullptr;
    uint8_t* light = nullptr;
};

/// The ray through the middle of a pixel.
template <class Real, class Scene>
CISTULA_HD inline StoredRay<Real> primary_ray_of(const Scene& scene, const FrameView& frame, uint32_t index) {
    int x, y;
    ray_pixel(index, x, y);
    Ray<Real> ray;
    Vec3<double> direction;
    double start;
    StoredRay<Real> stored;
    if (!primary_ray(scene, frame, x + 0.5, y + 0.5, ray, direction, start)) return stored;
    stored.origin = ray.origin;
    stored.distance = RealTraits<Real>::infinity;
    stored.direction = ray.direction;
    return stored;
}

/// A random direction around the unit normal with a density proportional to the cosine, determined by the index alone.
/// The tangent axes are those of Duff et al. 2017, JCGT 6(1).
template <class Real>
CISTULA_HD inline Vec3<Real> cosine_direction(const Vec3<Real>& normal, uint32_t index) {
    constexpr double full_turn = 6.28318530717958647692;
    parity::Draw draw(index, 1);
    const double square = draw.unit<double>();
    const double angle = draw.unit<double>() * full_turn;
    const Vec3<double> n(normal);
    const double sign = n.z < 0 ? -1.0 : 1.0, a = -1 / (sign + n.z), b = n.x * n.y * a;
    const Vec3<double> right(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), up(b, sign + n.y * n.y * a, -n.y);
    const double radius = square_root(square);
    const Vec3<double> flat = right * (radius * elementary::cos(angle)) + up * (radius * elementary::sin(angle));
    return Vec3<Real>(normalized(flat + n * square_root(1 - square)));
}

/// The rays from a hit point: one that bounces, and one to the scene's first light, whichever side that is on.
template <class Real, class Scene>
CISTULA_HD inline void further_rays_of(const Scene& scene, const StoredRay<Real>& primary, const StoredHit<Real>& found,
                                       uint32_t index, StoredRay<Real>& bounced, StoredRay<Real>& shadow) {
    bounced = shadow = StoredRay<Real>();
    if (!found.enters()) return;
    const Surface<Real> s = surface_at<Real, Effects<0>>(scene, primary.ray(), found.hit());
    bounced.origin = shadow.origin = s.viewer_side;
    bounced.from_face = shadow.from_face = key_face(found.key);
    bounced.distance = RealTraits<Real>::infinity;
    bounced.direction = cosine_direction(s.normal, index);
    const Vec3<Real> to_light = scene.lights[0].position - s.viewer_side;
    shadow.distance = length(to_light);
    shadow.direction = to_light * (Real(1) / shadow.distance);
}

template <class Real, class Scene>
CISTULA_HD inline StoredHit<Real> closest_hit_of(const Scene& scene, const StoredRay<Real>& stored) {
    StoredHit<Real> found;
    if (!stored.exists()) return found;
    const Hit<Real> hit = BvhIntersector<Real>{scene}.closest(stored.ray());
    found.key = hit.key;
    found.t = hit.t;
    found.u = hit.u;
    found.v = hit.v;
    found.slot = hit.slot;
    return found;
}

template <class Real, class Scene>
CISTULA_HD inline uint8_t light_of(const Scene& scene, const StoredRay<Real>& stored) {
    if (!stored.exists()) return no_light_ray;
    const ShadowRay<Real> shadow{stored.ray(), stored.distance, &scene.lights[0]};
    const Real share = BvhIntersector<Real>{scene}.template transmittance<Effects<effect_opaque_shadows>>(shadow);
    return share > Real(0) ? light_arrives : light_is_stopped;
}

}  // namespace cistula::bench
