// Local light of a surface: ambient light, and each point light added by itself, so that lights may come in any order.
#pragma once

#include "cistula/model/layers.h"
#include "cistula/shading/contact.h"
#include "cistula/shading/phong.h"
#include "cistula/shading/shadow.h"
#include "cistula/shading/surface.h"

namespace cistula {

/// Sets up a ray that starts on the face of `hit`. `ray` must be as constructed.
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

/// The unit direction from a surface to a light, its distance, and the cosine to the normal.
template <class Real>
struct LightAim {
    Vec3<Real> direction;
    Real distance;
    Real cosine;

    CISTULA_INLINE static LightAim of(const Light<ScalarOf<Real>>& light, const Vec3<Real>& from,
                                      const Vec3<Real>& normal) {
        LightAim aim;
        aim.direction = spread<Real>(light.position) - from;
        aim.distance = length(aim.direction);
        aim.direction *= reciprocal(aim.distance);
        aim.cosine = dot(normal, aim.direction);
        return aim;
    }
};

/// Whether a light lies in front of a face. A light within the incidence distance of the face's plane does not light
/// it, so that rounding does not decide its side.
template <class Real, class Scene>
CISTULA_INLINE MaskOf<Real> is_before(const Scene& scene, const Light<ScalarOf<Real>>& light, const Vec3<Real>& from,
                                      const Vec3<Real>& normal) {
    return dot(normal, spread<Real>(light.position) - from) > incidence<ScalarOf<Real>> * scene.extent;
}

/// Whether a light adds nothing, even where it is not shadowed.
template <class Real>
CISTULA_INLINE MaskOf<Real> is_nothing(const Vec3<Real>& lit) {
    return (lit.x == Real(0)) & (lit.y == Real(0)) & (lit.z == Real(0));
}

/// What is told of each light i at a surface: that it is behind the surface or in its plane, or what it would add
/// without shadows, and the transmittance toward it.
template <class O, class Real, class E, class Media>
concept ObservesLights = requires(const O& observer, uint32_t i, const Light<ScalarOf<Real>>& light,
                                  const LightAim<Real>& aim, const Vec3<Real>& lit,
                                  const ShadowRay<Real, Media>& shadow, const Throughput<Real, E>& arrives) {
    observer.behind(i, light);
    observer.unshadowed(i, aim, lit);
    observer.arrives(i, shadow, arrives);
};

/// Ignores what it is told.
struct LightObserver {
    template <class Light>
    CISTULA_INLINE void behind(uint32_t, const Light&) const {}
    template <class Aim, class Color>
    CISTULA_INLINE void unshadowed(uint32_t, const Aim&, const Color&) const {}
    template <class Shadow, class Arrives>
    CISTULA_INLINE void arrives(uint32_t, const Shadow&, const Arrives&) const {}
};

/// A surface to which light is added: of one ray a copy, which compilers keep in registers; lanes stay in memory.
template <class Real>
CISTULA_INLINE Surface<Real> as_lit(const Surface<Real>& surface) {
    return surface;
}
template <class Real>
requires in_lanes<Real> CISTULA_INLINE const Surface<Real>& as_lit(const Surface<Real>& surface) {
    return surface;
}

/// Adds `weight` times the local light of a surface seen along `ray` (docs/design.md, Light), where `active` holds.
template <class Real, class E, class Intersector, class Media, class Scene, class Sums, class Rays,
          ObservesLights<Real, E, Media> Observer = LightObserver>
CISTULA_INLINE void add_local_light(const Scene& scene, const Intersector& intersector, const Ray<Real, Media>& ray,
                                    const SurfaceEvent<Real, Media>& event, const Surface<Real>& surface,
                                    const Throughput<Real, E>& weight, Sums& sums, Rays& rays,
                                    const Observer& observer = {}, const MaskOf<Real>& active = true) {
    decltype(auto) s = as_lit(surface);
    const Media* around = &ray.media;
    if constexpr (in_lanes<Real>) around = &surface.viewer_media;
    [[maybe_unused]] Media corrected;
    [[maybe_unused]] bool meshes = false;
    if constexpr (meets_contacts<E, Media> && !in_lanes<Real>)  // surfaces in lanes are corrected
        if (starts_at_contact<E>(scene, event)) {
            corrected = ray.media;
            meshes = start_at_contact(scene, ray, event, s.normal, false, s.viewer_side, corrected);
            around = &corrected;
        }
    [[maybe_unused]] BallStart from_ball;
    if constexpr (meets_balls<E, Scene> && !in_lanes<Real>)
        from_ball = ball_start(scene, ray, event.hit, s.viewer_side);
    const Vec3<Real>* from = &s.viewer_side;
    [[maybe_unused]] SmoothStart<Real> off_face;
    if constexpr (meets_smooth<E, Media>)
        if (any(s.smooth)) {
            off_face = SmoothStart<Real>::of(scene, intersector, event.hit, s, *from, *around, active);
            from = &off_face.place;
        }
    const auto& m = material_of(scene, s);
    sums.add(weight * (s.color * m.ambient), LightSource::ambient, active);
    if constexpr (E::has(effect_diffuse | effect_specular)) {
        for (uint32_t i = 0; i < scene.lights.size; ++i) {
            const Light<ScalarOf<Real>>& light = scene.lights[i];
            MaskOf<Real> lights = active & is_before(scene, light, *from, s.shading);
            if (!any(lights)) {
                observer.behind(i, light);
                continue;
            }
            const LightAim<Real> aim = LightAim<Real>::of(light, *from, s.shading);
            lights = lights & (aim.cosine > Real(0));
            [[maybe_unused]] MaskOf<Real> through_face = false;  // the way to the light may cross the own face
            if constexpr (meets_smooth<E, Media>) {
                through_face = s.smooth & !(dot(s.normal, aim.direction) > Real(0));
                lights = lights & (off_face.lifted | !through_face);
            }
            if (!any(lights)) {
                observer.behind(i, light);
                continue;
            }
            const Vec3<Real> lit =
                phong<Real, E>(m, s.color, light, s.shading, aim.direction, -ray.direction, aim.cosine, aim.distance);
            observer.unshadowed(i, aim, lit);
            lights = lights & !is_nothing(lit);
            if (!any(lights)) continue;
            Throughput<Real, E> arrives(Real(1));
            ShadowRay<Real, Media> shadow{spawned(*from, aim.direction, event.hit, *around), aim.distance, &light};
            if constexpr (meets_smooth<E, Media>)
                assign_where(through_face, shadow.ray.from_solid, IndexOf<Real>(int(no_solid)));
            find_start_plane<E>(scene, shadow.ray);
            if constexpr (meets_disks<E, Media>)
                if (const MaskOf<Real> moved = start_near<E>(scene, shadow.ray) > Real(0); any(moved))
                    assign_where(moved, shadow.distance,
                                 dot(spread<Real>(light.position) - shadow.ray.origin, shadow.ray.direction));
            if constexpr (meets_contacts<E, Media> && !in_lanes<Real>)
                if (meshes) count_meshes(scene, intersector, shadow.ray);
            if constexpr (meets_balls<E, Scene> && !in_lanes<Real>) from_ball.begin(scene, intersector, shadow.ray);
            rays.add_shadow(lights);
            if constexpr (in_lanes<Real>)
                arrives = intersector.template transmittance<E>(shadow, lights);
            else
                arrives = intersector.template transmittance<E>(shadow);
            if constexpr (meets_unseen_faces<E, Media>)
                if (scene.unseen_faces) gain_unseen_faces<E>(scene, intersector, shadow, lights, arrives);
            observer.arrives(i, shadow, arrives);
            const auto diffuse = [&] {
                return weight * (arrives * phong<Real, Effects<E::mask & ~effect_specular>>(
                                               m, s.color, light, aim.cosine, Real(0), aim.distance));
            };
            sums.add_light(weight * (arrives * lit), i, diffuse, lights);
        }
    }
}

}  // namespace cistula
