// Tables of all keys of a JSON scene, and the fields that they are about. The reader takes names, ranges and choices
// from them, the compiler what it allows, and a test compares docs/scene.schema.json and docs/scene.md with them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scene/description/description.h"

namespace cistula {

/// The least size in files; as the low end of a range it stands for: above 0.
inline constexpr double least_size = 1e-30;

struct Range {
    double low = 0, high = 0;
    bool above = false;  // low itself is excluded
    bool below = false;  // high itself is excluded

    /// Whether `value` lies in the range; false for NaN.
    bool contains(double value) const {
        return (above ? value > low : value >= low) && (below ? value < high : value <= high);
    }
};

enum class KeyType {
    whole,   // an integer
    number,  // a double
    boolean,
    text,    // a string, not empty
    choice,  // one of a few strings
    color,   // a number (gray) or three of them
    point,   // three numbers
    pair,    // two numbers
    other,   // an object or array with its own table or reader
};

struct Key {
    std::string_view name;
    KeyType type = KeyType::other;
    Range range{};                // of every number in the value
    std::string_view fallback{};  // the default as JSON text; empty: none
    bool required = false;
    std::span<const std::string_view> choices{};
};

struct KeyTable {
    std::string_view name;  // its name in "$defs" of the schema
    std::span<const Key> keys;

    /// The entry of a key, or nullptr.
    const Key* find(std::string_view key) const;
    std::vector<std::string_view> names() const;
};

extern const KeyTable scene_keys, film_keys, camera_keys, path_keys, cylindrical_keys, texture_file_keys,
    texture_checker_keys, sky_gradient_keys, sky_picture_keys, material_keys, solid_keys, sphere_keys, box_keys,
    convex_keys, prism_keys, edge_lights_keys, quad_keys, plane_keys, disk_keys, disk_shape_keys, triangles_keys,
    triangle_list_keys, mesh_keys, light_keys, frame_keys, keyed_keys;

/// Calls visit(key, field) for each field of a material that stands under a key of its own, in the order of these.
template <class Material, class Visit>
void material_fields(Material& m, const Visit& visit) {
    visit("color", m.color);
    visit("ambient", m.ambient);
    visit("diffuse", m.diffuse);
    visit("specular", m.specular);
    visit("specular_color", m.specular_color);
    visit("exponent", m.exponent);
    visit("reflection", m.reflection);
    visit("transmission", m.transmission);
    visit("tint", m.tint);
    visit("index", m.index);
    visit("absorption", m.absorption);
    visit("fresnel", m.fresnel);
}

/// Calls visit(key, field) for each field of a light, or of the lights on edges.
template <class Light, class Visit>
void light_fields(Light& light, const Visit& visit) {
    visit("color", light.color);
    visit("glow", light.glow);
    visit("radius", light.radius);
    visit("visible", light.visible);
}

/// Calls visit(key, field) for each field of a solid that is named, or of a sphere.
template <class Solid, class Visit>
void solid_fields(Solid& solid, const Visit& visit) {
    visit("center", solid.center);
    visit("radius", solid.radius);
    visit("rotate", solid.rotation);
}

/// Calls visit(key, field) for each field of a disk.
template <class Disk, class Visit>
void disk_fields(Disk& disk, const Visit& visit) {
    visit("center", disk.center);
    visit("normal", disk.normal);
    visit("radius", disk.radius);
}

/// Calls visit(key, field) for each field of a mesh.
template <class Mesh, class Visit>
void mesh_fields(Mesh& mesh, const Visit& visit) {
    visit("center", mesh.center);
    visit("scale", mesh.scale);
    visit("rotate", mesh.rotation);
    visit("keep_triangles", mesh.keep_triangles);
}

/// Whether a program may give a value for a key: where files have numbers to 1e30, any finite one; where they have
/// lengths from 1e-30 on, any above 0.
bool allows(const Key& key, double value);
bool allows(const Key& key, const glm::dvec3& value);
inline bool allows(const Key& key, const std::optional<glm::dvec3>& value) {
    return !value || allows(key, *value);
}
inline bool allows(const Key&, bool) {
    return true;
}

/// What is wrong with a material's shares together, or with a light's falloff; empty: nothing.
std::string shares_fault(const MaterialDescription& material);
std::string falloff_fault(bool falloff, double radius);

/// A key that every object of a scene may have besides those of its table: a string or an array of strings, ignored.
inline constexpr std::string_view comment_key = "$comment";

/// All of the tables above.
std::span<const KeyTable* const> all_key_tables();

/// The shortest decimal text of a number, with "1e30" rather than "1e+30".
std::string number_text(double value);

/// The text of a range: "1 to 65536", "above 0, under 180".
std::string range_text(const Range& range);

/// The expected value of a key, for messages: "a whole number from 1 to 65536".
std::string expected_text(const Key& key);

}  // namespace cistula
