// What the course work's algorithm works on: vectors, triangles, materials, lights, the camera's view. Only the words
// that make a function run on host and device come from libcore.
#pragma once

#include <vector>

#include "cistula/numerics/portable.h"

namespace cistula::seed {

struct Vec {
    double x, y, z;
};
CISTULA_HD inline Vec operator+(const Vec& a, const Vec& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
CISTULA_HD inline Vec operator-(const Vec& a, const Vec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
CISTULA_HD inline Vec operator*(const Vec& a, const Vec& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
CISTULA_HD inline Vec operator*(double k, const Vec& a) {
    return {k * a.x, k * a.y, k * a.z};
}
CISTULA_HD inline double dot(const Vec& a, const Vec& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
CISTULA_HD inline Vec cross(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
CISTULA_HD inline Vec normalized(const Vec& a) {
    return (1 / ::sqrt(dot(a, a))) * a;
}

/// Counter-clockwise seen from outside; edges and normal are made once.
struct Triangle {
    Vec corner, ab, ac, normal;
    int material;
    int uv;  // its three corners in Scene::uvs, if the material has a texture
};

struct Uv {
    double u, v;
};

struct Material {
    Vec color, ambient;  // ambient: times the scene's
    double diffuse, specular, exponent, reflection, transmission, index;
    int texture_width, texture_height, first_texel;  // width 0: no texture
};

struct Light {
    Vec position, intensity;
};

/// Flat arrays of the host or of the device.
struct Scene {
    const Triangle* triangles;
    const Uv* uvs;
    const Material* materials;
    const Light* lights;
    const Vec* texels;
    int triangle_count, light_count;
    Vec background;
};

/// The arrays of a Scene with their owner, on the host.
struct OwnedScene {
    std::vector<Triangle> triangles;
    std::vector<Uv> uvs;
    std::vector<Material> materials;
    std::vector<Light> lights;
    std::vector<Vec> texels;
    Vec background{0, 0, 0};

    Scene view() const {
        return {triangles.data(),
                uvs.data(),
                materials.data(),
                lights.data(),
                texels.data(),
                static_cast<int>(triangles.size()),
                static_cast<int>(lights.size()),
                background};
    }
};

/// right spans the picture from its center to its right edge, up as far up.
struct View {
    Vec position, forward, right, up;
    int width, height;
};

struct Pixel {
    float r, g, b;

    bool operator==(const Pixel&) const = default;
};

}  // namespace cistula::seed
