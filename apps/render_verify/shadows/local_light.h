// The contribution of one light at a hit, as the ray tree computes it, with and without shadows.
#pragma once

#include "apps/render_verify/case.h"
#include "apps/render_verify/crossings.h"
#include "apps/render_verify/scenes.h"
#include "cistula/shading/lighting.h"
#include "cistula/transport/pixel_sums.h"

namespace cistula::verify::shadows {

using All = Effects<all_effects>;

/// Contribution of a light, with radiance in units of 2^-62.
struct LocalLight {
    int64_t radiance[3];
    uint32_t shadow_rays, flags;

    CISTULA_HD bool operator==(const LocalLight& o) const {
        return radiance[0] == o.radiance[0] && radiance[1] == o.radiance[1] && radiance[2] == o.radiance[2] &&
               flags == o.flags;
    }
    CISTULA_HD bool dark() const { return radiance[0] == 0 && radiance[1] == 0 && radiance[2] == 0; }
};

/// A stand-in for an intersector: all light arrives.
struct Unshadowed {
    template <class Real, class Media>
    CISTULA_HD Hit<Real> closest(const Ray<Real, Media>&) const {
        return Hit<Real>();
    }
    template <class E, class Real, class Media>
    CISTULA_HD Vec3<Real> transmittance(const ShadowRay<Real, Media>&) const {
        return Vec3<Real>(Real(1));
    }
};

template <class Real, class Intersector>
CISTULA_HD inline LocalLight local_light(const Setup<Real>& setup, const Intersector& intersector, const Ray<Real>& ray,
                                         const Hit<Real>& hit, const Surface<Real>& surface, uint32_t light) {
    SceneView<Real> one_light = setup.scene;
    one_light.lights = {setup.scene.lights.data + light, 1};
    TreeSettings settings;
    settings.fixed_scale = 0x1p62;
    settings.fixed_unit = 0x1p-62;
    PixelRecord record{};
    uint32_t flags = 0;
    PixelSums<Real> sums(settings, one_light, record, flags);
    PixelRays rays;
    SurfaceEvent<Real> event;
    event.begin(ray, hit);
    add_local_light<Real, All>(one_light, intersector, ray, event, surface, Vec3<Real>(Real(1)), sums, rays);
    return {{record.radiance[0], record.radiance[1], record.radiance[2]}, rays.shadow, flags};
}

/// A shadow ray from a point in space to a light, aimed as in add_local_light.
template <class Real>
CISTULA_HD inline ShadowRay<Real> shadow_ray(const Setup<Real>& setup, const Vec3<Real>& origin, uint32_t light) {
    const Light<Real>& to = setup.scene.lights[light];
    Vec3<Real> direction = to.position - origin;
    const Real distance = length(direction);
    direction *= Real(1) / distance;
    return {ray_from(origin, direction), distance, &to};
}

/// A scene of lights only, so that what is dark is in shadow.
inline SceneDescription lit_scene() {
    SceneDescription scene = empty_scene();
    scene.ambient = glm::dvec3(0);
    return scene;
}

/// The square [-half, half]^2 at height z, rotated; n x n cells of two triangles, cut along one diagonal or the other.
inline TrianglesObject square(double half, double z, uint32_t n, bool other_way,
                              const glm::dvec3& rotation = glm::dvec3(0), const glm::dvec3& center = glm::dvec3(0)) {
    const Rotation turned(rotation);
    TrianglesObject mesh;
    for (uint32_t y = 0; y <= n; ++y)
        for (uint32_t x = 0; x <= n; ++x)
            mesh.vertices.push_back(center + turned(glm::dvec3(half * (2.0 * x / n - 1), half * (2.0 * y / n - 1), z)));
    for (uint32_t y = 0; y < n; ++y)
        for (uint32_t x = 0; x < n; ++x) {
            const uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            if (other_way) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({b, d, c});
            } else {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({a, d, c});
            }
        }
    return mesh;
}

}  // namespace cistula::verify::shadows
