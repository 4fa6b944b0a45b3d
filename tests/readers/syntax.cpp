// Texts that are no proper scene files: syntax, duplicate keys, mangled ones; and the suggestions in messages.
#include <gtest/gtest.h>

#include <random>

#include "base/suggest.h"
#include "scene/compile/compiled_scene.h"
#include "scene/readers/read_scene.h"
#include "scene/readers/scene_formats.h"
#include "testing/support/read_text.h"
#include "testing/support/scene_dump.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using test::json_scene;
using test::scene_with;

TEST(SceneSyntax, ErrorsHaveLineAndColumn) {
    EXPECT_WRONG(json_scene("{\n  \"depth\": 4,\n  depth: 4\n}"),
                 "a.json:3:3: syntax error while parsing object key - invalid literal; last read: '4,<U+000A>  d'; "
                 "expected string literal");
    EXPECT_WRONG(json_scene("{\"objects\": [],}"),
                 "a.json:1:16: syntax error while parsing object key - unexpected '}'; expected string literal");
    EXPECT_WRONG(json_scene("{\"objects\": []\n"),
                 "a.json:2:1: syntax error while parsing object - unexpected end of input; expected '}'");
    EXPECT_WRONG(json_scene("{\"objects\": []} x"),
                 "a.json:1:17: syntax error while parsing value - invalid literal; last read: '\"objects\": []} x'; "
                 "expected end of input");
    EXPECT_WRONG(json_scene("{\"objects\": [\n1e999]}"), "a.json:2:5: number overflow parsing '1e999'");
    EXPECT_WRONG(scene_with("\"depth\": NaN"),
                 "a.json:1:26: syntax error while parsing value - invalid literal; last read: '\"depth\": N'");
}

TEST(SceneSyntax, NulBytesAreRefusedWhereverTheyStand) {
    const std::string nul(1, '\0');
    EXPECT_WRONG(json_scene("{\"objects\": []}\n" + nul), "a.json:2:1: a NUL byte, which JSON does not have");
    EXPECT_WRONG(json_scene("{\"objects\": []}" + nul + " {{"), "a.json:1:16: a NUL byte, which JSON does not have");
    EXPECT_WRONG(json_scene("{\"objects\": [] // one " + nul + "\n}"),
                 "a.json:1:23: a NUL byte, which JSON does not have");
    EXPECT_WRONG(json_scene("{\"objects\": [], \"$comment\": \"" + nul + "\"}"),
                 "a.json:1:30: a NUL byte, which JSON does not have");
}

TEST(SceneSyntax, MoreThanMemoryHoldsIsRefusedWithItsPlace) {
    const auto repeated = [](const std::string& what, int times) {
        std::string text;
        for (int i = 0; i < times; ++i) text += what + ",";
        return text + what;
    };
    const std::string end =
        ": more than 4 million keys, strings, arrays and objects up to here, which no scene may have; put large meshes "
        "into files of their own, PLY or OBJ";
    EXPECT_WRONG(scene_with("\"$comment\": [" + repeated("\"\"", 4'000'000) + "]"), "a.json: /$comment/3999995" + end);
    EXPECT_WRONG(scene_with("\"depth\": [" + repeated("[]", 4'000'000) + "]"), "a.json: /depth/3999995" + end);
    EXPECT_WRONG(scene_with("\"depth\": [" + repeated("{\"a\":{}}", 1'400'000) + "]"),
                 "a.json: /depth/1333331/a" + end);
    EXPECT_WRONG(scene_with("\"depth\": [" + repeated("0", 4'000'000) + "]"),
                 "a.json: /depth: expected a whole number from 1 to 1024, found an array of 4000001");
}

TEST(SceneSyntax, LongTokensAreCut) {
    try {
        json_scene("{\"" + std::string(100000, 'x'));
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_LT(std::string(error.what()).size(), 200u);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

TEST(SceneSyntax, DuplicateKeysAreErrors) {
    EXPECT_WRONG(scene_with("\"depth\": 1, \"depth\": 2"), "a.json: /depth: duplicate key; give it once");
    EXPECT_WRONG(scene_with("\"film\": {\"width\": 1, \"height\": 1, \"width\": 1}"),
                 "a.json: /film/width: duplicate key; give it once");
    EXPECT_WRONG(json_scene("{\"objects\": [{}, {\"a\": 1, \"a\": 1}]}"),
                 "a.json: /objects/1/a: duplicate key; give it once");
}

TEST(SceneSyntax, CommentsAreAllowed) {
    EXPECT_EQ(json_scene("{ // one\n /* two\n */ \"objects\": [] /* three */ } // four").depth, 4);
}

TEST(SceneSyntax, AnyObjectMayHoldAComment) {
    // %: where a comment may stand.
    const std::string text = R"({%
        "film": {%"width": 8}, "camera": {%"path": {%"position": {%"r0": 4}, "target": {%"z0": 1}}},
        "textures": {%"f": {%"file": "f.exr"}, "c": {%"checker": [0, 1]}},
        "materials": {%"m": {%"color": 1}},
        "objects": [
            {%"solid": "cube", "material": "m", "edge_lights": {%"count": 2}},
            {%"quad": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "material": "m"},
            {%"triangles": {%"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "indices": [[0, 1, 2]]}, "material": "m"},
            {%"mesh": "a.ply"}
        ],
        "lights": [{%"position": [0, 0, 9]}], "frame": {%"center": [0, 0, 0], "scale": 1}})";
    const auto dump_with = [&](const std::string& comment) {
        std::string scene;
        for (const char c : text) scene += c == '%' ? comment : std::string(1, c);
        return SceneDump::of(json_scene(scene));
    };
    const std::string bare = dump_with("");
    EXPECT_EQ(dump_with("\"$comment\": \"one line\", "), bare);
    EXPECT_EQ(dump_with("\"$comment\": [\"two\", \"lines\"], "), bare);
    EXPECT_WRONG(scene_with("\"$comment\": 3"), "a.json: /$comment: expected a string or an array of strings, found 3");
    EXPECT_WRONG(scene_with("\"materials\": {\"$comment\": {}}"),
                 "a.json: /materials/$comment: expected a string or an array of strings, found an empty object");
    EXPECT_WRONG(scene_with("\"film\": {\"$comment\": [\"a\", 1]}"),
                 "a.json: /film/$comment: expected a string or an array of strings, found an array of 2");
    EXPECT_WRONG(scene_with("\"$comment\": \"a\", \"$comment\": \"b\""),
                 "a.json: /$comment: duplicate key; give it once");
}

TEST(SceneSyntax, CommentsLeaveTheHash) {
    const std::string scene = R"("objects": [{"solid": "cube", "material": "m"}], "materials": {"m": {}}})";
    EXPECT_EQ(compile_scene<float>(json_scene("{\"$comment\": \"a cube\", " + scene))->hashes.of(0),
              compile_scene<float>(json_scene("{" + scene))->hashes.of(0));
}

TEST(SceneSyntax, DeepNestingIsRefusedWithItsPlace) {
    const std::string deep = std::string(200000, '[') + std::string(200000, ']');
    std::string places;
    for (int i = 0; i < 63; ++i) places += "/0";
    EXPECT_WRONG(scene_with("\"depth\": " + deep),
                 "a.json: /depth" + places + ": more than 64 levels deep; a scene has 6 at most");
    EXPECT_WRONG(scene_with("\"depth\": [[3]]"),
                 "a.json: /depth: expected a whole number from 1 to 1024, found an array of 1");
}

TEST(SceneSyntax, MangledTextsAreReadOrRefusedOnOneLine) {
    std::mt19937_64 random(1);
    const auto below = [&](size_t n) { return static_cast<size_t>(random() % n); };
    const std::string alphabet = "{}[],:\"/*\\\n 0123456789.eE+-abcxyz\x01\x80\xff";
    for (const std::string& whole :
         {bytes_of((source_root() / "scenes/benchmark.json").string()), text_input_template()}) {
        int refused = 0;
        constexpr int rounds = 3000;
        for (int round = 0; round < rounds; ++round) {
            std::string text = whole;
            for (size_t i = 1 + below(3); i > 0; --i) {
                const size_t at = below(text.size());
                const size_t length = std::min(below(8), text.size() - at);
                if (below(2) == 0)
                    text.erase(at, length);
                else if (below(2) == 0)
                    text.insert(at, text.substr(below(text.size()), length));
                else
                    text[at] = alphabet[below(alphabet.size())];
            }
            try {
                json_scene(text);
            } catch (const Error& error) {
                const std::string message = error.what();
                EXPECT_EQ(error.kind(), ErrorKind::scene);
                EXPECT_TRUE(message.starts_with("a.json:")) << message;
                EXPECT_LT(message.size(), 1000u) << message;
                for (const char c : message) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << message;
                ++refused;
            }
        }
        EXPECT_GT(refused, rounds / 4);
    }
}

TEST(Suggest, EditDistance) {
    EXPECT_EQ(edit_distance("", ""), 0u);
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("color", "colour"), 1u);
    EXPECT_EQ(edit_distance("widht", "width"), 1u);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Suggest, NamesInAnotherCaseOrWithoutTheirEndAreNear) {
    const std::vector<std::string_view> known = {"srgb", "linear", "lin_ap0_scene", "lin_ap1_scene"};
    const auto suggested = [&](std::string_view name) { return suggestion(name, known, "values"); };
    EXPECT_EQ(suggested("sRGB"), "did you mean 'srgb'?");
    EXPECT_EQ(suggested("LIN_AP1_SCENE"), "did you mean 'lin_ap1_scene'?");
    EXPECT_EQ(suggested("lin_ap1"), "did you mean 'lin_ap1_scene'?");
    EXPECT_EQ(suggested("linaer"), "did you mean 'linear'?");
    for (const char* far : {"", "s", "ap1", "acescg"})
        EXPECT_EQ(suggested(far), "known values: srgb, linear, lin_ap0_scene, lin_ap1_scene") << far;
}

TEST(Suggest, WhatOtherProgramsCallAThingIsThatThingFirst) {
    const std::vector<std::string_view> options = {"--tile", "--res", "--depth", "--target-error", "--supersample"};
    const std::pair<const char*, const char*> of_options[] = {
        {"--size", "--res"},        {"--width", "--res"},
        {"--spp", "--supersample"}, {"--samples", "--supersample"},
        {"--max-depth", "--depth"}, {"--max_depth", "--depth"}};
    for (const auto& [other, ours] : of_options)
        EXPECT_EQ(suggestion(other, options, "options"), "did you mean '" + std::string(ours) + "'?");
    const std::vector<std::string_view> keys = {"position", "target", "exponent",
                                                "index",    "color",  "frames_per_second"};
    const std::pair<const char*, const char*> of_keys[] = {{"ior", "index"},       {"shininess", "exponent"},
                                                           {"intensity", "color"}, {"lookat", "target"},
                                                           {"lookAt", "target"},   {"fps", "frames_per_second"}};
    for (const auto& [other, ours] : of_keys)
        EXPECT_EQ(suggestion(other, keys, "keys"), "did you mean '" + std::string(ours) + "'?");
    EXPECT_EQ(nearest_first("normal", {"diffuse", "N", "Z"}, "layers").rfind("the layers are: N, ", 0), 0u);
    EXPECT_EQ(nearest_first("depth", {"depth_ray", "N", "Z"}, "layers").rfind("the layers are: Z, depth_ray", 0), 0u);
    EXPECT_EQ(scene_key_of_option("--fps"), "frames_per_second");
    EXPECT_EQ(scene_key_of_option("--normal"), "");
}

TEST(Suggest, HugeNamesAndManyNamesStayShort) {
    std::vector<std::string> names;
    for (int i = 0; i < 100; ++i) names.push_back("material_number_" + std::to_string(i));
    const std::string text = suggestion(std::string(1000000, 'x'), {names.begin(), names.end()}, "materials");
    EXPECT_LT(text.size(), 400u);
    EXPECT_TRUE(text.ends_with(", ..."));
    EXPECT_TRUE(nearest_first(std::string(1000000, 'x'), {names.begin(), names.end()}, "materials")
                    .ends_with(", ... (100 in all)"));
}

TEST(Suggest, AllThatExistAreNamedThoseMostLikeItFirst) {
    EXPECT_EQ(nearest_first("depht", {"RGB", "depth_ray", "depth", "Z"}, "layers"),
              "the layers are: depth, depth_ray, RGB, Z");
    EXPECT_EQ(nearest_first("rgb", {"N", "RGB"}, "layers"), "the layers are: RGB, N");
    EXPECT_EQ(nearest_first("x", {"a\nb"}, "layers"), "the layers are: a\\nb");
    EXPECT_EQ(nearest_first("x", {}, "layers"), "there are no layers");
}

}  // namespace
}  // namespace cistula
