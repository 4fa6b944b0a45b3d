// Visible lights: spheres of constant radiance that end a ray and cast no shadow.
#pragma once

#include "cistula/lights/edge_lights.h"
#include "cistula/lights/light_tree.h"

namespace cistula {

inline constexpr uint32_t no_light = 0xffffffffu;

template <class Real>
struct VisibleLightHit {
    static constexpr uint32_t none = in_lanes<Real> ? no_light >> 1 : no_light;

    Real t = RealTraits<Real>::infinity;
    IndexOf<Real> light = none;

    CISTULA_INLINE MaskOf<Real> found() const { return light != none; }
};

/// Intersects the front of a sphere, using the ray's closest approach to its center (Haines et al., Ray Tracing Gems,
/// ch. 7). A ray that starts inside meets nothing.
template <class Real, class Media, class Scene>
CISTULA_INLINE void intersect_visible_light(const Scene& scene, uint32_t index, const Ray<Real, Media>& ray,
                                            VisibleLightHit<Real>& best) {
    const VisibleLight<ScalarOf<Real>>& light = scene.visible_lights[index];
    const Vec3<Real> to_center = spread<Real>(light.center) - ray.origin;
    const Real b = dot(to_center, ray.direction);
    const Vec3<Real> across = to_center - b * ray.direction;
    const Real square = light.radius * light.radius;
    const Real discriminant = square - dot(across, across);
    const Real c = dot(to_center, to_center) - square;
    const MaskOf<Real> meets = (discriminant > Real(0)) & (c > Real(0)) & (b > Real(0));
    if (!any(meets)) return;
    const Real t = c / (b + square_root(discriminant));
    const IndexOf<Real> own = index;
    const MaskOf<Real> first = meets & (t >= ray.after.t) & ((t < best.t) | ((t == best.t) & (own < best.light)));
    assign_where(first, best.t, t);
    assign_where(first, best.light, own);
}

/// The outward unit normal of a visible light where the ray meets it: from the center to the closest approach, and back
/// from there. Rounding makes the first a little oblique, and more so the farther and the smaller the sphere is, so the
/// sum is normalized.
template <class Real, class Media, class Scene>
CISTULA_INLINE Vec3<Real> visible_light_normal(const Scene& scene, const VisibleLightHit<Real>& hit,
                                               const Ray<Real, Media>& ray) {
    const VisibleLight<Real>& light = scene.visible_lights[hit.light];
    const Vec3<Real> to_center = light.center - ray.origin;
    const Vec3<Real> across = to_center - dot(to_center, ray.direction) * ray.direction;
    const Real back = square_root(max_or_second(light.radius * light.radius - dot(across, across), Real(0)));
    return Vec3<Real>(Real(0)) - normalized(reciprocal(light.radius) * (across + back * ray.direction));
}

/// The nearest visible light at or after ray.after and before t_limit.
template <class Real, class Media, class Scene>
CISTULA_INLINE VisibleLightHit<Real> closest_visible_light(const Scene& scene, const Ray<Real, Media>& ray,
                                                           Real t_limit) {
    VisibleLightHit<Real> best;
    best.t = t_limit;
    if (!is_finite(ray)) return best;
    // Without a tree, all lights are put on the stack of the traversal.
    static_assert(fewest_in_light_tree <= LightStack::capacity);
    LightStack::Storage storage;
    LightStack stack(storage);
    Real from = ray.after.t;
    if (scene.visible_light_tree.empty()) {
        CISTULA_NOT_UNROLLED
        for (uint32_t i = 0; i < scene.visible_lights.size; ++i) stack.push(~int32_t(i));
    } else {
        stack.push(LightStack::root);
#if !CISTULA_ON_DEVICE
        from = max_or_second(from, Real(0));
        if (!may_hit_visible_lights(scene, ray, from, t_limit)) return best;
#endif
    }
    BoxRay box_ray = BoxRay::of(ray.origin, ray.direction);
    box_ray.near_limit = tree_near(from);
    box_ray.far_limit = tree_far(t_limit);
    traverse_lights(scene.visible_light_tree, box_ray, stack, [&](uint32_t light) {
        intersect_visible_light(scene, light, ray, best);
        return tree_far(best.t);
    });
    return best;
}

}  // namespace cistula
