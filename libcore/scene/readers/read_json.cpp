#include "scene/readers/scene_formats.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/suggest.h"
#include "image/color/color_encoding.h"
#include "scene/description/light_group.h"
#include "scene/readers/json_reader.h"
#include "scene/readers/scene_keys.h"

namespace cistula {
namespace {

using NameIndices = std::unordered_map<std::string, int>;

/// A whole number of frames per second, or a fraction of two.
void read_rate(const JsonValue& value, FilmDescription& film) {
    static constexpr Key part{"frames_per_second", KeyType::whole, {1, 1000000}, {}, false, {}};
    if (!value.json().is_array()) {
        if (!value.json().is_number_integer())
            value.fail_expected("a whole number, or [numerator, denominator] as in [24000, 1001]");
        film.rate = static_cast<int>(value.whole(part));
        return;
    }
    if (value.json().size() != 2) value.fail_expected("[numerator, denominator] as in [24000, 1001]");
    film.rate = static_cast<int>(value.item(0).whole(part));
    film.rate_divisor = static_cast<int>(value.item(1).whole(part));
}

FilmDescription read_film(const JsonValue& value) {
    FilmDescription film;
    JsonObject keys(value, film_keys);
    keys.read("width", film.width);
    keys.read("height", film.height);
    keys.read("frames", film.frames);
    keys.read("supersample", film.supersample);
    if (keys.has("frames_per_second")) read_rate(keys.at("frames_per_second"), film);
    keys.read("owner", film.owner);
    keys.read("comments", film.comments);
    keys.finish();
    return film;
}

CylindricalPath read_cylindrical(const JsonValue& value) {
    CylindricalPath path;
    JsonObject keys(value, cylindrical_keys);
    keys.read("r0", path.r0);
    keys.read("z0", path.z0);
    keys.read("phi0", path.phi0);
    keys.read("Ar", path.Ar);
    keys.read("Az", path.Az);
    keys.read("wr", path.wr);
    keys.read("wz", path.wz);
    keys.read("wphi", path.wphi);
    keys.read("pr", path.pr);
    keys.read("pz", path.pz);
    keys.finish();
    return path;
}

CameraDescription read_camera(const JsonValue& value) {
    CameraDescription camera;
    JsonObject keys(value, camera_keys);
    keys.read("position", camera.position);
    keys.read("target", camera.target);
    keys.read("up", camera.up);
    keys.read("fov", camera.field_of_view);
    keys.read("time_step", camera.time_step);
    if (keys.has("path")) {
        JsonObject path(keys.at("path"), path_keys);
        if (path.has("position")) camera.position_path = read_cylindrical(path.at("position"));
        if (path.has("target")) camera.target_path = read_cylindrical(path.at("target"));
        if (!camera.position_path && !camera.target_path)
            path.value().fail("expected a path for 'position', for 'target' or for both");
        path.finish();
    }
    if (camera.position_path && keys.has("position"))
        keys.fail("position", "the path gives the position already", "leave out one of the two");
    if (camera.target_path && keys.has("target"))
        keys.fail("target", "the path gives the target already", "leave out one of the two");
    if (camera.up == glm::dvec3{0}) keys.fail("up", "expected a direction other than [0, 0, 0]");
    if (!camera.position_path && !camera.target_path && camera.position == camera.target)
        keys.fail("target", "the camera's position and target coincide", "move one of them");
    keys.finish();
    return camera;
}

/// Throws for an object that lacks what tells its form, most likely because that is misspelled.
[[noreturn]] void fail_without_form(const JsonValue& value, const std::vector<std::string_view>& known,
                                    const char* problem) {
    for (const auto& member : value.json().items())
        if (member.key() != comment_key && std::find(known.begin(), known.end(), member.key()) == known.end())
            value.fail_at(value.place_of(member.key()), "unknown key", suggestion(member.key(), known, "keys"));
    value.fail(problem);
}

/// What lies beyond a texture's edges: one word for both axes, or one for each.
void read_wrap(JsonObject& keys, TextureDescription& texture) {
    const Key word{"wrap", KeyType::choice, {}, {}, false, texture_file_keys.find("wrap")->choices};
    if (!keys.has("wrap")) return;
    const JsonValue wrap = keys.at("wrap");
    if (wrap.json().is_array() && wrap.json().size() != 2)
        wrap.fail_expected(expected_text(word) + ", or two of them for u and v");
    for (size_t axis = 0; axis < 2; ++axis)
        texture.wrap[axis] = static_cast<TextureWrap>((wrap.json().is_array() ? wrap.item(axis) : wrap).choice(word));
}

TextureDescription read_texture(const JsonValue& value, const std::string& base_dir) {
    TextureDescription texture;
    texture.place = value.place();
    const bool is_object = value.json().is_object();
    const bool has_file = is_object && value.json().contains("file");
    const bool has_checker = is_object && value.json().contains("checker");
    if (has_file && has_checker) value.fail("expected one of 'file' and 'checker', found both");
    if (is_object && !has_file && !has_checker)
        fail_without_form(value, {"file", "filter", "checker", "repeat", "wrap", "colorspace", "strict"},
                          "expected one of the keys 'file' and 'checker'");
    if (!has_checker) {
        JsonObject keys(value, texture_file_keys);
        keys.read("file", texture.file);
        texture.file = file_beside_scene(texture.file, base_dir);
        if (const int filter = keys.read_choice("filter"); filter >= 0) texture.bilinear = filter == 1;
        keys.read("repeat", texture.repeat);
        read_wrap(keys, texture);
        if (const int name = keys.read_choice("colorspace"); name >= 0)
            texture.colorspace = color_encoding_names[static_cast<size_t>(name)];
        keys.read("strict", texture.strict);
        keys.finish();
        return texture;
    }
    JsonObject keys(value, texture_checker_keys);
    const JsonValue colors = keys.at("checker");
    if (colors.array_size(2, "an array of two colors") != 2) colors.fail_expected("an array of two colors");
    const Key& color = *material_keys.find("color");
    texture.checker = {colors.item(0).color(color), colors.item(1).color(color)};
    texture.bilinear = false;
    keys.read("repeat", texture.repeat);
    read_wrap(keys, texture);
    keys.finish();
    return texture;
}

std::vector<SkyColor> read_stops(const JsonValue& value) {
    static constexpr Key angle{"degrees", KeyType::number, {0, 180}, {}, false, {}};
    std::vector<SkyColor> stops;
    const size_t count = value.array_size(1, "an array of stops [degrees, color]");
    for (size_t i = 0; i < count; ++i) {
        const JsonValue one = value.item(i);
        if (one.array_size(0, "a stop [degrees, color]") != 2) one.fail_expected("a stop [degrees, color]");
        stops.push_back({one.item(0).number(angle), one.item(1).color(*material_keys.find("color"))});
        if (i > 0 && stops[i].degrees < stops[i - 1].degrees)
            one.item(0).fail(fmt::format("{} degrees stand after {}", number_text(stops[i].degrees),
                                         number_text(stops[i - 1].degrees)),
                             "the angles of stops ascend; two of one angle are an edge");
        if (i > 1 && stops[i].degrees == stops[i - 2].degrees)
            one.item(0).fail(fmt::format("a third stop at {} degrees", number_text(stops[i].degrees)),
                             "two of one angle are an edge");
    }
    return stops;
}

/// Reads what is around: a color, a gradient, or a picture, which is the texture without a name.
void read_background(const JsonValue& value, const std::string& base_dir, SceneDescription& scene) {
    if (!value.json().is_object() || value.is_keyed()) {
        scene.background = value.color(*scene_keys.find("background"));
        return;
    }
    const bool has_file = value.json().contains("file");
    const bool has_stops = value.json().contains("stops");
    if (has_file == has_stops)
        fail_without_form(value, {"file", "rotate", "scale", "axis", "stops"},
                          "expected a color, or one of the keys 'stops' (a gradient) and 'file' (a picture)");
    SkyDescription sky;
    JsonObject keys(value, has_file ? sky_picture_keys : sky_gradient_keys);
    if (has_file) {
        TextureDescription texture;
        keys.read("file", texture.file);
        texture.file = file_beside_scene(texture.file, base_dir);
        texture.place = value.place();
        texture.wrap[1] = TextureWrap::clamp;
        keys.read("rotate", sky.rotation);
        keys.read("scale", sky.scale);
        sky.texture = scene.sky ? scene.sky->texture : static_cast<int>(scene.textures.size());
        if (!scene.sky) scene.textures.push_back(std::move(texture));
    } else {
        keys.read("axis", sky.axis);
        if (sky.axis == glm::dvec3{0}) keys.fail("axis", "expected a direction other than [0, 0, 0]");
        sky.stops = read_stops(keys.at("stops"));
    }
    keys.finish();
    scene.sky = std::move(sky);
}

MaterialDescription read_material(const JsonValue& value, const NameIndices& textures) {
    MaterialDescription material;
    JsonObject keys(value, material_keys);
    if (keys.has("texture")) material.texture = index_of_name(keys.at("texture"), textures, "texture");
    material_fields(material, [&](std::string_view key, auto& field) { keys.read(key, field); });
    keys.finish();
    if (const std::string fault = shares_fault(material); !fault.empty()) value.fail(fault);
    return material;
}

LightDescription read_light(const JsonValue& value) {
    LightDescription light;
    JsonObject keys(value, light_keys);
    keys.read("position", light.position);
    light_fields(light, [&](std::string_view key, auto& field) { keys.read(key, field); });
    light.falloff = keys.read_choice("falloff") == 1;
    read_light_group(keys, light.group);
    keys.finish();
    if (const std::string fault = falloff_fault(light.falloff, light.radius); !fault.empty())
        keys.fail("falloff", fault);
    light.place = value.place();
    return light;
}

FrameOfReference read_frame(const JsonValue& value) {
    FrameOfReference frame;
    JsonObject keys(value, frame_keys);
    keys.read("center", frame.center);
    keys.read("scale", frame.scale);
    keys.read("bound", frame.bound);
    keys.finish();
    return frame;
}

/// Two objects of one name could not be told apart in mattes.
void require_different_names(const std::vector<ObjectDescription>& objects, const JsonValue& list) {
    std::unordered_map<std::string_view, size_t> first;
    for (size_t i = 0; i < objects.size(); ++i) {
        if (objects[i].name.empty()) continue;
        const auto [other, is_new] = first.try_emplace(objects[i].name, i);
        if (is_new) continue;
        const JsonValue value = list.item(i);
        value.fail_at(value.place_of("name"),
                      fmt::format("{} is the name of /objects/{} too", quoted(objects[i].name), other->second),
                      "give each its own");
    }
}

/// Calls read(name, value) for every member of an object whose keys are names, except its comment.
template <class Read>
void for_each_name(const JsonValue& value, const std::string& kind, Read read) {
    if (!value.json().is_object()) value.fail_expected(fmt::format("an object of {}s by name", kind));
    value.check_comment();
    for (const auto& member : value.json().items()) {
        if (member.key() == comment_key) continue;
        if (member.key().empty()) value.fail_at(value.place_of(""), fmt::format("a {}'s name is not empty", kind));
        read(member.key(), value.member(member.key(), member.value()));
    }
}

}  // namespace

void read_light_group(JsonObject& keys, std::string& group) {
    if (!keys.has("group")) return;
    keys.read("group", group);
    if (const std::string fault = fault_of_light_group(group); !fault.empty())
        keys.fail("group", fmt::format("the name {} {}", quoted(std::string_view(group)), fault));
}

std::string file_beside_scene(const std::string& file, const std::string& base_dir) {
    if (base_dir.empty()) return file;
    return (std::filesystem::path(base_dir) / file).string();  // an absolute file replaces the folder
}

int index_of_name(const JsonValue& value, const NameIndices& indices, const std::string& kind) {
    if (!value.json().is_string()) value.fail_expected(fmt::format("the name of a {}", kind));
    const std::string& name = value.json().get_ref<const std::string&>();
    const auto found = indices.find(name);
    if (found != indices.end()) return found->second;
    std::vector<std::string_view> known(indices.size());
    for (const auto& [other, index] : indices) known[static_cast<size_t>(index)] = other;
    value.fail(fmt::format("unknown {} {}", kind, found_text(value.json())), suggestion(name, known, kind + "s"));
}

namespace {

/// Calls read(); whether it read keys. If it did, its error names their frame.
template <class Read>
bool reads_keys(KeyClock& clock, const Read& read) {
    const size_t before = clock.keys.size();
    try {
        read();
    } catch (const Error& error) {
        if (clock.keys.size() == before) throw;
        throw error.at("frame " + number_text(clock.frame));
    }
    return clock.keys.size() > before;
}

/// A scene file, and which parts of it keys change.
struct JsonScene {
    Json json;
    std::string label, base_dir;
    NameIndices textures = {}, materials = {};
    std::vector<std::pair<std::string, size_t>> moving_materials = {};
    std::vector<size_t> moving_objects = {}, moving_lights = {};

    JsonValue part(const char* name, KeyClock& clock) const {
        return JsonValue(json, label).over_time(clock).member(name);
    }
    CameraDescription camera(KeyClock& clock) const {
        CameraDescription camera;
        reads_keys(clock, [&] { camera = read_camera(part("camera", clock)); });
        camera.place = label + (clock.keys.empty() ? ": /camera/path" : ": /camera");
        return camera;
    }
    void read_around(SceneDescription& scene, KeyClock& clock) const {
        if (json.contains("ambient")) scene.ambient = part("ambient", clock).color(*scene_keys.find("ambient"));
        if (json.contains("background")) read_background(part("background", clock), base_dir, scene);
    }
    MaterialDescription material(const std::string& name, const JsonValue& value) const {
        MaterialDescription material = read_material(value, textures);
        material.name = name;
        return material;
    }

    /// Gives what changes the values of a frame.
    void set(SceneDescription& scene, int frame) const {
        KeyClock clock{static_cast<double>(frame)};
        reads_keys(clock, [&] {
            read_around(scene, clock);
            for (const auto& [name, index] : moving_materials)
                scene.materials[index] = material(name, part("materials", clock).member(name));
            for (const size_t i : moving_objects) {
                ObjectDescription object =
                    read_json_object(part("objects", clock).item(i), {scene, materials, base_dir});
                if (auto* mesh = std::get_if<MeshObject>(&object.shape)) {  // from a program's array, if it was
                    const auto& given = std::get<MeshObject>(scene.objects[i].shape);
                    mesh->data = given.data;
                    mesh->file = given.file;
                }
                scene.objects[i] = std::move(object);
            }
            for (const size_t i : moving_lights) scene.lights[i] = read_light(part("lights", clock).item(i));
        });
        scene.shown = frame;
    }
};

/// The frames at keys, or before and after those that lie between two.
std::vector<int> frames_around(const std::vector<double>& keys) {
    std::vector<int> frames;
    for (const double key : keys) {
        frames.push_back(static_cast<int>(std::floor(key)));
        frames.push_back(static_cast<int>(std::ceil(key)));
    }
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    return frames;
}

/// Reads the objects and the lights.
void read_bodies(JsonObject& keys, JsonScene& file, SceneDescription& scene, KeyClock& clock) {
    const JsonValue objects = keys.at("objects").over_time(clock);
    const ObjectContext context{scene, file.materials, file.base_dir};
    const size_t object_count = objects.array_size(0, "an array of objects");
    for (size_t i = 0; i < object_count; ++i)
        if (reads_keys(clock, [&] { scene.objects.push_back(read_json_object(objects.item(i), context)); }))
            file.moving_objects.push_back(i);
    require_different_names(scene.objects, objects);
    if (!keys.has("lights")) return;
    const JsonValue lights = keys.at("lights").over_time(clock);
    const size_t light_count = lights.array_size(0, "an array of lights");
    for (size_t i = 0; i < light_count; ++i)
        if (reads_keys(clock, [&] { scene.lights.push_back(read_light(lights.item(i))); }))
            file.moving_lights.push_back(i);
}

}  // namespace

SceneDescription read_json_scene(const std::string& text, const std::string& label, const std::string& base_dir) {
    const auto file = std::make_shared<JsonScene>(JsonScene{parse_json(text, label), label, base_dir});
    const JsonValue value(file->json, file->label);
    KeyClock clock;
    SceneDescription scene;
    JsonObject keys(value, scene_keys);
    std::string schema;
    keys.read("$schema", schema);
    keys.read("depth", scene.depth);
    keys.read("cutoff", scene.cutoff);
    keys.read("contact", scene.contact);
    if (keys.has("film")) scene.film = read_film(keys.at("film"));
    if (keys.has("camera")) {
        KeyClock of_camera;
        scene.camera = file->camera(of_camera);
        scene.warnings = std::move(of_camera.held);
        if (!of_camera.keys.empty())
            scene.camera.at = [file](double frame) {
                KeyClock at{frame};
                return file->camera(at);
            };
    }
    if (keys.has("frame")) scene.frame = read_frame(keys.at("frame"));
    if (keys.has("textures"))
        for_each_name(keys.at("textures"), "texture", [&](const std::string& name, const JsonValue& texture) {
            file->textures[name] = static_cast<int>(scene.textures.size());
            scene.textures.push_back(read_texture(texture, base_dir));
            scene.textures.back().name = name;
        });
    const bool has_ambient = keys.has("ambient");
    if (keys.has("background") || has_ambient) reads_keys(clock, [&] { file->read_around(scene, clock); });
    if (keys.has("materials"))
        for_each_name(keys.at("materials").over_time(clock), "material",
                      [&](const std::string& name, const JsonValue& material) {
                          const size_t index = scene.materials.size();
                          file->materials[name] = static_cast<int>(index);
                          if (reads_keys(clock, [&] { scene.materials.push_back(file->material(name, material)); }))
                              file->moving_materials.emplace_back(name, index);
                      });
    read_bodies(keys, *file, scene, clock);
    keys.finish();
    scene.warnings.insert(scene.warnings.end(), clock.held.begin(), clock.held.end());
    if (!clock.keys.empty())
        scene.motion = std::make_shared<const Motion>(
            Motion{frames_around(clock.keys), file->moving_objects, file->moving_lights,
                   [file](SceneDescription& changed, int frame) { file->set(changed, frame); }});
    return scene;
}

}  // namespace cistula
