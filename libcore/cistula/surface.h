// What is at a hit: computed from its ids, not from the ray's rounding where that can be helped.
#pragma once

#include "cistula/effects.h"
#include "cistula/ray.h"
#include "cistula/texture.h"

namespace cistula {

template <class Real>
struct Surface {
    Vec3<Real> point;
    Vec3<Real> normal;       // geometric, unit, toward the viewer
    Vec3<Real> viewer_side;  // where rays that stay on the viewer's side start
    Vec3<Real> color;        // the material's, times its texture
    uint32_t material;
};

/// No question where one kind alone is compiled in.
template <class E>
CISTULA_INLINE bool is_convex(const Solid& solid) {
    return E::solids && (!E::triangles || solid.kind == SolidKind::convex);
}
/// Whether a solid's material is `clear`, or transmits. Scenes of few solids have bits for that: no number has to be
/// waited for.
template <class Scene>
CISTULA_INLINE bool is_clear(const Scene& scene, uint32_t solid) {
    if constexpr (requires { scene.clear_solids; })
        return (scene.clear_solids >> solid & 1u) != 0;
    else
        return scene.materials[scene.solids[solid].material].clear != 0;
}
template <class Scene>
CISTULA_INLINE bool transmits(const Scene& scene, uint32_t solid) {
    if constexpr (requires { scene.transmitting_solids; })
        return (scene.transmitting_solids >> solid & 1u) != 0;
    else
        return scene.materials[scene.solids[solid].material].transmission > 0;
}

/// The point over a triangle's centroid toward which lines leave it.
template <class Real>
struct Apex {
    Vec3<Real> place;
    Real share;  // of the way there that a line starts at: about 8 u M

    CISTULA_INLINE static Apex of(const Vec3<Real>& centroid, const Vec3<Real>& normal, Real height, Real extent) {
        const Real step = Real(8) * RealTraits<Real>::unit * extent;
        return {along(centroid, height, normal), step < height * Real(0.125) ? step / height : Real(0.125)};
    }
    /// From a point on the triangle: the segment crosses no other triangle (NUMERICS, 2), so that the new origin is on
    /// the right side of all of them.
    CISTULA_INLINE Vec3<Real> from(const Vec3<Real>& point) const { return along(point, share, place - point); }
};

template <class Real>
CISTULA_INLINE Real largest_magnitude(const Vec3<Real>& a) {
    return greatest(magnitude(a.x), greatest(magnitude(a.y), magnitude(a.z)));
}

/// The same for a small one, the square of whose area underflows: it is scaled first. By value, as it is called.
template <class Real>
CISTULA_SELDOM Vec3<Real> small_triangle_normal(Vec3<Real> ab, Vec3<Real> ac) {
    const Real scale = Real(1) / greatest(largest_magnitude(ab), largest_magnitude(ac));
    const Vec3<Real> scaled = cross(ab * scale, ac * scale);
    return normalized(scaled / largest_magnitude(scaled));
}

/// The unit normal of a triangle from two of its edges; not finite for one without area.
template <class Real>
CISTULA_INLINE Vec3<Real> triangle_normal(const Vec3<Real>& ab, const Vec3<Real>& ac) {
    const Vec3<Real> n = cross(ab, ac);
    const Real square = dot(n, n);
    return square > Real(0x1p-80) ? n / square_root(square) : small_triangle_normal(ab, ac);
}

/// The corners of the triangle that was hit.
template <class Real, class Scene>
CISTULA_INLINE void triangle_corners(const Scene& scene, uint32_t slot, Vec3<Real> (&corner)[3]) {
    const Cluster<Real>& cluster = scene.clusters[slot / cluster_lanes];
    const uint32_t lane = slot % cluster_lanes;
    for (int c = 0; c < 3; ++c)
        corner[c] = {cluster.corner[c][0][lane], cluster.corner[c][1][lane], cluster.corner[c][2][lane]};
}

/// The apex on one side of a triangle, along `normal`; outside: on the side its corners turn counter-clockwise on.
template <class Real, class Scene>
CISTULA_INLINE Apex<Real> apex_of(const Scene& scene, uint32_t slot, const Vec3<Real> (&corner)[3],
                                  const Vec3<Real>& normal, bool outside) {
    const Vec3<Real> centroid = (corner[0] + corner[1] + corner[2]) * Real(1.0 / 3.0);
    return Apex<Real>::of(centroid, normal, scene.clusters[slot / cluster_lanes].height[outside][slot % cluster_lanes],
                          scene.extent);
}

/// What hits on a triangle would find out each time: scenes of a few have it ready.
template <class Real>
struct TriangleSides {
    Vec3<Real> normal;   // on the outside
    Apex<Real> apex[2];  // inside, outside

    template <class Scene>
    static TriangleSides of(const Scene& scene, uint32_t slot) {
        Vec3<Real> corner[3];
        triangle_corners(scene, slot, corner);
        const Vec3<Real> normal = triangle_normal(corner[1] - corner[0], corner[2] - corner[0]);
        return {normal, {apex_of(scene, slot, corner, -normal, false), apex_of(scene, slot, corner, normal, true)}};
    }
};

/// Where a line starts that leaves a point of a triangle along `normal`.
template <class Real, class Scene>
CISTULA_INLINE Vec3<Real> off_triangle(const Scene& scene, const Hit<Real>& hit, const Vec3<Real>& point,
                                       [[maybe_unused]] const Vec3<Real> (&corner)[3],
                                       [[maybe_unused]] const Vec3<Real>& normal, bool outside) {
    if constexpr (requires { scene.sides; })
        return scene.sides[hit.slot].apex[outside].from(point);
    else
        return apex_of(scene, hit.slot, corner, normal, outside).from(point);
}

/// Where rays that bend into the other side of a face start.
template <class E, class Real, class Scene>
CISTULA_INLINE Vec3<Real> far_side(const Scene& scene, const Hit<Real>& hit, const Vec3<Real>& point,
                                   const Vec3<Real>& normal) {
    if (is_convex<E>(scene.solids[key_solid(hit.key)])) return point;
    Vec3<Real> corner[3];
    triangle_corners(scene, hit.slot, corner);
    return off_triangle(scene, hit, point, corner, -normal, !hit.enters);
}

/// The unit normal on the viewer's side.
template <class E = Effects<all_effects>, class Real, class Scene>
CISTULA_INLINE Vec3<Real> normal_at(const Scene& scene, const Hit<Real>& hit) {
    const Solid& solid = scene.solids[key_solid(hit.key)];
    const uint32_t face = key_face(hit.key);
    if (is_convex<E>(solid)) {
        const Vec3<Real>& normal = scene.slabs[solid.first_slab + face / 2].normal;
        const bool outward = (face & 1u) != 0;  // the high side's outward normal is the slab's
        return outward == hit.enters ? normal : -normal;
    }
    Vec3<Real> normal;
    if constexpr (!E::triangles) {
    } else if constexpr (requires { scene.sides; }) {
        normal = scene.sides[hit.slot].normal;
    } else {
        Vec3<Real> corner[3];
        triangle_corners(scene, hit.slot, corner);
        normal = triangle_normal(corner[1] - corner[0], corner[2] - corner[0]);
    }
    return hit.enters ? normal : -normal;
}

/// Whether a crossing of a mesh lies where a line starts on a face of another solid, give or take rounding.
template <class Real, class Media, class Scene>
CISTULA_INLINE bool lies_at_start(const Scene& scene, const Ray<Real, Media>& ray, const Hit<Real>& hit) {
    if (ray.from_solid == no_solid || ray.from_solid == key_solid(hit.key)) return false;
    return hit.t * magnitude(dot(normal_at(scene, hit), ray.direction)) <= incidence<Real> * scene.extent;
}

template <class Real, class E, class Media, class Scene>
CISTULA_INLINE Surface<Real> surface_at(const Scene& scene, const Ray<Real, Media>& ray, const Hit<Real>& hit) {
    const Solid& solid = scene.solids[key_solid(hit.key)];
    Surface<Real> s;
    s.material = solid.material;
    const Material<Real>& material = scene.materials[s.material];
    s.color = material.color;
    s.normal = normal_at<E>(scene, hit);
    if (is_convex<E>(solid)) {
        const Vec3<Real> point = along(ray.origin, hit.t, ray.direction);
        s.point = Vec3<Real>(point.x, point.y, point.z);  // number by number: see WaitingBranch
        s.viewer_side = Vec3<Real>(point.x, point.y, point.z);
        return s;
    }
    if constexpr (E::triangles) {
        Vec3<Real> corner[3];
        triangle_corners(scene, hit.slot, corner);
        s.point = along(along(corner[0], hit.u, corner[1] - corner[0]), hit.v, corner[2] - corner[0]);
        s.viewer_side = off_triangle(scene, hit, s.point, corner, s.normal, hit.enters);
    }
    if constexpr (E::has(effect_texture)) {
        if (material.texture >= 0) {
            const uint32_t face = key_face(hit.key);
            const Vec2<Real>* uv = scene.uvs.data + solid.first_uv + 3 * (face - solid.first_triangle);
            const Vec2<Real> at = uv[0] * (Real(1) - hit.u - hit.v) + uv[1] * hit.u + uv[2] * hit.v;
            s.color *= texture_at(scene, scene.textures[uint32_t(material.texture)], at);
        }
    }
    return s;
}

}  // namespace cistula
