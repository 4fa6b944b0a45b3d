// The algorithm of the course work that Cistula grew from, written from its description: double precision, every ray
// against every triangle, a template recursion ray<depth>. The baseline of GPU tables, so it shares nothing with
// libcore's hits and light.
#pragma once

#include "bench/seed_baseline_data.h"

namespace cistula::seed {

/// Hits nearer than this are the surface that the ray starts on.
constexpr double least_distance = 1e-9;

struct Hit {
    int triangle = -1;
    double t = HUGE_VAL, u = 0, v = 0;
};

/// Moeller and Trumbore 1997, seen from both sides.
CISTULA_HD inline bool intersects(const Triangle& triangle, const Vec& origin, const Vec& direction, double& t,
                                  double& u, double& v) {
    const Vec p = cross(direction, triangle.ac);
    const double determinant = dot(triangle.ab, p);
    if (::fabs(determinant) < 1e-12) return false;
    const double inverse = 1 / determinant;
    const Vec from_corner = origin - triangle.corner;
    u = dot(from_corner, p) * inverse;
    if (u < 0 || u > 1) return false;
    const Vec q = cross(from_corner, triangle.ab);
    v = dot(direction, q) * inverse;
    if (v < 0 || u + v > 1) return false;
    t = dot(triangle.ac, q) * inverse;
    return t > least_distance;
}

CISTULA_HD inline Hit closest(const Scene& scene, const Vec& origin, const Vec& direction) {
    Hit hit;
    for (int i = 0; i < scene.triangle_count; ++i) {
        double t, u, v;
        if (intersects(scene.triangles[i], origin, direction, t, u, v) && t < hit.t) hit = {i, t, u, v};
    }
    return hit;
}

/// The share of a light that arrives: the transmission of every face on the way.
CISTULA_HD inline double arrives(const Scene& scene, const Vec& point, const Vec& to_light, double distance) {
    double share = 1;
    for (int i = 0; i < scene.triangle_count; ++i) {
        double t, u, v;
        if (!intersects(scene.triangles[i], point, to_light, t, u, v) || t >= distance) continue;
        share *= scene.materials[scene.triangles[i].material].transmission;
        if (share == 0) break;
    }
    return share;
}

/// The nearest texel; texel rows run along v, and the texture repeats.
CISTULA_HD inline Vec texel_at(const Scene& scene, const Material& material, const Triangle& triangle, const Hit& hit) {
    const Uv* uv = scene.uvs + triangle.uv;
    const double a = 1 - hit.u - hit.v;
    const double x = a * uv[0].u + hit.u * uv[1].u + hit.v * uv[2].u;
    const double y = a * uv[0].v + hit.u * uv[1].v + hit.v * uv[2].v;
    int i = static_cast<int>((x - ::floor(x)) * material.texture_width);
    int j = static_cast<int>((y - ::floor(y)) * material.texture_height);
    if (i >= material.texture_width) i = material.texture_width - 1;
    if (j >= material.texture_height) j = material.texture_height - 1;
    return scene.texels[material.first_texel + j * material.texture_width + i];
}

/// Ambient light and Phong's of every light that the viewer's side of the surface faces.
CISTULA_HD inline Vec local_light(const Scene& scene, const Material& material, const Vec& color, const Vec& point,
                                  const Vec& normal, const Vec& direction) {
    Vec sum = color * material.ambient;
    for (int i = 0; i < scene.light_count; ++i) {
        const Light& light = scene.lights[i];
        Vec to_light = light.position - point;
        const double distance = ::sqrt(dot(to_light, to_light));
        to_light = (1 / distance) * to_light;
        const double n_l = dot(normal, to_light);
        if (n_l <= 0) continue;
        const double share = arrives(scene, point, to_light, distance);
        if (share == 0) continue;
        const double r_v = dot(to_light - 2 * n_l * normal, direction);
        const double highlight = r_v > 0 ? material.specular * ::pow(r_v, material.exponent) : 0.0;
        const Vec lit = material.diffuse * n_l * color + Vec{highlight, highlight, highlight};
        sum = sum + share * (light.intensity * lit);
    }
    return sum;
}

/// Snell's law; false where all of the light is reflected. `eta` is the index left over the index entered.
CISTULA_HD inline bool refract(const Vec& direction, const Vec& normal, double eta, Vec& result) {
    const double cosine = -dot(direction, normal);
    const double square = 1 - eta * eta * (1 - cosine * cosine);
    if (square < 0) return false;
    result = normalized(eta * direction + (eta * cosine - ::sqrt(square)) * normal);
    return true;
}

/// What a ray sees, black at the limit. Each depth is a function of its own.
template <int depth>
CISTULA_HD Vec ray(const Scene& scene, const Vec& origin, const Vec& direction) {
    if constexpr (depth == 0) {
        return {0, 0, 0};
    } else {
        const Hit hit = closest(scene, origin, direction);
        if (hit.triangle < 0) return scene.background;
        const Triangle& triangle = scene.triangles[hit.triangle];
        const Material& material = scene.materials[triangle.material];
        const Vec point = origin + hit.t * direction;
        const bool enters = dot(triangle.normal, direction) < 0;
        const Vec normal = enters ? triangle.normal : -1 * triangle.normal;
        Vec color = material.color;
        if (material.texture_width > 0) color = color * texel_at(scene, material, triangle, hit);

        double reflection = material.reflection, transmission = material.transmission;
        Vec sum = (1 - reflection - transmission) * local_light(scene, material, color, point, normal, direction);
        if (transmission > 0) {
            Vec through;
            if (refract(direction, normal, enters ? 1 / material.index : material.index, through))
                sum = sum + transmission * ray<depth - 1>(scene, point, through);
            else
                reflection += transmission;
        }
        if (reflection > 0) {
            const Vec mirrored = direction - 2 * dot(direction, normal) * normal;
            sum = sum + reflection * ray<depth - 1>(scene, point, mirrored);
        }
        return sum;
    }
}

/// The picture's pixel (x, y), (0, 0) at the top left, by the ray through its center.
template <int depth>
CISTULA_HD Pixel pixel(const Scene& scene, const View& view, int x, int y) {
    const double sx = (2 * x + 1 - view.width) / static_cast<double>(view.width);
    const double sy = (view.height - 2 * y - 1) / static_cast<double>(view.width);
    const Vec color = ray<depth>(scene, view.position, normalized(view.forward + sx * view.right + sy * view.up));
    return {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
}

/// The CPU's loop, one thread.
template <int depth>
void render_on_host(const Scene& scene, const View& view, Pixel* pixels) {
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) *pixels++ = pixel<depth>(scene, view, x, y);
}

}  // namespace cistula::seed
