#include "scene/readers/scene_formats.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/decimal.h"
#include "base/shown_text.h"
#include "scene/readers/meshes/polygon.h"
#include "scene/readers/scene_keys.h"
#include "scene/readers/text_tokens.h"

namespace cistula {
namespace {

// Defaults for what the input leaves out, taken from the public programs of its family.
constexpr double ambient_light = 0.5;
constexpr double phong_exponent = 110;
constexpr double glass_index = 1.5;
constexpr double floor_reflection = 0.5;
constexpr double visible_radius = 0.1;  // such programs return white for a ray that passes a light closer than this
constexpr const char* texture_file = "the floor's texture file";
constexpr double full_turn = 2 * 3.14159265358979323846;
constexpr Range light_count{0, 100000};

/// The order of an input's parts, and what its time is (docs/scene.md).
enum class Order {
    program,     // the floor's texture on the second line; t is the frame's number
    assignment,  // the output pattern on the second line, the floor's texture behind its corners; t is 0 to 2 pi
};

struct InputSolid {
    PlatonicSolid solid;
    const char* name;
    double edge;  // edge length for a circumradius of 1
};

constexpr InputSolid input_solids[] = {
    {PlatonicSolid::octahedron, "octahedron", 1.4142135623730951},
    {PlatonicSolid::dodecahedron, "dodecahedron", 0.7136441795461798},
    {PlatonicSolid::icosahedron, "icosahedron", 1.0514622242382672},
};

const Range& range_of(const KeyTable& table, std::string_view key) {
    return table.find(key)->range;
}

glm::dvec3 read_point(TextTokens& tokens, const std::string& what) {
    const Range& range = range_of(solid_keys, "center");
    glm::dvec3 point;
    point.x = tokens.number(what + " x", range);
    point.y = tokens.number(what + " y", range);
    point.z = tokens.number(what + " z", range);
    return point;
}

glm::dvec3 read_color(TextTokens& tokens, const std::string& what) {
    const Range& range = range_of(material_keys, "color");
    glm::dvec3 color;
    color.r = tokens.number(what + " red", range);
    color.g = tokens.number(what + " green", range);
    color.b = tokens.number(what + " blue", range);
    return color;
}

CylindricalPath read_path(TextTokens& tokens, const std::string& what) {
    CylindricalPath path;
    const std::pair<const char*, double*> numbers[] = {
        {"r0", &path.r0}, {"z0", &path.z0}, {"phi0", &path.phi0}, {"Ar", &path.Ar}, {"Az", &path.Az},
        {"wr", &path.wr}, {"wz", &path.wz}, {"wphi", &path.wphi}, {"pr", &path.pr}, {"pz", &path.pz}};
    for (const auto& [name, number] : numbers)
        *number = tokens.number(what + " " + name, range_of(cylindrical_keys, name));
    return path;
}

/// Whether the pattern has exactly one "%d" or "%04d" and no other percent sign.
bool is_pattern(std::string_view pattern) {
    const size_t percent = pattern.find('%');
    if (percent == std::string_view::npos || pattern.find('%', percent + 1) != std::string_view::npos) return false;
    std::string_view rest = pattern.substr(percent + 1);
    if (rest.size() > 2 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9') rest.remove_prefix(2);
    return rest.starts_with('d');
}

/// Whether a word has a place for the frame's number, "%d" or with digits between, right or wrong.
bool has_frame_number(std::string_view word) {
    const size_t percent = word.find('%');
    if (percent == std::string_view::npos) return false;
    const size_t end = word.find_first_not_of("0123456789", percent + 1);
    return end != std::string_view::npos && word[end] == 'd';
}

/// Lights on the edges. Their radius keeps neighbors apart: at most a quarter of their distance.
EdgeLights edge_lights(int count, double edge_length) {
    EdgeLights lights;
    lights.count = count;
    if (count > 0) lights.radius = std::min(visible_radius, edge_length / (count + 1) / 4);
    return lights;
}

void read_solid(TextTokens& tokens, const InputSolid& input, SceneDescription& scene) {
    const std::string name = input.name;
    if (tokens.words_on_new_line() == 11) {
        tokens.word(name);
        tokens.fail(tokens.line(), fmt::format("expected 9 or 10 numbers for the {}, found 11", name));
    }
    SolidObject solid;
    solid.solid = input.solid;
    solid.center = read_point(tokens, name + " center");
    ObjectDescription object;
    object.place = fmt::format("line {}", tokens.line());
    object.name = name;
    object.material = static_cast<int>(scene.materials.size());
    MaterialDescription material;
    material.name = name;
    material.color = material.specular_color = read_color(tokens, name + " color");
    material.specular = 1;
    material.exponent = phong_exponent;
    material.index = glass_index;
    solid.radius = tokens.number(name + " radius", range_of(solid_keys, "radius"));
    material.reflection = tokens.number(name + " reflection", range_of(material_keys, "reflection"));
    material.transmission = tokens.number(name + " transmission", range_of(material_keys, "transmission"));
    if (const std::string fault = shares_fault(material); !fault.empty())
        tokens.fail(tokens.line(), fmt::format("{} {}", name, fault));
    if (tokens.one_more_on_line()) {
        const int count = tokens.whole(name + " lights on each edge", range_of(edge_lights_keys, "count"));
        solid.edge_lights = edge_lights(count, input.edge * solid.radius);
    }
    object.shape = solid;
    scene.materials.push_back(material);
    scene.objects.push_back(object);
}

void add_floor_texture(std::string_view file, int line, const std::string& base_dir, SceneDescription& scene) {
    TextureDescription texture;
    texture.name = "floor";
    if (file == "checker") {
        texture.checker = {glm::dvec3{0.8}, glm::dvec3{0.3, 0.3, 0.35}};
        texture.repeat = glm::dvec2{5};
    } else {
        texture.file = file_beside_scene(std::string(file), base_dir);
    }
    texture.place = fmt::format("line {}", line);
    scene.textures.push_back(texture);
}

/// The floor. `order` decides whether its texture, tint and reflection follow its corners.
void read_floor(TextTokens& tokens, Order order, const std::string& base_dir, SceneDescription& scene) {
    std::array<glm::dvec3, 4> corners;
    ObjectDescription object;
    for (size_t i = 0; i < corners.size(); ++i) {
        corners[i] = read_point(tokens, fmt::format("floor corner {}", i + 1));
        if (i == 0) object.place = fmt::format("line {}", tokens.line());
    }
    if (const auto problem = quad_problem(corners)) tokens.fail(tokens.line(), "floor: " + *problem);
    MaterialDescription material;
    material.name = object.name = "floor";
    material.color = glm::dvec3{1};
    material.texture = 0;
    material.specular = 1;
    material.exponent = phong_exponent;
    material.reflection = floor_reflection;
    if (order == Order::assignment) {
        const std::string_view file = tokens.word(texture_file);
        if (decimal<double>(file))
            tokens.fail(tokens.line(), fmt::format("expected {}, found {}", texture_file, quoted(file)));
        add_floor_texture(file, tokens.line(), base_dir, scene);
        material.color = read_color(tokens, "floor tint");
        material.reflection = tokens.number("floor reflection", range_of(material_keys, "reflection"));
    }
    object.material = static_cast<int>(scene.materials.size());
    object.shape = quad_triangles(corners);
    scene.materials.push_back(material);
    scene.objects.push_back(object);
}

void read_lights(TextTokens& tokens, SceneDescription& scene) {
    const int count = tokens.whole("number of lights", light_count);
    for (int i = 1; i <= count; ++i) {
        LightDescription light;
        const std::string name = fmt::format("light {}", i);
        light.position = read_point(tokens, name + " position");
        light.place = fmt::format("line {}", tokens.line());
        light.color = read_color(tokens, name + " color");
        light.glow = glm::dvec3{1};
        light.radius = visible_radius;
        scene.lights.push_back(light);
    }
}

}  // namespace

SceneDescription read_text_input(const std::string& text, const std::string& label, const std::string& base_dir) {
    TextTokens tokens(text, label);
    SceneDescription scene;
    scene.from_text_input = true;
    scene.ambient = glm::dvec3{ambient_light};
    scene.film.frames = tokens.whole("number of frames", range_of(film_keys, "frames"));
    const std::string_view second = tokens.word(texture_file);
    const Order order = has_frame_number(second) ? Order::assignment : Order::program;
    if (order == Order::program) {
        add_floor_texture(second, tokens.line(), base_dir, scene);
        scene.film.output = tokens.word("the output pattern with %d");
    } else {
        scene.film.output = second;
        scene.camera.time_step = full_turn / scene.film.frames;
    }
    if (!is_pattern(scene.film.output))
        tokens.fail(tokens.line(),
                    fmt::format("expected an output pattern with one %d, found {}", quoted(scene.film.output)));
    scene.film.width = tokens.whole("picture width", range_of(film_keys, "width"));
    scene.film.height = tokens.whole("picture height", range_of(film_keys, "height"));
    scene.camera.field_of_view = tokens.number("horizontal field of view", range_of(camera_keys, "fov"));
    scene.camera.position_path = read_path(tokens, "camera");
    scene.camera.place = fmt::format("{}:{}", label, tokens.line());
    scene.camera.target_path = read_path(tokens, "target");
    for (const InputSolid& solid : input_solids) read_solid(tokens, solid, scene);
    read_floor(tokens, order, base_dir, scene);
    read_lights(tokens, scene);
    scene.depth = tokens.whole("depth", range_of(scene_keys, "depth"));
    scene.film.supersample = tokens.whole("supersampling k", range_of(film_keys, "supersample"));
    tokens.finish();
    return scene;
}

std::string text_input_template() {
    return R"(300
checker
frames/frame%d.out
1280 720 120
6.0 5.0 0.0 2.0 1.0 0.05 0.1 0.05 0.0 0.0
3.0 0.0 3.1415926 1.5 0.5 0.03 0.07 0.02 0.0 0.0
-2.5 2.5 2 0.9843 0.4745 0.0156 2.25 0.1 0.6
2.5 2.5 2 0.49 0.3216 0.0078 1.732 0.1 0.6
2.5 -2.5 2 0.949 0.773 0.05 2.118 0.1 0.6
-5 -5 0
5 -5 0
5 5 0
-5 5 0
2
-4 4 3 1 1 1
5 0 4 1 1 1
4 3
)";
}

}  // namespace cistula
