// The local light of a surface: ambient, and each light by itself, so that lights may come in any order.
#pragma once

#include "cistula/model/pixel_record.h"
#include "cistula/shading/phong.h"
#include "cistula/shading/shadow.h"
#include "cistula/shading/surface.h"

namespace cistula {

/// Starts a new line from a face. `ray`: as constructed.
template <class Real, class Media>
CISTULA_INLINE void spawn(Ray<Real, Media>& ray, const Vec3<Real>& origin, const Vec3<Real>& direction,
                          const Hit<Real>& hit, const Media& media) {
    ray.origin = origin;
    ray.direction = direction;
    ray.from_solid = key_solid(hit.key);
    ray.from_face = key_face(hit.key);
    ray.media = media;
}
template <class Real, class Media>
CISTULA_INLINE Ray<Real, Media> spawned(const Vec3<Real>& origin, const Vec3<Real>& direction, const Hit<Real>& hit,
                                        const Media& media) {
    Ray<Real, Media> ray;
    spawn(ray, origin, direction, hit, media);
    return ray;
}

/// The direction from a surface to a light (unit), how far that is, and the cosine to the normal.
template <class Real>
struct LightAim {
    Vec3<Real> direction;
    Real distance;
    Real cosine;

    CISTULA_INLINE static LightAim of(const Light<Real>& light, const Surface<Real>& s) {
        LightAim aim;
        aim.direction = light.position - s.viewer_side;
        aim.distance = length(aim.direction);
        aim.direction *= reciprocal(aim.distance);
        aim.cosine = dot(s.normal, aim.direction);
        return aim;
    }
};

/// Whether a light lies before a face. One in the face's plane lights it at no angle; rounding must not decide on which
/// side it is.
template <class Real, class Scene>
CISTULA_INLINE bool is_before(const Scene& scene, const Light<Real>& light, const Surface<Real>& s) {
    return dot(s.normal, light.position - s.viewer_side) > incidence<Real> * scene.extent;
}

/// Whoever wants to know what each light adds to a surface: add_local_light tells it. This one does not.
struct LightObserver {
    /// Light i is behind the surface, or at no angle to it.
    template <class Light>
    CISTULA_INLINE void behind(uint32_t, const Light&) const {}
    /// What light i would add without shadows.
    template <class Aim, class Color>
    CISTULA_INLINE void unshadowed(uint32_t, const Aim&, const Color&) const {}
    /// The share of light i that arrives.
    template <class Shadow, class Arrives>
    CISTULA_INLINE void arrives(uint32_t, const Shadow&, const Arrives&) const {}
};

/// Adds `weight` times the local term of a surface (docs/design.md, Light), seen along `ray`.
template <class Real, class E, class Intersector, class Media, class Scene, class Sums, class Observer = LightObserver>
CISTULA_INLINE void add_local_light(const Scene& scene, const Intersector& intersector, const Ray<Real, Media>& ray,
                                    const Hit<Real>& hit, const Surface<Real>& s, const Share<Real, E>& weight,
                                    Sums& sums, PixelRays& rays, const Observer& observer = {}) {
    const LocalMaterial<Real>& m = scene.materials[s.material];
    sums.add(weight * (s.color * m.ambient));
    if constexpr (E::has(effect_diffuse | effect_specular)) {
        for (uint32_t i = 0; i < scene.lights.size; ++i) {
            const Light<Real>& light = scene.lights[i];
            if (!is_before(scene, light, s)) {
                observer.behind(i, light);
                continue;
            }
            const LightAim<Real> aim = LightAim<Real>::of(light, s);
            if (!(aim.cosine > Real(0))) {
                observer.behind(i, light);
                continue;
            }
            const Vec3<Real> lit =
                phong<Real, E>(m, s.color, light, s.normal, aim.direction, -ray.direction, aim.cosine, aim.distance);
            observer.unshadowed(i, aim, lit);
            if (lit == Vec3<Real>(Real(0))) continue;
            Share<Real, E> arrives(Real(1));
            if constexpr (E::has(effect_opaque_shadows | effect_transparent_shadows)) {
                const ShadowRay<Real, Media> shadow{spawned(s.viewer_side, aim.direction, hit, ray.media), aim.distance,
                                                    &light};
                ++rays.shadow;
                arrives = intersector.template transmittance<E>(shadow);
                observer.arrives(i, shadow, arrives);
            }
            sums.add(weight * (arrives * lit));
        }
    }
}

}  // namespace cistula
