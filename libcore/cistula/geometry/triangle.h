// Watertight ray-triangle intersection in which every point belongs to exactly one triangle: shear to ray space (Woop,
// Benthin, Wald 2013, JCGT 2(1)), edge functions with exact signs, and the top-left rule of rasterizers for edges that
// are hit exactly.
#pragma once

#include "cistula/geometry/ball.h"
#include "cistula/geometry/shared_plane.h"

namespace cistula {

/// a[k] by selects: an index would force `a` into memory on the device.
template <class Real>
CISTULA_INLINE Real component(const Vec3<Real>& a, const IndexOf<Real>& k) {
    return select(k == 0, a.x, select(k == 1, a.y, a.z));
}

/// A ray's shear. Axes are permuted so that kz is the axis of the largest direction component and winding is preserved:
/// det > 0 means that the ray enters.
template <class Real>
struct TriangleRay {
    using Axis = IndexOf<Real>;
    Axis kx, ky, kz;
    Real sx, sy, sz;
    Real ox, oy, oz;  // origin along kx, ky, kz

    CISTULA_INLINE static TriangleRay of(const Vec3<Real>& origin, const Vec3<Real>& direction) {
        const Real x = magnitude(direction.x);
        const Real y = magnitude(direction.y);
        const Real z = magnitude(direction.z);
        TriangleRay r;
        r.kz = select(x >= y, select(x >= z, Axis(0), Axis(2)), select(y >= z, Axis(1), Axis(2)));
        r.kx = select(r.kz == 2, Axis(0), r.kz + 1);
        r.ky = select(r.kx == 2, Axis(0), r.kx + 1);
        const Real along_z = component(direction, r.kz);
        const MaskOf<Real> backward = along_z < Real(0);
        const Axis k = r.kx;
        assign_where(backward, r.kx, r.ky);
        assign_where(backward, r.ky, k);
        r.sz = Real(1) / along_z;  // not reciprocal(): the parity check also tests arguments outside its range
        r.sx = component(direction, r.kx) * r.sz;
        r.sy = component(direction, r.ky) * r.sz;
        r.ox = component(origin, r.kx);
        r.oy = component(origin, r.ky);
        r.oz = component(origin, r.kz);
        return r;
    }
};

/// Sheared coordinates below this count as 0, since their products could underflow and lose their sign. (In float, the
/// last digit of a product of numbers below 2^-51 is below 2^-149.)
template <class Real>
inline constexpr Real least_sheared = sizeof(Real) == sizeof(float) ? Real(0x1p-51) : Real(0x1p-60);

template <class Real>
CISTULA_INLINE Real sheared(Real across, Real shear, Real depth) {
    const Real s = across - shear * depth;
    return select(magnitude(s) < least_sheared<ScalarOf<Real>>, Real(0), s);
}

/// An accepted crossing of a triangle. The barycentric weights are the edge functions divided by their sum, det.
template <class Real>
struct TriangleCrossing {
    Real t, edge_u, edge_v, det;

    CISTULA_INLINE MaskOf<Real> enters() const { return det > Real(0); }  // against the normal
    CISTULA_INLINE Real u() const { return edge_u / det; }
    CISTULA_INLINE Real v() const { return edge_v / det; }
};

/// A triangle in ray space: corners relative to the origin and sheared along the ray, and the edge function opposite to
/// each corner.
template <class Real>
struct ShearedTriangle {
    Real x[3], y[3], z[3], edge[3];

    CISTULA_INLINE static ShearedTriangle of(const Cluster<ScalarOf<Real>>& cluster, int lane,
                                             const TriangleRay<Real>& ray) {
        if constexpr (in_lanes<Real>) {
            return of([&](int c, int axis) { return cluster.corner[c][axis][lane]; }, ray);
        } else {
            ShearedTriangle s;
            for (int c = 0; c < 3; ++c)
                s.shear(c, cluster.corner[c][ray.kx][lane], cluster.corner[c][ray.ky][lane],
                        cluster.corner[c][ray.kz][lane], ray);
            s.find_edges();
            return s;
        }
    }
    CISTULA_INLINE static ShearedTriangle of(const Facet<ScalarOf<Real>>& facet, const TriangleRay<Real>& ray) {
        return of([&](int c, int axis) { return facet.corner[c][axis]; }, ray);
    }
    /// corner(c, axis) gives the coordinates.
    template <class Corner>
    CISTULA_INLINE static ShearedTriangle of(const Corner& corner, const TriangleRay<Real>& ray) {
        ShearedTriangle s;
        for (int c = 0; c < 3; ++c) {
            const Vec3<Real> p(corner(c, 0), corner(c, 1), corner(c, 2));
            s.shear(c, component(p, ray.kx), component(p, ray.ky), component(p, ray.kz), ray);
        }
        s.find_edges();
        return s;
    }

    CISTULA_INLINE void shear(int c, Real along_x, Real along_y, Real along_z, const TriangleRay<Real>& ray) {
        z[c] = along_z - ray.oz;
        x[c] = sheared(along_x - ray.ox, ray.sx, z[c]);
        y[c] = sheared(along_y - ray.oy, ray.sy, z[c]);
    }
    CISTULA_INLINE void find_edges() {
        for (int c = 0; c < 3; ++c) {
            const int a = c == 2 ? 0 : c + 1;
            const int b = a == 2 ? 0 : a + 1;
            edge[c] = difference_of_products(x[b], y[a], y[b], x[a]);
        }
    }

    CISTULA_INLINE MaskOf<Real> within() const {
        return ((edge[0] >= Real(0)) & (edge[1] >= Real(0)) & (edge[2] >= Real(0))) |
               ((edge[0] <= Real(0)) & (edge[1] <= Real(0)) & (edge[2] <= Real(0)));
    }

    /// Whether every edge that the ray hits exactly belongs to this triangle (top-left rule). `sign` is the sign of
    /// det.
    CISTULA_INLINE MaskOf<Real> owns_zero_edges(Real sign) const {
        MaskOf<Real> owns = true;
        for (int c = 0; c < 3; ++c) {
            const int a = c == 2 ? 0 : c + 1;
            const int b = a == 2 ? 0 : a + 1;
            const Real dx = (x[b] - x[a]) * sign;
            const Real dy = (y[b] - y[a]) * sign;
            owns &= (edge[c] != Real(0)) | (dy > Real(0)) | ((dy == Real(0)) & (dx > Real(0)));
        }
        return owns;
    }
};

/// Results of the eight-lane edge test, for the lanes that pass: edge functions and the corners' distances along kz.
template <class Real>
struct alignas(32) CandidateLanes {
    Real edge[3][cluster_lanes], z[3][cluster_lanes];
};

/// The lanes that a ray may hit, as a bit mask: only the inclusive edge tests, eight at once.
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
    // A loop over lanes that the compiler vectorizes: the operations, and so the bits, are those of ShearedTriangle.
    const Real *px[3], *py[3], *pz[3];
    for (int c = 0; c < 3; ++c) {
        px[c] = cluster.corner[c][ray.kx];
        py[c] = cluster.corner[c][ray.ky];
        pz[c] = cluster.corner[c][ray.kz];
    }
    alignas(32) int32_t within[cluster_lanes];
    const Real ox = ray.ox;
    const Real oy = ray.oy;
    const Real oz = ray.oz;
    const Real sx = ray.sx;
    const Real sy = ray.sy;
    CISTULA_LANES
    for (int lane = 0; lane < cluster_lanes; ++lane) {
        const Real az = pz[0][lane] - oz;
        const Real bz = pz[1][lane] - oz;
        const Real cz = pz[2][lane] - oz;
        const Real ax = sheared(px[0][lane] - ox, sx, az);
        const Real ay = sheared(py[0][lane] - oy, sy, az);
        const Real bx = sheared(px[1][lane] - ox, sx, bz);
        const Real by = sheared(py[1][lane] - oy, sy, bz);
        const Real cx = sheared(px[2][lane] - ox, sx, cz);
        const Real cy = sheared(py[2][lane] - oy, sy, cz);
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

/// The exact test of a candidate from its edge functions and its corners' distances along kz; t is not compared with
/// anything yet. shear() gives the ShearedTriangle, which is needed only if an edge function is zero.
template <class Real, class Shear>
CISTULA_INLINE MaskOf<Real> cross_triangle(const TriangleRay<Real>& ray, const Real (&edge)[3], const Real (&z)[3],
                                           const Shear& shear, TriangleCrossing<Real>& crossing) {
    const Real u = edge[0];
    const Real v = edge[1];
    const Real w = edge[2];
    const Real det = u + v + w;
    MaskOf<Real> owned = true;
    const MaskOf<Real> on_edge = (u == Real(0)) | (v == Real(0)) | (w == Real(0));
    if (any(on_edge)) {
        owned = (!on_edge) | ((det != Real(0)) & shear().owns_zero_edges(select(det > Real(0), Real(1), Real(-1))));
        if (!any(owned)) return owned;
    }
    const Real depth = u * (ray.sz * z[0]) + v * (ray.sz * z[1]) + w * (ray.sz * z[2]);
    crossing = {depth / det, v, w, det};
    return owned;
}

template <class Real>
CISTULA_INLINE bool cross_triangle(const Cluster<Real>& cluster, const CandidateLanes<Real>& lanes, uint32_t lane,
                                   const TriangleRay<Real>& ray, TriangleCrossing<Real>& crossing) {
    const Real edge[3] = {lanes.edge[0][lane], lanes.edge[1][lane], lanes.edge[2][lane]};
    const Real z[3] = {lanes.z[0][lane], lanes.z[1][lane], lanes.z[2][lane]};
    return cross_triangle(
        ray, edge, z, [&] { return ShearedTriangle<Real>::of(cluster, int(lane), ray); }, crossing);
}

template <class Real>
CISTULA_INLINE MaskOf<Real> cross_triangle(const ShearedTriangle<Real>& s, const TriangleRay<Real>& ray,
                                           TriangleCrossing<Real>& crossing) {
    const MaskOf<Real> within = s.within();
    if (!any(within)) return within;
    return within & cross_triangle(
                        ray, s.edge, s.z, [&]() -> const ShearedTriangle<Real>& { return s; }, crossing);
}

/// Calls visit(lane, crossing) for every triangle of a cluster that the ray's line crosses, at any t.
template <class Real, class Visit>
CISTULA_INLINE void for_each_crossing(const Cluster<Real>& cluster, const TriangleRay<Real>& ray, const Visit& visit) {
#if CISTULA_ON_DEVICE
    // One triangle after the other, in registers: a buffer of lanes would lie in memory here.
    for (uint32_t lane = 0; lane < cluster.count; ++lane) {
        TriangleCrossing<Real> c;
        if (cross_triangle(ShearedTriangle<Real>::of(cluster, int(lane), ray), ray, c)) visit(lane, c);
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

/// Whether a ray starts on the flat sheet to which a cluster belongs.
template <class Real, class Media, class Scene>
CISTULA_INLINE bool starts_on_flat_sheet(const Scene& scene, uint32_t cluster, const Ray<Real, Media>& ray) {
    const uint32_t solid = scene.clusters[cluster].solid;
    return solid == ray.from_solid && scene.solids[solid].flat != 0;
}

/// Whether a ray from a point well off a flat sheet's plane surely does not reach the plane before `limit`. A quick
/// rejection that never decides a hit. (A ray so flat that slant < plane_padding / 4 M stays clear of the whole sheet.)
/// `off`: signed distance of the origin from the plane; `slant`: direction . normal.
template <class Real>
CISTULA_INLINE MaskOf<Real> clears_plane(Real off, Real slant, Real limit) {
    const Real ahead = select(off < Real(0), -slant, slant);
    const Real far_off = magnitude(off);
    return (far_off > Real(plane_padding)) & (far_off + ahead * limit > Real(plane_padding));
}

/// Minimum slant for crosses_outside_sheet(): a flatter line may cross the plane far from its computed crossing.
template <class Real>
inline constexpr Real least_slant = Real(0x1p-6);

/// Whether a line surely crosses a flat sheet's plane outside the sheet's box. The crossing point is accurate to a few
/// u M over the slant, at most 2^-13 M; the box is padded by more.
template <class Real>
CISTULA_INLINE MaskOf<Real> crosses_outside_sheet(const SheetPlane<ScalarOf<Real>>& plane, const Vec3<Real>& origin,
                                                  const Vec3<Real>& direction, Real off, Real slant) {
    const Vec3<Real> at = along(origin, -off * reciprocal(slant), direction) - spread<Real>(plane.center);
    const MaskOf<Real> steep = magnitude(slant) > least_slant<ScalarOf<Real>>;
    const MaskOf<Real> beside_x = magnitude(at.x) > plane.half.x;
    const MaskOf<Real> beside_y = magnitude(at.y) > plane.half.y;
    const MaskOf<Real> beside_z = magnitude(at.z) > plane.half.z;
    return steep & (beside_x | beside_y | beside_z);
}

/// Whether a ray surely misses a flat sheet up to `limit`. `from`: the solid that it leaves.
template <class Real>
CISTULA_INLINE MaskOf<Real> misses_flat_sheet(const SheetPlane<ScalarOf<Real>>& plane, const IndexOf<Real>& from,
                                              const Vec3<Real>& origin, const Vec3<Real>& direction, Real limit) {
    const Vec3<Real> normal = spread<Real>(plane.normal);
    const Real off = dot(normal, origin) - plane.offset;
    const Real slant = dot(normal, direction);
    // Both tests without branches between them, so that their values are computed at once.
    const MaskOf<Real> flat = plane.flat != 0;
    const MaskOf<Real> misses = flat & ((from == plane.solid) | clears_plane(off, slant, limit));
    if (all(misses)) return misses;
    return misses | (flat & crosses_outside_sheet(plane, origin, direction, off, slant));
}

/// Whether a ray surely misses a cluster of a flat sheet; false where the cluster belongs to none.
template <class Real, class Media, class Scene>
CISTULA_INLINE MaskOf<Real> misses_flat_sheet(const Scene& scene, uint32_t cluster, const Ray<Real, Media>& ray,
                                              Real limit) {
    return misses_flat_sheet(plane_of(scene, cluster), ray.from_solid, ray.origin, ray.direction, limit);
}

/// The largest distance along a line between a triangle's own crossing and its shared plane's: half of what trees
/// search beyond a box (tree_slack_absolute). Only lines that are flatter over the plane than its distance from the
/// triangle over this, 2^-9 for 8 u M in float, exceed it; they meet the triangle at its own crossing.
template <class Real>
inline constexpr Real contact_reach = Real(0x1p-12);

/// The t of an accepted crossing of a triangle by its shared plane, if it has one; -1 if the ray starts on that plane,
/// whose surfaces it does not meet. `own`: the triangle's.
template <class Real, class Media, class Scene>
CISTULA_INLINE Real shared_time(const Scene& scene, uint32_t triangle, Real own, const Ray<Real, Media>& ray) {
    if constexpr (Media::contacts)
        if (!scene.triangle_planes.empty())
            if (const uint32_t plane = scene.triangle_planes[triangle]; plane != no_plane) {
                const MaskOf<Real> starts_there = ray.from_plane == plane;
                if (all(starts_there)) return Real(-1);
                const Real t = plane_time(scene.shared_planes[plane], ray.origin, ray.direction, own);
                const MaskOf<Real> near = magnitude(t - own) <= contact_reach<ScalarOf<Real>>;
                return select(starts_there, Real(-1), select(near, t, own));
            }
    return own;
}

/// The t of an accepted crossing of a flat sheet near balls, that of its plane, by which rays from balls know their
/// side of it. A ray that does so meets it if it heads across, not before its start; else t is -1. (In lanes no ray
/// does: those are traced by themselves.)
template <class Real, class Media, class Scene>
CISTULA_INLINE Real time_near_ball(const Scene& scene, const Solid& sheet, const Real& own,
                                   const Ray<Real, Media>& ray) {
    const auto& plane = scene.ball_planes[sheet.first_group - 1];
    Real t = own;
    if (plane.shared == no_plane) {  // else it has the time of that
        t = plane_time(plane, ray.origin, ray.direction, own);
        t = select(magnitude(t - own) <= contact_reach<ScalarOf<Real>>, t, own);
    }
    if constexpr (!in_lanes<Real>)
        if (const int side = BallSides::at_start(scene, ray).of(sheet.first_group - 1); side != 0)
            return (side > 0) == (dot(plane.normal, ray.direction) > Real(0)) ? Real(-1) : max_or_second(t, Real(0));
    return t;
}

/// The t of an accepted crossing of a solid's triangle, -1 if the ray does not meet it for where it starts. `own`: the
/// triangle's.
template <class Real, class Media, class Scene>
CISTULA_INLINE Real crossing_time(const Scene& scene, uint32_t solid, uint32_t triangle, Real own,
                                  const Ray<Real, Media>& ray) {
    const Real t = shared_time(scene, triangle, own, ray);
    if constexpr (holds_balls<Scene>)
        if (!scene.ball_planes.empty() && is_sheet_near_ball(scene.solids[solid]))
            return time_near_ball(scene, scene.solids[solid], t, ray);
    return t;
}

/// Takes accepted crossings, where `active` holds, as `best` if they are the rays' next.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_crossing(const Scene& scene, const MaskOf<Real>& active, uint32_t solid, uint32_t triangle,
                                     uint32_t slot, const TriangleCrossing<Real>& c, const Ray<Real, Media>& ray,
                                     Hit<Real>& best) {
    const MaskOf<Real> own = ray.from_solid == solid;
    const Real t = crossing_time(scene, solid, triangle, c.t, ray);
    const MaskOf<Real> meets = active & (t >= Real(0)) & !(own & (ray.from_face == triangle));
    if (!any(meets)) return;
    CrossingKind kind = CrossingKind::sheet;
    if constexpr (Media::meshes) {
        if (scene.solids[solid].kind != SolidKind::sheet) {
            kind = c.enters() ? CrossingKind::enter : CrossingKind::leave;
            if (ray.by_side() && c.enters() == ray.media.contains(solid)) {
                // A ray's first crossing of a mesh is from the side on which the ray starts.
                best.wrong_side_t = min_no_nan(t, best.wrong_side_t);
                return;
            }
        }
    }
    const KeyOf<Real> key = KeyFormat<Real>::make(kind, solid, triangle);
    const MaskOf<Real> first = meets & ray.after.before(t, key) & best.improves(t, key);
    if (any(first)) best.take(first, t, key, c.u(), c.v(), slot, c.enters());
}

/// The ray's next crossing of a cluster's triangles, if it is less than `best`, for a ray that does not start on the
/// cluster's flat sheet.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_triangles(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray,
                                      const TriangleRay<Real>& triangle_ray, Hit<Real>& best) {
    const Cluster<Real>& cluster = scene.clusters[index];
    for_each_crossing(cluster, triangle_ray, [&](uint32_t lane, const TriangleCrossing<Real>& c) {
        closest_crossing(scene, true, cluster.solid, cluster.triangle[lane], index * uint32_t(cluster_lanes) + lane, c,
                         ray, best);
    });
}

template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_cluster(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray,
                                    const TriangleRay<Real>& triangle_ray, Hit<Real>& best) {
    if (!starts_on_flat_sheet(scene, index, ray)) closest_triangles(scene, index, ray, triangle_ray, best);
}

/// Takes the crossing of one facet as `best` if it is the ray's next; `left` is the flat sheet on which the ray starts,
/// or no_solid.
template <class Real, class Media, class Scene>
CISTULA_INLINE void closest_facet(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray,
                                  const TriangleRay<Real>& triangle_ray, uint32_t left, Hit<Real>& best) {
    const Facet<Real>& facet = scene.facets[index];
    TriangleCrossing<Real> c;
    if (facet.solid != left && cross_triangle(ShearedTriangle<Real>::of(facet, triangle_ray), triangle_ray, c))
        closest_crossing(scene, true, facet.solid, facet.triangle, facet.slot, c, ray, best);
}

/// The flat sheet on which a ray starts, or no_solid.
template <class Real, class Media, class Scene>
CISTULA_INLINE uint32_t flat_start(const Scene& scene, const Ray<Real, Media>& ray) {
    return ray.from_solid != no_solid && scene.solids[ray.from_solid].flat != 0 ? ray.from_solid : no_solid;
}

}  // namespace cistula
