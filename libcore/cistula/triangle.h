// Triangles, hit exactly once: shear to the ray (Woop, Benthin, Wald 2013, JCGT 2(1)), edge functions whose signs are
// exact, and zero edges owned by one of the two triangles beside them (the top-left rule of rasterizers).
#pragma once

#include "cistula/ray.h"
#include "cistula/scene_view.h"

namespace cistula {

/// A ray's shear. Axes are permuted so that the direction is longest along kz and winding is kept: det > 0 enters.
template <class Real>
struct TriangleRay {
    int kx, ky, kz;
    Real sx, sy, sz;
    Real ox, oy, oz;  // origin along kx, ky, kz

    CISTULA_INLINE static TriangleRay of(const Vec3<Real>& origin, const Vec3<Real>& direction) {
        const Real x = magnitude(direction.x), y = magnitude(direction.y), z = magnitude(direction.z);
        TriangleRay r;
        r.kz = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
        r.kx = r.kz == 2 ? 0 : r.kz + 1;
        r.ky = r.kx == 2 ? 0 : r.kx + 1;
        if (direction[r.kz] < Real(0)) {
            const int k = r.kx;
            r.kx = r.ky;
            r.ky = k;
        }
        r.sz = Real(1) / direction[r.kz];
        r.sx = direction[r.kx] / direction[r.kz];
        r.sy = direction[r.ky] / direction[r.kz];
        r.ox = origin[r.kx];
        r.oy = origin[r.ky];
        r.oz = origin[r.kz];
        return r;
    }
};

/// Coordinates whose products could lose digits to underflow, and with them their sign, count as 0, for all triangles
/// alike: below 2^-51 in float the last digit of a product is below 2^-149.
template <class Real>
inline constexpr Real least_sheared = sizeof(Real) == sizeof(float) ? Real(0x1p-51) : Real(0x1p-60);

template <class Real>
CISTULA_INLINE Real sheared(Real across, Real shear, Real depth) {
    const Real s = across - shear * depth;
    return magnitude(s) < least_sheared<Real> ? Real(0) : s;
}

/// An accepted crossing of one triangle.
template <class Real>
struct TriangleCrossing {
    Real t, u, v;
    bool enters;  // against the normal
};

/// Corners relative to the ray and sheared along it, and edge functions opposite to each.
template <class Real>
struct ShearedTriangle {
    Real x[3], y[3], z[3], edge[3];

    CISTULA_INLINE static ShearedTriangle of(const Cluster<Real>& cluster, int lane, const TriangleRay<Real>& ray) {
        ShearedTriangle s;
        for (int c = 0; c < 3; ++c) {
            s.z[c] = cluster.corner[c][ray.kz][lane] - ray.oz;
            s.x[c] = sheared(cluster.corner[c][ray.kx][lane] - ray.ox, ray.sx, s.z[c]);
            s.y[c] = sheared(cluster.corner[c][ray.ky][lane] - ray.oy, ray.sy, s.z[c]);
        }
        for (int c = 0; c < 3; ++c) {
            const int a = c == 2 ? 0 : c + 1, b = a == 2 ? 0 : a + 1;
            s.edge[c] = difference_of_products(s.x[b], s.y[a], s.y[b], s.x[a]);
        }
        return s;
    }

    CISTULA_INLINE bool within() const {
        return (edge[0] >= Real(0) && edge[1] >= Real(0) && edge[2] >= Real(0)) ||
               (edge[0] <= Real(0) && edge[1] <= Real(0) && edge[2] <= Real(0));
    }

    /// Whether every edge that the ray meets belongs to this triangle. `sign` is det's.
    CISTULA_INLINE bool owns_zero_edges(Real sign) const {
        for (int c = 0; c < 3; ++c) {
            if (edge[c] != Real(0)) continue;
            const int a = c == 2 ? 0 : c + 1, b = a == 2 ? 0 : a + 1;
            const Real dx = (x[b] - x[a]) * sign, dy = (y[b] - y[a]) * sign;
            if (!(dy > Real(0) || (dy == Real(0) && dx > Real(0)))) return false;
        }
        return true;
    }

};

/// What the eight-lane test leaves for the lanes that it names: edge functions and corners' distances along kz.
template <class Real>
struct alignas(32) CandidateLanes {
    Real edge[3][cluster_lanes], z[3][cluster_lanes];
};

/// The lanes that a ray may hit, as bits: the inclusive edge tests only, eight at once.
template <class Real>
CISTULA_INLINE uint32_t cluster_candidates(const Cluster<Real>& cluster, const TriangleRay<Real>& ray,
                                           CandidateLanes<Real>& lanes) {
    uint32_t mask = 0;
#if CISTULA_ON_DEVICE
    for (uint32_t lane = 0; lane < cluster.count; ++lane) {
        const ShearedTriangle<Real> s = ShearedTriangle<Real>::of(cluster, int(lane), ray);
        for (int c = 0; c < 3; ++c) lanes.edge[c][lane] = s.edge[c], lanes.z[c][lane] = s.z[c];
        mask |= uint32_t(s.within()) << lane;
    }
#else
    // Straight code over lanes, so that the compiler fills vectors with it: same operations, same bits.
    const Real *px[3], *py[3], *pz[3];
    for (int c = 0; c < 3; ++c) {
        px[c] = cluster.corner[c][ray.kx];
        py[c] = cluster.corner[c][ray.ky];
        pz[c] = cluster.corner[c][ray.kz];
    }
    alignas(32) int32_t within[cluster_lanes];
    const Real ox = ray.ox, oy = ray.oy, oz = ray.oz, sx = ray.sx, sy = ray.sy;
#pragma GCC ivdep
    for (int lane = 0; lane < cluster_lanes; ++lane) {
        const Real az = pz[0][lane] - oz, bz = pz[1][lane] - oz, cz = pz[2][lane] - oz;
        const Real ax = sheared(px[0][lane] - ox, sx, az), ay = sheared(py[0][lane] - oy, sy, az);
        const Real bx = sheared(px[1][lane] - ox, sx, bz), by = sheared(py[1][lane] - oy, sy, bz);
        const Real cx = sheared(px[2][lane] - ox, sx, cz), cy = sheared(py[2][lane] - oy, sy, cz);
        const Real u = difference_of_products(cx, by, cy, bx);
        const Real v = difference_of_products(ax, cy, ay, cx);
        const Real w = difference_of_products(bx, ay, by, ax);
        const int32_t up = int32_t(u >= Real(0)) & int32_t(v >= Real(0)) & int32_t(w >= Real(0));
        const int32_t down = int32_t(u <= Real(0)) & int32_t(v <= Real(0)) & int32_t(w <= Real(0));
        within[lane] = -(up | down);
        lanes.edge[0][lane] = u, lanes.edge[1][lane] = v, lanes.edge[2][lane] = w;
        lanes.z[0][lane] = az, lanes.z[1][lane] = bz, lanes.z[2][lane] = cz;
    }
    mask = sign_bits(within) & ((1u << cluster.count) - 1u);
#endif
    return mask;
}

/// The exact test of one candidate, given its edge functions and its corners' distances along kz; t is not yet compared
/// with anything.
template <class Real>
CISTULA_INLINE bool cross_triangle(const Cluster<Real>& cluster, uint32_t lane, const TriangleRay<Real>& ray,
                                   const Real (&edge)[3], const Real (&z)[3], TriangleCrossing<Real>& crossing) {
    const Real u = edge[0], v = edge[1], w = edge[2], det = u + v + w;
    if (u == Real(0) || v == Real(0) || w == Real(0)) {
        if (det == Real(0)) return false;
        const ShearedTriangle<Real> s = ShearedTriangle<Real>::of(cluster, int(lane), ray);
        if (!s.owns_zero_edges(det > Real(0) ? Real(1) : Real(-1))) return false;
    }
    const Real depth = u * (ray.sz * z[0]) + v * (ray.sz * z[1]) + w * (ray.sz * z[2]);
    crossing = {depth / det, v / det, w / det, det > Real(0)};
    return true;
}

template <class Real>
CISTULA_INLINE bool cross_triangle(const Cluster<Real>& cluster, const CandidateLanes<Real>& lanes, uint32_t lane,
                                   const TriangleRay<Real>& ray, TriangleCrossing<Real>& crossing) {
    const Real edge[3] = {lanes.edge[0][lane], lanes.edge[1][lane], lanes.edge[2][lane]};
    const Real z[3] = {lanes.z[0][lane], lanes.z[1][lane], lanes.z[2][lane]};
    return cross_triangle(cluster, lane, ray, edge, z, crossing);
}

/// Calls visit(lane, crossing) for every triangle of a cluster that the ray's line crosses, wherever.
template <class Real, class Visit>
CISTULA_INLINE void for_each_crossing(const Cluster<Real>& cluster, const TriangleRay<Real>& ray, const Visit& visit) {
#if CISTULA_ON_DEVICE
    // One after the other in registers: a buffer of lanes would be memory here.
    for (uint32_t lane = 0; lane < cluster.count; ++lane) {
        const ShearedTriangle<Real> s = ShearedTriangle<Real>::of(cluster, int(lane), ray);
        TriangleCrossing<Real> c;
        if (s.within() && cross_triangle(cluster, lane, ray, s.edge, s.z, c)) visit(lane, c);
    }
#else
    CandidateLanes<Real> lanes;
    for (uint32_t mask = cluster_candidates(cluster, ray, lanes); mask != 0; mask &= mask - 1) {
        const uint32_t lane = lowest_bit(mask);
        TriangleCrossing<Real> c;
        if (cross_triangle(cluster, lanes, lane, ray, c)) visit(lane, c);
    }
#endif
}

/// Whether a line starts on the flat sheet to which a cluster belongs.
template <class Real, class Media>
CISTULA_INLINE bool leaves_flat(const SceneView<Real>& scene, uint32_t cluster, const Ray<Real, Media>& ray) {
    return ray.from_solid != no_solid && scene.clusters[cluster].solid == ray.from_solid &&
           scene.solids[ray.from_solid].flat != 0;
}

/// The ray's next crossing of a cluster's triangles, if it is less than `best`.
template <class Real, class Media>
CISTULA_INLINE void closest_cluster(const SceneView<Real>& scene, uint32_t index, const Ray<Real, Media>& ray,
                                    const TriangleRay<Real>& triangle_ray, Hit<Real>& best) {
    if (leaves_flat(scene, index, ray)) return;
    const Cluster<Real>& cluster = scene.clusters[index];
    for_each_crossing(cluster, triangle_ray, [&](uint32_t lane, const TriangleCrossing<Real>& c) {
        const uint32_t triangle = cluster.triangle[lane];
        const bool own = ray.from_solid == cluster.solid;
        if (!(c.t >= Real(0)) || (own && ray.from_face == triangle)) return;
        CrossingKind kind = c.enters ? CrossingKind::enter : CrossingKind::leave;
        if (scene.solids[cluster.solid].kind == SolidKind::sheet)
            kind = CrossingKind::sheet;
        else if (own && ray.fresh() && c.enters == ray.media.contains(cluster.solid))
            return;  // a line that starts on this mesh first crosses it from the side on which it starts
        const uint64_t key = make_key(kind, cluster.solid, triangle);
        if (ray.after.before(c.t, key) && best.improves(c.t, key))
            best = {c.t, key, c.u, c.v, index * uint32_t(cluster_lanes) + lane, c.enters};
    });
}

}  // namespace cistula
