// suite.json: what is read of it, what is wrong with it and where, its schema, and changes to its text.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <stdexcept>

#include "apps/common/command_line.h"
#include "compare/suite/json_edit.h"
#include "compare/suite/suite.h"
#include "compare/suite/suite_keys.h"
#include "image/color/color_space.h"
#include "scene/readers/json_reader.h"
#include "sequence/frame_list.h"
#include "testing/support/schema_keys.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

const std::string source_tree = CISTULA_SOURCE_DIR;

class SuiteFile : public ::testing::Test {
  protected:
    Suite read(const std::string& text) const {
        put_bytes(folder_.file("suite.json"), text);
        return read_suite(folder_.file(""));
    }
    SuiteCase read_case(const std::string& keys) const {
        return read(R"({"cases": [{"name": "a", "scene": "s.json", )" + keys + "}]}").cases.at(0);
    }
    /// The message, after the file's name.
    std::string refusal(const std::string& text, ExitCode code = ExitCode::usage) const {
        try {
            read(text);
        } catch (const Error& error) {
            EXPECT_EQ(exit_code(error.kind()), code);
            const std::string message = error.what(), file = folder_.file("suite.json") + ":";
            EXPECT_EQ(message.rfind(file, 0), 0u) << message;
            return message.substr(std::min(message.size(), file.size()));
        }
        ADD_FAILURE() << "no error from " << text;
        return "";
    }
    void expect_refused_case(const std::string& keys, const std::string& message) const {
        EXPECT_EQ(refusal(R"({"cases": [{"name": "a", "scene": "s.json")" + (keys.empty() ? "" : ", " + keys) + "}]}"),
                  message)
            << keys;
    }

    const ScratchDirectory folder_;
};

TEST_F(SuiteFile, HasTheOptionsOfRender) {
    const SuiteCase one = read_case(
        R"("frames": "4-8x2", "golden": "g/a.####.exr", "resolution": [64, 48], "crop": [8, 6, 2, 1], "supersample": 3,
           "depth": 7, "cutoff": 0.5, "precision": "double", "layers": "N,Z", "bits": "half",
           "background": "transparent", "colorspace": "lin_ap1_scene", "z_far": 100,
           "thresholds": {"fail": 0.25, "failpercent": 2, "hardfail": 1, "allow_nonfinite": true}, "backends": ["cuda", "embree"],
           "tags": ["smoke", "glass/2"])");
    EXPECT_EQ(one.name, "a");
    EXPECT_EQ(one.frames, (std::vector<int>{4, 6, 8}));
    EXPECT_EQ(one.golden_path("d", 6), "d/g/a.0006.exr");
    EXPECT_EQ(one.scene_path("d"), "d/s.json");
    EXPECT_EQ(one.frame.full_width, 64);
    EXPECT_EQ(one.frame.full_height, 48);
    EXPECT_EQ(one.frame.crop, (PixelRect{2, 1, 8, 6}));
    EXPECT_EQ(one.frame.supersample, 3);
    EXPECT_EQ(one.frame.depth, 7);
    EXPECT_EQ(one.frame.cutoff, 0.5);
    EXPECT_EQ(one.precision, Precision::double_);
    EXPECT_TRUE(one.channels.normal && one.channels.z && one.channels.half && one.channels.transparent);
    EXPECT_EQ(one.channels.space->id, "lin_ap1_scene");
    EXPECT_EQ(one.channels.z_far, 100);
    EXPECT_EQ(one.thresholds.fail, 0.25);
    EXPECT_EQ(one.thresholds.failpercent, 2);
    EXPECT_EQ(one.thresholds.hardfail, 1);
    EXPECT_TRUE(one.thresholds.allow_nonfinite);
    EXPECT_EQ(one.backends, (std::vector{Backend::cuda, Backend::embree}));
    EXPECT_EQ(one.tags, (std::vector<std::string>{"smoke", "glass/2"}));
    const SuiteCase adaptive = read_case(R"("target_error": 0.02, "max_samples": 64, "z_far": "inf")");
    EXPECT_EQ(adaptive.frame.target_error, 0.02);
    EXPECT_EQ(adaptive.frame.max_samples, 64);
    EXPECT_TRUE(std::isinf(adaptive.channels.z_far));
}

TEST_F(SuiteFile, LeavesTheRestToTheScene) {
    const SuiteCase one = read_case(R"("golden": "a.exr")");
    EXPECT_EQ(one.frames, std::vector<int>{0});
    for (const RequestKey& key : request_keys())
        EXPECT_EQ(key.given(one), key.name == "scene" || key.name == "frames") << key.name;
    EXPECT_FALSE(one.thresholds.any());
    EXPECT_EQ(one.backends, std::vector{Backend::embree});
}

TEST_F(SuiteFile, CasesOverrideDefaults) {
    const Suite suite = read(R"({
        "$schema": "../suite.schema.json", "$comment": "of films",  // comments are taken
        "defaults": {"scene": "a.json", "supersample": 2, "bits": "half", "layers": "Z", "tags": ["x"]},
        "cases": [{"name": "1"}, {"name": "2", "scene": "b.json", "layers": "N", "tags": []},
                  {"name": "3", "target_error": 0.1}]})");
    EXPECT_EQ(suite.cases[0].scene, "a.json");
    EXPECT_TRUE(suite.cases[0].channels.z);
    EXPECT_EQ(suite.cases[0].tags.size(), 1u);
    EXPECT_EQ(suite.cases[1].scene, "b.json");
    EXPECT_TRUE(suite.cases[1].channels.normal && suite.cases[1].channels.half && !suite.cases[1].channels.z);
    EXPECT_TRUE(suite.cases[1].tags.empty());
    EXPECT_EQ(suite.cases[1].frame.supersample, 2);
    EXPECT_EQ(suite.cases[2].frame.supersample, 0);
    EXPECT_EQ(suite.cases[2].place, "/cases/2");
}

TEST_F(SuiteFile, ErrorsHaveTheirPlace) {
    EXPECT_EQ(refusal("{\n  \"cases\": [}").substr(0, 6), "2:13: ");
    EXPECT_EQ(refusal("{}"), " /: missing key 'cases'");
    EXPECT_EQ(refusal(R"({"cases": []})"), " /cases: expected an array of one case or more, found an empty array");
    EXPECT_EQ(refusal(R"({"case": [], "cases": []})"), " /case: unknown key; did you mean 'cases'?");
    EXPECT_EQ(refusal(R"({"defaults": {"golden": "a.exr"}, "cases": [{"name": "a"}]})").substr(0, 33),
              " /defaults/golden: unknown key; k");
    EXPECT_EQ(refusal(R"({"defaults": {"depht": 3}, "cases": [{"name": "a"}]})"),
              " /defaults/depht: unknown key; did you mean 'depth'?");
    EXPECT_EQ(refusal(R"({"cases": [{"name": "a"}]})"),
              " /cases/0: missing key 'scene', which \"defaults\" may have: expected a scene's file");
    EXPECT_EQ(refusal(R"({"defaults": {"scene": "s"}, "cases": [{"name": "a"}, {"name": "b"}, {"name": "a"}]})"),
              " /cases/2: 'a' is the name of /cases/0; names differ");
    EXPECT_EQ(refusal(R"({"defaults": {"scene": "s"}, "cases": [{}]})"), " /cases/0: missing key 'name'");
    EXPECT_EQ(refusal(R"({"cases": [{"name": "a b", "scene": "s"}]})"),
              " /cases/0/name: expected a name of letters, digits and _-+./=@ that begins with a letter, a digit or _, "
              "found 'a b'");
    EXPECT_EQ(refusal(R"({"cases": [{"name": "--x", "scene": "s"}]})").substr(0, 24), " /cases/0/name: expected");
}

TEST_F(SuiteFile, ValuesAreChecked) {
    const std::string size = ": must be WIDTHxHEIGHT, each from 1 to 65536, as in 1280x720";
    expect_refused_case(R"("resolution": [64])", " /cases/0/resolution: [64]" + size);
    expect_refused_case(R"("resolution": [64, 0])", " /cases/0/resolution: [64,0]" + size);
    expect_refused_case(
        R"("crop": [1, 1, -1, 0])",
        " /cases/0/crop: [1,1,-1,0]: must be WIDTHxHEIGHT+X+Y in pixels from the top left, as in 64x64+128+96");
    expect_refused_case(R"("supersample": 65)", " /cases/0/supersample: 65: must be a whole number from 1 to 64");
    expect_refused_case(R"("supersample": "2")",
                        " /cases/0/supersample: expected a whole number from 1 to 64, found '2'");
    expect_refused_case(
        R"("target_error": 0)",
        " /cases/0/target_error: 0: must be a number above 0, to 1e30, in the scene's units of radiance");
    expect_refused_case(R"("precision": "duoble")",
                        " /cases/0/precision: 'duoble': must be auto or float or double; did you mean 'double'?");
    expect_refused_case(R"("frames": true)",
                        " /cases/0/frames: true: \"true\" is no frame (0 to 9999999), no range A-B and no range with "
                        "a step A-BxS; a list looks like 0-299x5,7");
    expect_refused_case(R"("frames": "5-1")", " /cases/0/frames: '5-1': 5-1 runs backward; write 1-5");
    EXPECT_EQ(refusal(R"({"cases": [{"name": "a", "scene": "s", "layers": "N,Zz"}]})").substr(0, 59),
              " /cases/0/layers: 'N,Zz': there is no layer 'Zz'; the layer");
    expect_refused_case(R"("z_far": -1)", " /cases/0/z_far: -1: must be a number above 0 in single precision, or inf");
    expect_refused_case(R"("thresholds": {"fial": 1})", " /cases/0/thresholds/fial: unknown key; did you mean 'fail'?");
    expect_refused_case(R"("thresholds": {"failpercent": 1})",
                        " /cases/0/thresholds/failpercent: needs to know when a pixel fails; add \"fail\"");
    expect_refused_case(
        R"("thresholds": {"allow_nonfinite": true})",
        " /cases/0/thresholds/allow_nonfinite: is for thresholds; without one every bit counts; add \"fail\"");
    expect_refused_case(R"("backends": ["embree", "embree"])", " /cases/0/backends/1: is given already; give it once");
    expect_refused_case(R"("backends": ["cdua"])", " /cases/0/backends/0: unknown value 'cdua'; did you mean 'cuda'?");
    expect_refused_case(R"("backends": [])",
                        " /cases/0/backends: expected an array of one backend or more: "
                        "[\"embree\", \"cuda\"], found an empty array");
    expect_refused_case(R"("hash": "12ab")",
                        " /cases/0/hash: expected a hash: 32 of the characters 0 to 9 and a to f, "
                        "found '12ab'");
    expect_refused_case(R"("frames": "0-2", "hash": "00000000000000000000000000000000")",
                        " /cases/0/hash: expected an array of 3 hashes, one for each of \"frames\", found "
                        "'00000000000000000000000000000000'");
    expect_refused_case(R"("golden": "a.png")",
                        " /cases/0/golden: a.png: golden images, and pictures rendered elsewhere, are EXRs");
    expect_refused_case(R"("frames": "0-2", "golden": "a.exr")",
                        " /cases/0/golden: is one file, and \"frames\" names 3; put #### into its name");
}

TEST_F(SuiteFile, WhatExcludesEachOtherIsSaid) {
    expect_refused_case(
        R"("target_error": 0.1, "supersample": 2)",
        " /cases/0: \"target_error\" 0.1: \"supersample\" has no place here: pixels get as many samples as "
        "they need; leave it out");
    expect_refused_case(R"("max_samples": 9)", " /cases/0: \"max_samples\" 9: is for \"target_error\"");
    expect_refused_case(R"("golden": "a.exr", "hash": "00000000000000000000000000000000")",
                        " /cases/0/hash: \"golden\" has no place here: either says what is expected; leave it "
                        "out");
    expect_refused_case(R"("hash": "00000000000000000000000000000000", "thresholds": {"fail": 1})",
                        " /cases/0/thresholds: a \"hash\" is equal or not; give a \"golden\" image");
}

TEST_F(SuiteFile, AMissingFileIsSaid) {
    for (const auto& [folder, part] : {std::pair<std::string, std::string>{"none", "none/suite.json: cannot read"},
                                       {"file", "file: is a file; give the folder of a suite.json"}}) {
        put_bytes(folder_.file("file"), "{}");
        try {
            read_suite(folder_.file(folder));
            ADD_FAILURE() << folder;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::file);
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    }
}

TEST(SuiteSchema, HasEveryKeyWithItsTypeDefaultAndRange) {
    const std::string path = source_tree + "/docs/suite.schema.json";
    const Json root = parse_json(bytes_of(path), path);
    const Json& definitions = root.at("$defs");
    for (const KeyTable* table : all_suite_tables())
        test::expect_keys(*table, table == &suite_keys ? root : definitions.at(std::string(table->name)), definitions);
    EXPECT_EQ(definitions.at("name").at("pattern"), suite_name_pattern);
    const Json& properties = definitions.at("case").at("properties");
    const Json &size = properties.at("resolution").at("oneOf").at(0), &crop = properties.at("crop").at("oneOf").at(0);
    EXPECT_EQ(size.at("minItems"), 2);
    EXPECT_EQ(size.at("maxItems"), 2);
    const Range side = film_keys.find("width")->range;
    test::expect_range(size.at("items"), side, true);
    EXPECT_EQ(crop.at("prefixItems").size(), 4u);
    for (size_t i = 0; i < 4; ++i)
        test::expect_range(crop.at("prefixItems").at(i), i < 2 ? side : Range{0, side.high - 1}, true);
    test::expect_range(properties.at("frames").at("oneOf").at(0), {0, largest_frame}, true);
    EXPECT_EQ(properties.at("backends").at("items").at("enum").size(), suite_backend_key.choices.size());
    for (const KeyTable* of : {&suite_case_keys, &suite_defaults_keys})
        for (const Key& key : of->keys)
            EXPECT_EQ(definitions.at(std::string(of->name)).at("properties").at(std::string(key.name)),
                      properties.at(std::string(key.name)));
}

TEST(SuitePage, HasEveryKey) {
    const std::string page = bytes_of(source_tree + "/docs/regression.md");
    const std::string keys = page.substr(page.find("## suite.json"), page.find("## What is compared"));
    for (const KeyTable* table : {&suite_case_keys, &suite_thresholds_keys, &suite_recorded_keys})
        for (const Key& key : table->keys)
            EXPECT_NE(keys.find("`" + std::string(key.name) + "`"), std::string::npos) << key.name;
}

TEST(SuitePage, ItsExampleIsASuite) {
    const std::string page = bytes_of(source_tree + "/docs/regression.md"), fence = "```json\n";
    const size_t start = page.find(fence) + fence.size();
    const ScratchDirectory folder;
    put_bytes(folder.file("suite.json"), page.substr(start, page.find("```", start) - start));
    EXPECT_EQ(read_suite(folder.file("")).cases.size(), 3u);
}

TEST(SuiteSchema, NamesAreThoseOfItsPattern) {
    const std::regex pattern{std::string(suite_name_pattern)};
    for (const char* name :
         {"a", "0", "_", "glass/float", "a.b-c+d=e@f", "", "-a", ".a", "a b", "a,b", "a*", "\xc3\xa9"})
        EXPECT_EQ(is_suite_name(name), std::regex_match(name, pattern)) << name;
}

TEST(SuiteSchema, KnowsAllColorSpaces) {
    const Key* key = suite_case_keys.find("colorspace");
    ASSERT_EQ(key->choices.size(), color_spaces().size());
    for (size_t i = 0; i < key->choices.size(); ++i) EXPECT_EQ(key->choices[i], color_spaces()[i].id);
}

TEST(JsonEdit, ChangesOneValue) {
    const std::string text = "\xEF\xBB\xBF{ // \"b\": 0\n  \"a\": [1, {\"b\": \"x]\\\"}\"}, 3 /* , */ ], \"b\": 7\n}\n";
    EXPECT_EQ(with_json_values(text, {{"/a/1/b", "9"}}),
              "\xEF\xBB\xBF{ // \"b\": 0\n  \"a\": [1, {\"b\": 9}, 3 /* , */ ], \"b\": 7\n}\n");
    EXPECT_EQ(with_json_values(text, {{"/a/2", "[]"}}),
              "\xEF\xBB\xBF{ // \"b\": 0\n  \"a\": [1, {\"b\": \"x]\\\"}\"}, [] /* , */ ], \"b\": 7\n}\n");
    EXPECT_EQ(with_json_values(text, {{"/b", "\"x\""}}),
              "\xEF\xBB\xBF{ // \"b\": 0\n  \"a\": [1, {\"b\": \"x]\\\"}\"}, 3 /* , */ ], \"b\": \"x\"\n}\n");
    EXPECT_THROW(with_json_values(text, {{"/c/1", "0"}}), std::logic_error);
    EXPECT_THROW(with_json_values(text, {{"/a/7", "0"}}), std::logic_error);
}

TEST(JsonEdit, AddsAKeyAsTheObjectIsWritten) {
    EXPECT_EQ(with_json_values("{}", {{"/a", "1"}}), "{\"a\": 1}");
    EXPECT_EQ(with_json_values("{\"a\": {\"b\": 1}}", {{"/a/c", "2"}}), "{\"a\": {\"b\": 1, \"c\": 2}}");
    EXPECT_EQ(with_json_values("{\"a\": 1}", {{"/b", "[\n  2,\n  3\n]"}}), "{\"a\": 1, \"b\": [2, 3]}");
    EXPECT_EQ(with_json_values("{\n    \"a\": 1 // one\n}", {{"/b", "[\n  2\n]"}}),
              "{\n    \"a\": 1,\n    \"b\": [\n      2\n    ] // one\n}");
    EXPECT_EQ(with_json_values("{\n\t\"a\": 1,\n\t\"b\": {}\n}", {{"/c", "2"}}),
              "{\n\t\"a\": 1,\n\t\"b\": {},\n\t\"c\": 2\n}");
}

TEST(JsonEdit, ChangesSeveralValuesAndKnowsWhereCommentsEnd) {
    EXPECT_EQ(with_json_values("{\"a\": [ // {\"b\": 0},\r{\"b\": 1, \"c\": 2},\n{}]}",
                               {{"/a/0/c", "3"}, {"/a/0/d", "4"}, {"/a/0/e", "5"}, {"/a/1/b", "6"}}),
              "{\"a\": [ // {\"b\": 0},\r{\"b\": 1, \"c\": 3, \"d\": 4, \"e\": 5},\n{\"b\": 6}]}");
}

}  // namespace
}  // namespace cistula
