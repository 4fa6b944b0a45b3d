// The reader, docs/scene.schema.json and docs/scene.md know the same keys, with the same types, ranges and defaults.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>
#include <sstream>

#include "scene/readers/json_reader.h"
#include "scene/readers/read_scene.h"
#include "scene/readers/scene_formats.h"
#include "scene/readers/scene_keys.h"
#include "testing/support/scene_dump.h"
#include "testing/support/schema_keys.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

std::string page() {
    return bytes_of((source_root() / "docs/scene.md").string());
}

Json schema() {
    const std::string path = (source_root() / "docs/scene.schema.json").string();
    return parse_json(bytes_of(path), path);
}

std::string text_of(std::string_view view) {
    return std::string(view);
}

/// Cells of the page's table of keys: key, type, unit, default, range, meaning.
std::vector<std::vector<std::string>> page_rows(const std::string& markdown, const std::string& table) {
    const std::string mark = "<!-- keys: " + table + " -->\n";
    const size_t start = markdown.find(mark);
    if (start == std::string::npos) return {};
    std::istringstream lines(markdown.substr(start + mark.size()));
    std::vector<std::vector<std::string>> rows;
    std::string line;
    for (int number = 0; std::getline(lines, line) && line.starts_with("|"); ++number) {
        if (number < 2) continue;  // head and rule
        std::vector<std::string> cells;
        std::istringstream parts(line.substr(1));
        for (std::string cell; std::getline(parts, cell, '|');) {
            const size_t first = cell.find_first_not_of(' ');
            cells.push_back(first == std::string::npos ? ""
                                                       : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
        }
        rows.push_back(cells);
    }
    return rows;
}

TEST(ScenePage, HasEveryKeyWithItsDefaultAndRange) {
    const std::string markdown = page();
    const std::map<KeyType, std::string> types = {{KeyType::whole, "whole number"}, {KeyType::number, "number"},
                                                  {KeyType::boolean, "boolean"},    {KeyType::text, "string"},
                                                  {KeyType::choice, "string"},      {KeyType::color, "color"},
                                                  {KeyType::point, "point"},        {KeyType::pair, "pair"}};
    for (const KeyTable* table : all_key_tables()) {
        const auto rows = page_rows(markdown, text_of(table->name));
        ASSERT_EQ(rows.size(), table->keys.size()) << table->name;
        for (size_t i = 0; i < rows.size(); ++i) {
            const Key& key = table->keys[i];
            SCOPED_TRACE(text_of(table->name) + "." + text_of(key.name));
            ASSERT_EQ(rows[i].size(), 6u);
            EXPECT_EQ(rows[i][0], "`" + text_of(key.name) + "`");
            if (key.type != KeyType::other) {
                EXPECT_EQ(rows[i][1], types.at(key.type));
            }
            const std::string fallback = key.fallback.empty() ? "" : "`" + text_of(key.fallback) + "`";
            EXPECT_EQ(rows[i][3], key.required ? "required" : fallback);
            std::string range;
            for (const std::string_view choice : key.choices)
                range += (range.empty() ? "`" : ", `") + text_of(choice) + "`";
            const bool numbers = key.type != KeyType::boolean && key.type != KeyType::text &&
                                 key.type != KeyType::choice && key.type != KeyType::other;
            EXPECT_EQ(rows[i][4], numbers ? range_text(key.range) : range);
            EXPECT_GT(rows[i][5].size(), 10u) << "a key is explained";
        }
    }
}

TEST(ScenePage, ExampleIsValidAndUsesEveryKey) {
    const std::string markdown = page();
    const std::string fence = "```json\n";
    const size_t start = markdown.find(fence) + fence.size();
    const std::string example = markdown.substr(start, markdown.find("```", start) - start);
    const SceneDescription scene = read_scene_text(example, "docs/scene.md", "");
    EXPECT_EQ(scene.objects.size(), 10u);
    std::set<std::string> used;
    const std::function<void(const Json&)> collect = [&](const Json& json) {
        for (const auto& item : json.items()) {
            if (json.is_object()) used.insert(item.key());
            if (item.value().is_structured()) collect(item.value());
        }
    };
    collect(parse_json(example, "docs/scene.md"));
    for (const KeyTable* table : all_key_tables())
        for (const Key& key : table->keys) EXPECT_TRUE(used.count(text_of(key.name))) << key.name;
}

TEST(SceneSchema, HasEveryKeyWithItsTypeDefaultAndRange) {
    const Json root = schema();
    const Json& definitions = root.at("$defs");
    for (const KeyTable* table : all_key_tables())
        test::expect_keys(*table, table == &scene_keys ? root : definitions.at(text_of(table->name)), definitions);
}

TEST(SceneSchema, ListsOfNamesHaveComments) {
    const Json root = schema();
    for (const char* list : {"textures", "materials"})
        EXPECT_EQ(root.at("properties").at(list).at("properties").at(comment_key).at("$ref"), "#/$defs/comment");
    const Json& forms = root.at("$defs").at("comment").at("oneOf");
    EXPECT_EQ(forms.at(0).at("type"), "string");
    EXPECT_EQ(forms.at(1).at("items").at("type"), "string");
}

/// {"key": default, ...} of a table, after `given`.
std::string spelled_out(const KeyTable& table, const std::string& given) {
    std::string text = "{" + given;
    for (const Key& key : table.keys)
        if (!key.fallback.empty())
            text += (text == "{" ? "\"" : ", \"") + text_of(key.name) + "\": " + text_of(key.fallback);
    return text + "}";
}

TEST(SceneDefaults, AreThoseOfTheTables) {
    const auto scene = [](bool spelled) {
        const auto object = [&](const KeyTable& table, const std::string& given) {
            return spelled ? spelled_out(table, given) : "{" + given + "}";
        };
        const std::string path = "\"path\": {\"position\": " + object(cylindrical_keys, "") + "}";
        const std::string edges = "\"edge_lights\": " + object(edge_lights_keys, "\"count\": 3");
        const std::string given = "\"film\": " + object(film_keys, "") + ", \"camera\": " + object(camera_keys, "") +
                                  ", \"textures\": {\"f\": " + object(texture_file_keys, "\"file\": \"a\"") +
                                  ", \"c\": " + object(texture_checker_keys, "\"checker\": [0, 1]") +
                                  "}, \"materials\": {\"m\": " + object(material_keys, "") + "}, \"objects\": [" +
                                  object(solid_keys, "\"solid\": \"cube\", \"material\": \"m\", " + edges) + ", " +
                                  object(sphere_keys, R"("solid": "sphere", "material": "m")") + ", " +
                                  R"({"material": "m", "disk": )" + object(disk_shape_keys, "") + "}, " +
                                  object(box_keys, R"("solid": "box", "size": [1, 2, 3], "material": "m")") + ", " +
                                  object(convex_keys, R"("solid": "convex", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0],
                                                         [0, 0, 1]], "material": "m")") +
                                  ", " + object(prism_keys, R"("solid": "prism", "sides": 5, "material": "m")") + ", " +
                                  object(mesh_keys, "\"mesh\": \"a\"") + "], \"lights\": [" +
                                  object(light_keys, "\"position\": [0, 0, 1]") + "]";
        const std::string moving = "{\"objects\": [], \"camera\": {" + path + "}}";
        return SceneDump::of(read_scene_text(object(scene_keys, given), "a.json", "")) +
               SceneDump::of(read_scene_text(moving, "a.json", ""));
    };
    EXPECT_EQ(scene(true), scene(false));
}

/// Every scene in JSON that comes with Cistula, the hard ones among them.
std::vector<std::string> scene_files() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_root() / "scenes"))
        if (entry.path().extension() == ".json") files.push_back(entry.path().string());
    return files;
}

TEST(Scenes, BenchmarkIsWhatItsFiguresWereMeasuredOn) {
    const SceneDescription scene = read_scene((source_root() / "scenes/benchmark.json").string());
    const SceneDescription seed = read_scene_text(text_input_template(), "template", "");
    EXPECT_EQ(scene.film.width, 640);
    EXPECT_EQ(scene.film.height, 480);
    EXPECT_EQ(scene.film.supersample, 1);
    EXPECT_EQ(scene.film.frames, 1);
    EXPECT_EQ(scene.depth, 4);
    EXPECT_EQ(scene.camera.field_of_view, 120);
    ASSERT_EQ(scene.objects.size(), 4u);
    for (size_t i = 0; i < 3; ++i) {
        const auto& solid = std::get<SolidObject>(scene.objects[i].shape);
        const auto& from = std::get<SolidObject>(seed.objects[i].shape);
        EXPECT_EQ(solid.solid, from.solid);
        EXPECT_EQ(solid.center, from.center);
        EXPECT_EQ(solid.radius, from.radius);
        EXPECT_EQ(solid.edge_lights.count, 0);
        const MaterialDescription& m = scene.materials.at(static_cast<size_t>(scene.objects[i].material));
        EXPECT_EQ(m.color, seed.materials.at(i).color);
        EXPECT_EQ((std::vector{m.index, m.reflection, m.transmission}), (std::vector{1.0, 0.1, 0.6}));
    }
    for (const MaterialDescription& m : scene.materials) {
        EXPECT_EQ((std::vector{m.diffuse, m.specular, m.exponent}), (std::vector{0.8, 0.4, 50.0}));
        EXPECT_EQ(m.specular_color, glm::dvec3(1));
        EXPECT_EQ(m.ambient * scene.ambient, glm::dvec3(0.1));
    }
    const MaterialDescription& floor = scene.materials.at(static_cast<size_t>(scene.objects[3].material));
    EXPECT_EQ(floor.reflection, 0.2);
    const TextureDescription& checker = scene.textures.at(static_cast<size_t>(floor.texture));
    EXPECT_EQ(checker.checker[0], glm::dvec3(0.8));
    EXPECT_EQ(checker.checker[1], glm::dvec3(0.3, 0.3, 0.35));
    EXPECT_EQ(checker.repeat, glm::dvec2(5));
    ASSERT_EQ(scene.lights.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(scene.lights[i].position, seed.lights[i].position);
        EXPECT_EQ(scene.lights[i].color, glm::dvec3(1));
        EXPECT_EQ(scene.lights[i].radius, 0);
    }
}

TEST(Scenes, AllAreValid) {
    const std::vector<std::string> files = scene_files();
    for (const std::string& file : files) EXPECT_NO_THROW(read_scene(file)) << file;
    EXPECT_GE(files.size(), 24u);
}

TEST(Scenes, AnyJsonReaderTakesThem) {
    for (const std::string& file : scene_files()) EXPECT_TRUE(Json::accept(bytes_of(file))) << file;
    EXPECT_FALSE(Json::accept("{} // a comment"));
}

/// Without its comments, however deep.
Json without_comments(Json json) {
    if (json.is_object()) json.erase(std::string(comment_key));
    if (json.is_structured())
        for (Json& value : json) value = without_comments(value);
    return json;
}

TEST(Scenes, CommentsMeanNothing) {
    for (const std::string& file : scene_files()) {
        const Json json = Json::parse(bytes_of(file));
        const std::string folder = std::filesystem::path(file).parent_path().string();
        const std::string bare = without_comments(json).dump();
        EXPECT_NE(bare, json.dump()) << file;
        EXPECT_EQ(SceneDump::of(read_scene_text(bare, "a.json", folder)),
                  SceneDump::of(read_scene_text(json.dump(), "a.json", folder)))
            << file;
    }
}

TEST(SceneReader, RefusesToForgetAKeyOfItsTable) {
    const Json json = Json::parse("{\"width\": 1}");
    JsonObject keys(JsonValue(json, "a"), film_keys);
    int value = 0;
    keys.read("width", value);
    keys.read("height", value);
    keys.read("frames", value);
    EXPECT_THROW(keys.finish(), std::logic_error);
    keys.read("supersample", value);
    std::string text;
    keys.read("owner", text);
    keys.read("comments", text);
    EXPECT_THROW(keys.finish(), std::logic_error);
    EXPECT_FALSE(keys.has("frames_per_second"));
    EXPECT_NO_THROW(keys.finish());
    EXPECT_THROW(keys.has("quality"), std::logic_error);
}

}  // namespace
}  // namespace cistula
