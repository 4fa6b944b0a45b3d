// The local light of a surface: ambient, and each light by itself, so that lights may come in any order.
#pragma once

#include "cistula/phong.h"
#include "cistula/pixel_sums.h"
#include "cistula/shadow.h"
#include "cistula/surface.h"

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

/// Adds `weight` times the local term (DESIGN, Light), seen along `ray`.
template <class Real, class E, class Intersector, class Media, class Scene, class Sums>
CISTULA_INLINE void add_local_light(const Scene& scene, const Intersector& intersector, const Ray<Real, Media>& ray,
                                    const Hit<Real>& hit, const Surface<Real>& s, const Share<Real, E>& weight,
                                    Sums& sums, PixelRays& rays) {
    const LocalMaterial<Real>& m = scene.materials[s.material];
    sums.add(weight * (s.color * m.ambient));
    if constexpr (E::has(effect_diffuse | effect_specular)) {
        for (uint32_t i = 0; i < scene.lights.size; ++i) {
            const Light<Real>& light = scene.lights[i];
            Vec3<Real> to_light = light.position - s.viewer_side;
            // A light in the plane of the face lights it at no angle; rounding must not decide on which side it is.
            if (!(dot(s.normal, to_light) > incidence<Real> * scene.extent)) continue;
            const Real distance = length(to_light);
            to_light *= reciprocal(distance);
            const Real n_l = dot(s.normal, to_light);
            if (!(n_l > Real(0))) continue;
            const Vec3<Real> lit = phong<Real, E>(m, s.color, light, s.normal, to_light, -ray.direction, n_l, distance);
            if (lit == Vec3<Real>(Real(0))) continue;
            Share<Real, E> arrives(Real(1));
            if constexpr (E::has(effect_opaque_shadows | effect_transparent_shadows)) {
                const ShadowRay<Real, Media> shadow{spawned(s.viewer_side, to_light, hit, ray.media), distance, &light};
                ++rays.shadow;
                arrives = intersector.template transmittance<E>(shadow);
            }
            sums.add(weight * (arrives * lit));
        }
    }
}

}  // namespace cistula
