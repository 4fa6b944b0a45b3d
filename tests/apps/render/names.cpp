// Names that would act on a terminal, and films of very many names.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "base/shown_text.h"
#include "image/exr/exr.h"
#include "render/record/film_channel.h"
#include "testing/support/render_program.h"

namespace cistula {
namespace {

using RenderNames = RenderProgram;

constexpr const char* hostile = "a\x1b[31m\xff\xc2\x9b\xe2\x80\xae";
constexpr const char* shown = "a\\x1b[31m\\xff\\u009b\\u202e";

/// Whether every line is shown as messages are.
void expect_lines(const std::string& text) {
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        EXPECT_EQ(one_line(line), line);
        begin = end + 1;
    }
}

TEST_F(RenderNames, AreEscapedInMessages) {
    const std::string name = hostile;
    expect_refused({name + ".json"}, ExitCode::file, std::string(shown) + ".json: cannot read the scene: ");
    expect_refused({"s.json", "-o", name + ".png"}, ExitCode::usage, std::string(shown) + ".png: images are written");
    expect_refused({"s.json", "-o", "a.exr", "--layers", name}, ExitCode::usage,
                   "no layer '" + std::string(shown) + "'");
    expect_refused({"s.json", "--" + name}, ExitCode::usage, "--" + std::string(shown) + ": no such option");
    expect_refused({"s.json", "--res", name}, ExitCode::usage, shown);
    expect_refused({"s.json", name}, ExitCode::usage, shown);
    const ProgramResult result = run({"s.json", "-v", "-o", name + ".exr"});
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_NE(result.error.find(std::string(shown) + ".exr"), std::string::npos) << result.error;
    expect_lines(result.error);
    EXPECT_TRUE(exr_is_complete(file(name + ".exr"))) << "the name itself is what was asked for";
}

TEST_F(RenderNames, AreEscapedInReports) {
    const std::string name = hostile;
    std::string text = scene_text;
    for (const std::string old : {"glass", "gem"})
        for (size_t at = 0; (at = text.find("\"" + old + "\"", at)) != text.npos; ++at)
            text.replace(at + 1, old.size(), old + "\\n\\u001b[7m\\u202e");
    put_bytes(file(name + ".json"), text);
    for (const Arguments& report : {Arguments{"--explain"}, Arguments{"--pixel", "20,3", "-v"}}) {
        Arguments arguments{name + ".json"};
        arguments.insert(arguments.end(), report.begin(), report.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, 0) << result.error;
        EXPECT_NE(result.out.find(shown), std::string::npos) << result.out;
        EXPECT_NE(result.out.find("\\n\\x1b[7m\\u202e"), std::string::npos) << result.out;
        expect_lines(result.out);
    }
    const ProgramResult pixel = run({name + ".json", "--pixel", "20,3", "--json", "-"});
    EXPECT_EQ(pixel.code, 0) << pixel.error;
    EXPECT_TRUE(nlohmann::json::accept(pixel.out));
    expect_done({name + ".json", "-o", name + ".exr", "--stats", "stats.json"});
    EXPECT_TRUE(nlohmann::json::accept(bytes_of(file("stats.json"))));
}

TEST_F(RenderNames, OfMeshFilesThatAreNotUtf8HaveMattesOfTheirOwn) {
    // A wall of three squares in front of the camera, named in Shift-JIS and Latin-1.
    const std::vector<std::string> names = {"\x94\xa0", "\x8b\x85", "caf\xe9"};
    std::string obj = "mtllib w.mtl\n", mtl;
    for (size_t i = 0; i < names.size(); ++i) {
        for (const char* corner : {"0 -9", "1 -9", "1 9", "0 9"})
            obj += "v " + std::to_string(static_cast<int>(i) - 2 + (corner[0] - '0')) + " 0 " + (corner + 2) + "\n";
        obj += "o " + names[i] + "\nusemtl " + names[i] + "\nf -4 -3 -2 -1\n";
        mtl += "newmtl " + names[i] + "\nKd 1 1 1\n";
    }
    put_bytes(file("w.obj"), obj);
    put_bytes(file("w.mtl"), mtl);
    put_bytes(file("w.json"), R"({"film": {"width": 40, "height": 24}, "ambient": 1, "camera": {"position": [0, -4, 0],
        "target": [0, 0, 0], "fov": 60}, "objects": [{"name": "w", "mesh": "w.obj"}]})");
    expect_done({"w.json", "-o", "w.exr", "--layers", "cryptomatte"});
    const LayeredPicture picture = read_exr(file("w.exr"));
    for (const auto& [kind, key, before] :
         {std::tuple{"CryptoObject", "3ae39a5", "w/"}, std::tuple{"CryptoMaterial", "be359d6", ""}}) {
        std::set<std::string> expected;
        for (const char* name : {"%94%A0", "%8B%85", "caf%E9"}) expected.insert(before + std::string(name));
        std::set<std::string> in_manifest;
        std::set<float> ids{0}, known{0};
        const auto& text =
            std::get<std::string>(picture.attributes.at("cryptomatte/" + std::string(key) + "/manifest"));
        const auto manifest = nlohmann::json::parse(text);
        for (const auto& [name, id] : manifest.items()) {
            in_manifest.insert(name);
            known.insert(cryptomatte_id(name));
        }
        EXPECT_EQ(in_manifest, expected);
        for (const auto& channel : picture.channels)
            if (channel.name == std::string(kind) + "00.r") ids.insert(channel.values.begin(), channel.values.end());
        EXPECT_EQ(ids, known) << kind;
    }
    const ProgramResult pixel = run({"w.json", "--pixel", "16,12"});
    EXPECT_NE(pixel.out.find("w/%8B%85"), std::string::npos) << pixel.out;
}

TEST_F(RenderNames, OfAMillionTheFirstIsWrittenAtOnce) {
    std::string text = scene_text;
    text.replace(text.find("\"frames\": 3"), 11, "\"frames\": 1000000");
    put_bytes(file("long.json"), text);
    for (const Arguments& more : {Arguments{}, Arguments{"--resume"}, Arguments{"-f", "999999-1999998"}}) {
        const std::string film = more.empty() ? "all" : more[0].substr(1);
        Arguments arguments{"long.json", "-q", "--res", "8x6", "-o", film + ".#.exr", "--stats", "stats.json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        RunningProgram running(program_, arguments, file(""));
        const bool range = more.size() == 2;
        ASSERT_TRUE(running.wait_until([&] { return exists(film + (range ? ".999999.exr" : ".1.exr")); }, 20));
        running.send(SIGINT);
        const ProgramResult result = running.wait();
        EXPECT_EQ(result.code, 130) << result.error;
        EXPECT_NE(result.error.find(" of 1000000 frames written; "), std::string::npos) << result.error;
        EXPECT_TRUE(nlohmann::json::accept(bytes_of(file("stats.json"))));
        EXPECT_FALSE(has_part_files());
    }
    expect_refused({"long.json", "-o", "f.#.exr", "--stats", "f.765432.exr"}, ExitCode::usage,
                   "f.765432.exr: would be both --stats and an image");
}

}  // namespace
}  // namespace cistula
