#include <utility>

#include "verify/scenes/generated_parts.h"

namespace cistula::generated {

void ObjectMaker::add(Shape shape, bool see_through) {
    bool textured = false;
    if (auto* triangles = std::get_if<TrianglesObject>(&shape)) {
        if (triangles->uvs.empty() && random_.chance(0.4))
            for (const dvec3& p : triangles->vertices) triangles->uvs.emplace_back(p.x, p.y + 0.5 * p.z);
        textured = !triangles->uvs.empty();
        if (scene_.objects.size() % 5 == 3) triangles->keep_triangles = false;  // convex ones are given by planes
        if (palette_ == Palette::everything && scene_.objects.size() % 4 == 2) triangles->smooth = 100;
    } else if (auto* solid = std::get_if<SolidObject>(&shape)) {
        if (palette_ >= Palette::lights && edge_lights_left_ > 0 && random_.chance(0.15) && !heavy_)
            add_edge_lights(solid->edge_lights);
    } else if (!std::holds_alternative<MeshObject>(shape)) {
        textured = random_.chance(0.7);  // balls, disks and planes have coordinates of their own
    }
    ObjectDescription object;
    object.name = "object " + std::to_string(scene_.objects.size());
    object.material = reused_ >= 0 && !textured && random_.chance(0.2) ? reused_ : add_material(see_through, textured);
    if (scene_.materials[static_cast<size_t>(object.material)].texture < 0) reused_ = object.material;
    object.shape = std::move(shape);
    scene_.objects.push_back(std::move(object));
}

int ObjectMaker::texture() {
    TextureDescription t;
    t.name = "texture " + std::to_string(scene_.textures.size());
    t.checker = {random_.color(), random_.chance(0.3) ? dvec3(0) : random_.color()};
    t.repeat = {random_.of({1, 2, 5.5}), random_.of({1, 3, 0.7})};
    const bool picture = random_.chance(0.5);
    const bool marble = random_.chance(0.5);
    t.bilinear = random_.chance(0.6);
    const size_t number = scene_.textures.size();
    t.wrap = {TextureWrap(number % 3), TextureWrap(number / 2 % 3)};
    if (picture && !files_.empty()) t.file = files_ + (marble ? "/marble.data" : "/floor.data");
    scene_.textures.push_back(t);
    return static_cast<int>(scene_.textures.size()) - 1;
}

dvec3 ObjectMaker::tint() {
    dvec3 t = random_.color();
    for (int c = 0; c < 3; ++c)
        if (random_.chance(0.15)) t[c] = random_.chance(0.5) ? 0 : 1;
    return t;
}

void ObjectMaker::share_out(MaterialDescription& m, bool see_through) {
    const uint32_t kind = see_through && random_.chance(0.8) ? 3 + random_.below(6) : random_.below(9);
    switch (palette_ == Palette::mirrors ? kind % 3 : kind) {
        case 0:
            break;  // opaque
        case 1:
            m.reflection = random_.between(0.1, 0.9);
            break;
        case 2:
            m.reflection = 1;
            break;
        case 3:
            m.transmission = 1;  // clear
            break;
        case 4:
            m.transmission = 1;
            m.tint = tint();
            break;
        case 5:
            m.reflection = random_.of({0.25, 0.1, 0.3});
            m.transmission = 1 - m.reflection;
            m.tint = random_.chance(0.5) ? dvec3(1) : tint();
            break;
        case 6:
            m.reflection = 0.3;
            m.transmission = 0.7000005;  // a little above 1 is let pass
            break;
        case 7:
            m.transmission = random_.between(0.2, 0.9);
            m.tint = tint();
            break;
        default:
            m.reflection = random_.between(0.05, 0.3);
            m.transmission = random_.between(0.4, 0.7);
            m.tint = tint();
    }
    if (palette_ == Palette::clear) m.tint = dvec3(1);
}

/// Adds a material and returns its number; it may be required to transmit light more often than not, or to have a
/// texture.
int ObjectMaker::add_material(bool see_through, bool textured) {
    MaterialDescription m;
    m.name = "material " + std::to_string(scene_.materials.size());
    m.color = random_.color();
    m.ambient = random_.of({0, 0.3, 1, 1});
    m.diffuse = random_.of({0, 0.5, 0.8, 1});
    m.specular = random_.of({0, 0, 0.4, 1});
    if (random_.chance(0.3)) m.specular_color = random_.color();
    m.exponent = random_.of({0, 1, 2, 5, 50, 110, 1024, 1025, 0.5, 2.5, 37.3, 4000.25});
    if (textured && random_.chance(0.6)) m.texture = texture();
    if (palette_ != Palette::opaque) share_out(m, see_through);
    if (palette_ == Palette::everything) {
        m.index = random_.of({1, 1, 1.000001, 1.33, 1.5, 1.5, 2.4, 0.75, 0.5});
        m.fresnel = random_.chance(0.4);
        const double strength = random_.of({0.2, 1, 10});
        if (random_.chance(0.4)) m.absorption = strength * tint();
    }
    scene_.materials.push_back(m);
    return static_cast<int>(scene_.materials.size()) - 1;
}

void ObjectMaker::add_edge_lights(EdgeLights& lights) {
    --edge_lights_left_;
    lights.count = 1 + static_cast<int>(random_.below(2));
    lights.color = random_.chance(0.15) ? dvec3(0) : random_.color_times({0.05, 0.2});
    if (random_.chance(0.2)) return;
    lights.radius = random_.of({0.02, 0.06});
    if (random_.chance(0.6)) lights.glow = random_.color();
    lights.falloff = random_.chance(0.4);
}

dvec3 ObjectMaker::degrees() {
    const double kind = random_.unit();
    if (kind < 0.25) return dvec3(0);
    if (kind < 0.45) return {random_.of({0, 90, 180}), random_.of({0, 90, 270}), random_.of({0, 45, -90})};
    return random_.in_cube(180);
}

SolidObject ObjectMaker::solid(const dvec3& center, double radius) {
    const auto kind = static_cast<PlatonicSolid>(random_.below(5));
    return {.solid = kind, .center = center, .radius = radius, .rotation = degrees()};
}

SphereObject ObjectMaker::ball(const dvec3& center, double radius) {
    return {center, radius, degrees()};
}

}  // namespace cistula::generated
