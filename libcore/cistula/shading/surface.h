// The surface at a hit, computed from the hit's ids rather than from the ray where that is more accurate.
#pragma once

#include "cistula/geometry/disk.h"
#include "cistula/model/scene_access.h"
#include "cistula/model/texture.h"
#include "cistula/numerics/trigonometry.h"
#include "cistula/shading/smooth.h"

namespace cistula {

/// The outward normal of a triangle, given its own: that of its shared plane, if it has one.
template <class Real>
CISTULA_INLINE Vec3<Real> shared_normal(const SceneView<Real>& scene, uint32_t triangle, const Vec3<Real>& own) {
    if (scene.triangle_planes.empty() || scene.triangle_planes[triangle] == no_plane) return own;
    const Vec3<Real> normal = scene.shared_planes[scene.triangle_planes[triangle]].normal;
    return dot(normal, own) > Real(0) ? normal : -normal;
}
template <class Real>
CISTULA_INLINE const Vec3<Real>& shared_normal(const ConstantScene<Real>&, uint32_t, const Vec3<Real>& own) {
    return own;
}

template <class Real>
struct Surface {
    Vec3<Real> point;
    Vec3<Real> normal;       // geometric, unit, toward the viewer
    Vec3<Real> viewer_side;  // origin of rays that stay on the viewer's side
    Vec3<Real> color;        // material color times texture
    uint32_t material;
    Vec3<Real> shading;   // the normal that light goes by: the geometric one, but on smooth meshes
    bool smooth = false;  // whether it is another
    Vec3<Real> mirrored;  // then: the direction of the mirrored ray
};

/// The direction of a surface's mirrored ray.
template <class E, class Media, class Real>
CISTULA_INLINE Vec3<Real> mirrored_way(const Surface<Real>& s, const Vec3<Real>& direction) {
    if constexpr (meets_smooth<E, Media>)
        if (any(s.smooth)) return select(s.smooth, s.mirrored, reflected(direction, s.normal));
    return reflected(direction, s.normal);
}

template <class Real, class Scene>
CISTULA_INLINE const Material<Real>& material_of(const Scene& scene, const Surface<Real>& s) {
    return scene.materials[s.material];
}

/// Whether a solid is convex; a constant where only one kind of primitive is compiled in.
template <class E>
CISTULA_INLINE bool is_convex(const Solid& solid) {
    return E::solids && (!E::triangles || solid.kind == SolidKind::convex);
}
/// The origin of rays that are refracted into the other side of a face.
template <class E, class Real, class Scene>
CISTULA_INLINE Vec3<Real> far_side(const Scene& scene, const Hit<Real>& hit, const Vec3<Real>& point,
                                   const Vec3<Real>& normal) {
    if (is_convex<E>(scene.solids[key_solid(hit.key)])) return point;
    Vec3<Real> corner[3];
    triangle_corners(scene, hit.slot, corner);
    return apex_at(scene, hit.slot, corner, -normal, !hit.enters).from(point);
}

/// The unit normal on the viewer's side.
template <class E = Effects<all_effects>, class Real, class Media, class Scene>
CISTULA_INLINE Vec3<Real> normal_at(const Scene& scene, [[maybe_unused]] const Ray<Real, Media>& ray,
                                    const Hit<Real>& hit) {
    const Solid& solid = scene.solids[key_solid(hit.key)];
    const uint32_t face = key_face(hit.key);
    if constexpr (meets_balls<E, Scene>)
        if (is_ball(solid)) {
            const Vec3<Real> normal = ball_normal(scene.balls[solid.first_slab].center, ray, hit.t);
            return hit.enters ? normal : -normal;
        }
    if (is_convex<E>(solid)) {
        const Vec3<Real>& normal = scene.slabs[solid.first_slab + face / 2].normal;
        const bool outward = (face & 1u) != 0;  // the high side's outward normal is the slab's
        return outward == hit.enters ? normal : -normal;
    }
    if constexpr (meets_disks<E, Media>)
        if (is_disk(solid)) {
            const Vec3<Real>& normal = scene.shared_planes[scene.disks[solid.first_slab].plane].normal;
            return hit.enters ? normal : -normal;
        }
    if constexpr (E::triangles) {
        Vec3<Real> normal = outward_normal(scene, hit.slot);
        if constexpr (E::has(effect_contacts)) normal = shared_normal(scene, face, normal);
        return hit.enters ? normal : -normal;
    } else {
        return Vec3<Real>();
    }
}

/// The origin of rays that leave a flat sheet near balls where a ray meets it at t: straight off that place, which the
/// order of crossings speaks of. (A step toward an apex goes up to 2^9 u M sideways, into a ball or out of it, and for
/// a grazing ray a place from the triangle's corners lies far from t.)
template <class Real, class Media>
CISTULA_INLINE Vec3<Real> off_sheet(ScalarOf<Real> extent, const Ray<Real, Media>& ray, const Real& t,
                                    const Vec3<Real>& normal) {
    return along(along(ray.origin, t, ray.direction), Real(8 * RealTraits<ScalarOf<Real>>::unit * extent), normal);
}

/// The texture coordinates of a ball by its outward normal: longitude from -x over -y, x and y, and the angle to the
/// pole, each from 0 to 1.
template <class Real>
CISTULA_NOINLINE Vec2<Real> ball_uv(const Ball<Real>& ball, Vec3<Real> normal) {
    constexpr double pi = 0x1.921fb54442d18p+1;
    const Vec3<double> n(normal);
    const double x = dot(ball.axes[0], n);
    const double y = dot(ball.axes[1], n);
    const double z = dot(ball.axes[2], n);
    return {Real(elementary::atan2(y, x) / (2 * pi) + 0.5),
            Real(elementary::atan2(square_root(x * x + y * y), z) / pi)};
}

/// The texture coordinates of a hit on a ball, a disk, or a triangle that has them. `normal`: of the surface, toward
/// the viewer; used for a ball.
template <class Real, class Scene>
CISTULA_INLINE Vec2<Real> texture_uv(const Scene& scene, const Hit<Real>& hit,
                                     [[maybe_unused]] const Vec3<Real>& normal) {
    const Solid& solid = scene.solids[key_solid(hit.key)];
    if constexpr (holds_balls<Scene>)
        if (is_ball(solid)) return ball_uv(scene.balls[solid.first_slab], hit.enters ? normal : -normal);
    if (is_disk(solid)) return {hit.u, hit.v};
    const Vec2<Real>* uv = scene.uvs.data + solid.first_uv + 3 * (key_face(hit.key) - solid.first_triangle);
    return uv[0] * (Real(1) - hit.u - hit.v) + uv[1] * hit.u + uv[2] * hit.v;
}

template <class Real, class E, class Media, class Scene>
CISTULA_INLINE Surface<Real> surface_at(const Scene& scene, const Ray<Real, Media>& ray, const Hit<Real>& hit) {
    const Solid& solid = scene.solids[key_solid(hit.key)];
    Surface<Real> s;
    s.material = solid.material;
    const Material<Real>& material = scene.materials[s.material];
    s.color = material.color;
    s.normal = s.shading = normal_at<E>(scene, ray, hit);
    if constexpr (meets_balls<E, Scene>)
        if (is_ball(solid)) {
            const Ball<Real>& ball = scene.balls[solid.first_slab];
            s.point = s.viewer_side = along(ball.center, ball.radius, hit.enters ? s.normal : -s.normal);
            if constexpr (E::has(effect_texture))
                if (material.texture >= 0)
                    s.color *=
                        texture_at(scene, scene.textures[uint32_t(material.texture)], texture_uv(scene, hit, s.normal));
            return s;
        }
    if (is_convex<E>(solid)) {
        const Vec3<Real> point = along(ray.origin, hit.t, ray.direction);
        s.point = Vec3<Real>(point.x, point.y, point.z);  // number by number, as in WaitingBranch
        s.viewer_side = Vec3<Real>(point.x, point.y, point.z);
        return s;
    }
    if constexpr (E::triangles) {
        bool disk = false;
        if constexpr (meets_disks<E, Media>) disk = is_disk(solid);
        if (disk) {
            s.point = s.viewer_side = along(ray.origin, hit.t, ray.direction);  // rays start as rules 11 say
        } else {
            Vec3<Real> corner[3];
            triangle_corners(scene, hit.slot, corner);
            s.point = along(along(corner[0], hit.u, corner[1] - corner[0]), hit.v, corner[2] - corner[0]);
            bool near_ball = false;
            if constexpr (meets_balls<E, Scene>) near_ball = is_sheet_near_ball(solid);
            s.viewer_side = near_ball ? off_sheet(scene.extent, ray, hit.t, s.normal)
                                      : apex_at(scene, hit.slot, corner, s.normal, hit.enters).from(s.point);
            if constexpr (meets_smooth<E, Media>)
                if (const Vec3<Real>* normals = corner_normals(scene, hit.slot)) {
                    s.smooth = true;
                    s.shading = normalized(normal_between(normals, hit));
                    bend_normal(ray.direction, s.normal, s.shading, s.mirrored);
                }
        }
    }
    if constexpr (E::has(effect_texture)) {
        if (material.texture >= 0) {
            s.color *= texture_at(scene, scene.textures[uint32_t(material.texture)], texture_uv(scene, hit, s.normal));
        }
    }
    return s;
}

}  // namespace cistula
