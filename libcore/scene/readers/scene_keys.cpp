#include "scene/readers/scene_keys.h"

#include <fmt/format.h>
#include <limits>

#include "image/color/color_encoding.h"

namespace cistula {
namespace {

// Limits on numbers: squares and cubes of lengths must stay in double's range, radiances up to 2^100 in float's.
constexpr double most = 1e30;
constexpr double most_angle = 1e6;
constexpr Range anywhere{-most, most};
constexpr Range not_negative{0, most};
constexpr Range size{least_size, most};
constexpr Range share{0, 1};
constexpr Range angle{-most_angle, most_angle};

constexpr std::string_view sphere_choices[] = {"sphere"};
constexpr std::string_view solid_choices[] = {"tetrahedron",
                                              "cube",
                                              "octahedron",
                                              "dodecahedron",
                                              "icosahedron",
                                              "truncated-tetrahedron",
                                              "cuboctahedron",
                                              "truncated-cube",
                                              "truncated-octahedron",
                                              "rhombicuboctahedron",
                                              "truncated-cuboctahedron",
                                              "snub-cube",
                                              "icosidodecahedron",
                                              "truncated-dodecahedron",
                                              "truncated-icosahedron",
                                              "rhombicosidodecahedron",
                                              "truncated-icosidodecahedron",
                                              "snub-dodecahedron"};
constexpr std::string_view box_choices[] = {"box"};
constexpr std::string_view convex_choices[] = {"convex"};
constexpr std::string_view prism_choices[] = {"prism", "antiprism", "pyramid"};
constexpr std::string_view filter_choices[] = {"nearest", "bilinear"};
constexpr std::string_view falloff_choices[] = {"none", "inverse-square"};

constexpr std::string_view interpolation_choices[] = {"linear", "step", "smooth"};

constexpr bool required = true;

constexpr Key whole(std::string_view name, Range range, std::string_view fallback, bool needed = false) {
    return {name, KeyType::whole, range, fallback, needed, {}};
}
constexpr Key number(std::string_view name, Range range, std::string_view fallback) {
    return {name, KeyType::number, range, fallback, false, {}};
}
constexpr Key boolean(std::string_view name, std::string_view fallback) {
    return {name, KeyType::boolean, {}, fallback, false, {}};
}
constexpr Key text(std::string_view name, bool needed = false) {
    return {name, KeyType::text, {}, {}, needed, {}};
}
constexpr Key choice(std::string_view name, std::span<const std::string_view> choices, std::string_view fallback) {
    return {name, KeyType::choice, {}, fallback, fallback.empty(), choices};
}
constexpr Key optional_choice(std::string_view name, std::span<const std::string_view> choices) {
    return {name, KeyType::choice, {}, {}, false, choices};
}
constexpr Key color(std::string_view name, Range range, std::string_view fallback) {
    return {name, KeyType::color, range, fallback, false, {}};
}
constexpr Key point(std::string_view name, Range range, std::string_view fallback) {
    return {name, KeyType::point, range, fallback, fallback.empty(), {}};
}
constexpr Key pair(std::string_view name, Range range, std::string_view fallback) {
    return {name, KeyType::pair, range, fallback, false, {}};
}
constexpr Key other(std::string_view name, bool needed = false) {
    return {name, KeyType::other, {}, {}, needed, {}};
}

constexpr Key scene_list[] = {
    text("$schema"),
    other("film"),
    whole("depth", {1, 1024}, "4"),
    number("cutoff", not_negative, "0"),
    number("contact", not_negative, ""),
    color("ambient", not_negative, "0.1"),
    color("background", not_negative, "0"),
    other("camera"),
    other("textures"),
    other("materials"),
    other("objects", required),
    other("lights"),
    other("frame"),
};

constexpr Key film_list[] = {
    whole("width", {1, 65536}, "640"),
    whole("height", {1, 65536}, "480"),
    whole("frames", {1, 1000000}, "1"),
    whole("supersample", {1, 64}, "1"),
    other("frames_per_second"),
    text("owner"),
    text("comments"),
};

constexpr Key camera_list[] = {
    point("position", anywhere, "[0, -5, 2]"),
    point("target", anywhere, "[0, 0, 0]"),
    other("path"),
    point("up", anywhere, "[0, 0, 1]"),
    number("fov", {0, 180, true, true}, "60"),
    number("time_step", angle, "1"),
};

constexpr Key path_list[] = {other("position"), other("target")};

constexpr Key cylindrical_list[] = {
    number("r0", anywhere, "0"), number("z0", anywhere, "0"), number("phi0", angle, "0"), number("Ar", anywhere, "0"),
    number("Az", anywhere, "0"), number("wr", angle, "0"),    number("wz", angle, "0"),   number("wphi", angle, "0"),
    number("pr", angle, "0"),    number("pz", angle, "0"),
};

constexpr Range repeats{0, 1e6, true};
constexpr std::string_view wrap_choices[] = {"repeat", "clamp", "mirror"};
constexpr Key wrap{"wrap", KeyType::other, {}, {}, false, wrap_choices};  // one, or two

constexpr Key texture_file_list[] = {
    text("file", required),
    choice("filter", filter_choices, "\"bilinear\""),
    pair("repeat", repeats, "[1, 1]"),
    wrap,
    optional_choice("colorspace", color_encoding_names),
    boolean("strict", "false"),
};

constexpr Key texture_checker_list[] = {
    other("checker", required),
    pair("repeat", repeats, "[1, 1]"),
    wrap,
};

constexpr Key sky_gradient_list[] = {
    point("axis", anywhere, "[0, 0, 1]"),
    other("stops", required),
};

constexpr Key sky_picture_list[] = {
    text("file", required),
    point("rotate", angle, "[0, 0, 0]"),
    number("scale", not_negative, "1"),
};

constexpr Key material_list[] = {
    color("color", not_negative, "0.8"),   text("texture"),
    number("ambient", not_negative, "1"),  number("diffuse", not_negative, "1"),
    number("specular", not_negative, "0"), color("specular_color", not_negative, "1"),
    number("exponent", {0, 1e6}, "50"),    number("reflection", share, "0"),
    number("transmission", share, "0"),    color("tint", share, "1"),
    number("index", {0.01, 100}, "1"),     color("absorption", not_negative, "0"),
    boolean("fresnel", "false"),
};

constexpr Key solid_list[] = {
    text("name"),
    choice("solid", solid_choices, {}),
    point("center", anywhere, "[0, 0, 0]"),
    number("radius", size, "1"),
    point("rotate", angle, "[0, 0, 0]"),
    text("material", required),
    other("edge_lights"),
};

constexpr Key sphere_list[] = {
    text("name"),
    choice("solid", sphere_choices, {}),
    point("center", anywhere, "[0, 0, 0]"),
    number("radius", size, "1"),
    point("rotate", angle, "[0, 0, 0]"),
    text("material", required),
};

constexpr Key box_list[] = {
    text("name"),
    choice("solid", box_choices, {}),
    point("size", size, {}),
    point("center", anywhere, "[0, 0, 0]"),
    point("rotate", angle, "[0, 0, 0]"),
    text("material", required),
    other("edge_lights"),
};

constexpr Key convex_list[] = {
    text("name"),
    choice("solid", convex_choices, {}),
    other("planes"),
    other("points"),
    point("center", anywhere, "[0, 0, 0]"),
    number("scale", size, "1"),
    point("rotate", angle, "[0, 0, 0]"),
    text("material", required),
    other("edge_lights"),
};

constexpr Key prism_list[] = {
    text("name"),
    choice("solid", prism_choices, {}),
    whole("sides", {3, 255}, {}, required),
    number("radius", size, "1"),
    number("height", size, "1"),
    point("center", anywhere, "[0, 0, 0]"),
    point("rotate", angle, "[0, 0, 0]"),
    text("material", required),
    other("edge_lights"),
};

constexpr Key edge_lights_list[] = {
    whole("count", {0, 1000}, {}, required),
    color("color", not_negative, "1"),
    color("glow", not_negative, {}),
    number("radius", not_negative, "0"),
    boolean("visible", "true"),
    choice("falloff", falloff_choices, "\"none\""),
    text("group"),
};

constexpr Key plane_list[] = {text("name"), other("plane", required), text("material", required)};

constexpr Key disk_list[] = {text("name"), other("disk", required), text("material", required)};

constexpr Key disk_shape_list[] = {
    point("center", anywhere, "[0, 0, 0]"),
    point("normal", anywhere, "[0, 0, 1]"),
    number("radius", size, "1"),
};

constexpr Key quad_list[] = {text("name"), other("quad", required), text("material", required)};

constexpr Key triangles_list[] = {
    text("name"),    other("triangles", required), boolean("keep_triangles", "false"),
    other("smooth"), text("material", required),
};

constexpr Key triangle_list_list[] = {other("vertices", required), other("indices", required), other("uvs"),
                                      other("normals")};

constexpr Key mesh_list[] = {
    text("name"),
    text("mesh", required),
    point("center", anywhere, "[0, 0, 0]"),
    number("scale", size, "1"),
    point("rotate", angle, "[0, 0, 0]"),
    boolean("keep_triangles", "false"),
    other("smooth"),
    text("material"),
};

constexpr Key light_list[] = {
    point("position", anywhere, {}),
    color("color", not_negative, "1"),
    color("glow", not_negative, {}),
    number("radius", not_negative, "0"),
    boolean("visible", "true"),
    choice("falloff", falloff_choices, "\"none\""),
    text("group"),
};

constexpr Key frame_list[] = {
    point("center", anywhere, {}),
    whole("scale", {-150, 150}, {}, required),
    number("bound", {0, most, true}, {}),
};

constexpr Key keyed_list[] = {
    other("keys", required),
    choice("interpolation", interpolation_choices, "\"linear\""),
};

}  // namespace

constexpr KeyTable scene_keys{"scene", scene_list};
constexpr KeyTable film_keys{"film", film_list};
constexpr KeyTable camera_keys{"camera", camera_list};
constexpr KeyTable path_keys{"path", path_list};
constexpr KeyTable cylindrical_keys{"cylindrical", cylindrical_list};
constexpr KeyTable texture_file_keys{"texture_file", texture_file_list};
constexpr KeyTable texture_checker_keys{"texture_checker", texture_checker_list};
constexpr KeyTable sky_gradient_keys{"sky_gradient", sky_gradient_list};
constexpr KeyTable sky_picture_keys{"sky_picture", sky_picture_list};
constexpr KeyTable material_keys{"material", material_list};
constexpr KeyTable solid_keys{"solid", solid_list};
constexpr KeyTable sphere_keys{"sphere", sphere_list};
constexpr KeyTable box_keys{"box", box_list};
constexpr KeyTable convex_keys{"convex", convex_list};
constexpr KeyTable prism_keys{"prism", prism_list};
constexpr KeyTable edge_lights_keys{"edge_lights", edge_lights_list};
constexpr KeyTable quad_keys{"quad", quad_list};
constexpr KeyTable plane_keys{"plane", plane_list};
constexpr KeyTable disk_keys{"disk", disk_list};
constexpr KeyTable disk_shape_keys{"disk_shape", disk_shape_list};
constexpr KeyTable triangles_keys{"triangles", triangles_list};
constexpr KeyTable triangle_list_keys{"triangle_list", triangle_list_list};
constexpr KeyTable mesh_keys{"mesh", mesh_list};
constexpr KeyTable light_keys{"light", light_list};
constexpr KeyTable frame_keys{"frame", frame_list};
constexpr KeyTable keyed_keys{"keyed", keyed_list};

std::span<const KeyTable* const> all_key_tables() {
    static constexpr const KeyTable* tables[] = {
        &scene_keys,         &film_keys,         &camera_keys,          &path_keys,
        &cylindrical_keys,   &texture_file_keys, &texture_checker_keys, &sky_gradient_keys,
        &sky_picture_keys,   &material_keys,     &solid_keys,           &box_keys,
        &convex_keys,        &prism_keys,        &edge_lights_keys,     &quad_keys,
        &plane_keys,         &disk_keys,         &disk_shape_keys,      &triangles_keys,
        &triangle_list_keys, &mesh_keys,         &light_keys,           &frame_keys,
        &keyed_keys};
    return tables;
}

const Key* KeyTable::find(std::string_view key) const {
    for (const Key& candidate : keys)
        if (candidate.name == key) return &candidate;
    return nullptr;
}

std::vector<std::string_view> KeyTable::names() const {
    std::vector<std::string_view> list;
    for (const Key& key : keys) list.push_back(key.name);
    return list;
}

bool allows(const Key& key, double value) {
    Range range = key.range;
    if (range.high == most) range.high = std::numeric_limits<double>::max();
    if (range.low == -most) range.low = std::numeric_limits<double>::lowest();
    if (range.low == least_size) range.low = std::numeric_limits<double>::denorm_min();
    return range.contains(value);
}

bool allows(const Key& key, const glm::dvec3& value) {
    return allows(key, value.x) && allows(key, value.y) && allows(key, value.z);
}

std::string shares_fault(const MaterialDescription& material) {
    constexpr double slack = 1e-6;  // as decimals have
    const double shares = material.reflection + material.transmission;
    return shares <= 1 + slack ? "" : "reflection + transmission is " + number_text(shares) + "; expected at most 1";
}

std::string falloff_fault(bool falloff, double radius) {
    return falloff && !(radius > 0) ? "inverse-square needs a 'radius' above 0, within which it stays constant" : "";
}

std::string number_text(double value) {
    std::string digits = fmt::format("{}", value);
    if (const size_t plus = digits.find("e+"); plus != std::string::npos) digits.erase(plus + 1, 1);
    return digits;
}

std::string range_text(const Range& range) {
    const std::string low = number_text(range.low);
    const std::string high = number_text(range.high);
    if (!range.above && !range.below) return low + " to " + high;
    return (range.above ? "above " : "from ") + low + (range.below ? ", under " : ", to ") + high;
}

namespace {

std::string list_text(std::span<const std::string_view> items) {
    std::string list;
    for (const std::string_view item : items) list += (list.empty() ? "" : ", ") + std::string(item);
    return list;
}

}  // namespace

std::string expected_text(const Key& key) {
    const std::string range = (key.range.above ? "" : "from ") + range_text(key.range);
    switch (key.type) {
        case KeyType::whole:
            return "a whole number " + range;
        case KeyType::number:
            return "a number " + range;
        case KeyType::boolean:
            return "true or false";
        case KeyType::text:
            return "a string that is not empty";
        case KeyType::choice:
            return "one of " + list_text(key.choices);
        case KeyType::color:
            return "a color: a number or [red, green, blue], each " + range;
        case KeyType::point:
            return "[x, y, z], each " + range;
        case KeyType::pair:
            return "[u, v], each " + range;
        case KeyType::other:
            break;
    }
    return "a value";
}

}  // namespace cistula
