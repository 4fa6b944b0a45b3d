// What is around a scene where that is not of one color: its radiance by direction, in double.
#pragma once

#include "cistula/model/effects.h"
#include "cistula/model/texture.h"
#include "cistula/numerics/trigonometry.h"

namespace cistula {

/// The color of a gradient: linear in the cosine of the angle to its axis, of which stops are in descending order.
template <class Scene>
CISTULA_HD inline Vec3<double> gradient_color(const Scene& scene, const Vec3<double>& direction) {
    const double length = square_root(dot(direction, direction));
    const double cosine = clamped(dot(scene.sky.axes[2], direction) / length, -1.0, 1.0);
    const uint32_t count = scene.sky_stops.size;
    uint32_t next = 0;
    while (next < count && cosine < scene.sky_stops[next].cosine) ++next;
    const SkyStop& end = scene.sky_stops[next < count ? next : count - 1];
    if (next == 0 || next == count) return end.color;
    const SkyStop& begin = scene.sky_stops[next - 1];
    const double share = (begin.cosine - cosine) / (begin.cosine - end.cosine);
    return begin.color + (end.color - begin.color) * share;
}

/// The color of a picture by longitude and latitude: its middle column lies toward its x axis, its left half toward y,
/// its top toward z. Columns go round, rows end at the poles.
template <class Scene>
CISTULA_HD inline Vec3<double> picture_color(const Scene& scene, const Vec3<double>& direction) {
    constexpr double pi = 0x1.921fb54442d18p+1;
    const Texture& texture = scene.textures[scene.sky.texture];
    const double x = dot(scene.sky.axes[0], direction);
    const double y = dot(scene.sky.axes[1], direction);
    const double z = dot(scene.sky.axes[2], direction);
    const double u = 0.5 - elementary::atan2(y, x) / (2 * pi);
    const double v = elementary::atan2(square_root(fused(x, x, y * y)), z) / pi;
    const Vec3<float>* texels = scene.texels.data + texture.first_texel;
    const auto texel = [&](uint32_t column, uint32_t row) { return texel_at<double>(texels, texture, column, row); };
    return bilinear(texture, u * double(texture.width), v * double(texture.height), texel) * scene.sky.scale;
}

/// The radiance of a sky that a ray of this direction, of about unit length, ends on. (In lanes: lane_lights.h.)
template <class Real, class Scene>
CISTULA_NOINLINE Vec3<Real> sky_radiance(const Scene& scene, const Vec3<Real>& direction, bool = true) {
    const Vec3<double> d(direction);
    return Vec3<Real>(scene.sky.kind == SkyKind::picture ? picture_color(scene, d) : gradient_color(scene, d));
}

/// The radiance that a ray ends on that meets nothing.
template <class E, class Real, class Scene>
CISTULA_INLINE Vec3<Real> background_radiance(const Scene& scene, [[maybe_unused]] const Vec3<Real>& direction) {
    if constexpr (E::has(effect_sky))
        if (scene.sky.kind != SkyKind::none) return sky_radiance(scene, direction);
    return scene.background;
}

}  // namespace cistula
