#include "sequence/output_name.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "testing/support/expect_error.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

std::string named(const char* text, int frame) {
    return OutputName(text, "-o").for_frame(frame);
}

TEST(OutputName, Patterns) {
    EXPECT_EQ(named("beauty.####.exr", 7), "beauty.0007.exr");
    EXPECT_EQ(named("beauty.#.exr", 7), "beauty.7.exr");
    EXPECT_EQ(named("beauty.##.exr", 12345), "beauty.12345.exr");
    EXPECT_EQ(named("b%04d.exr", 42), "b0042.exr");
    EXPECT_EQ(named("frames/frame%d.out", 120), "frames/frame120.out");
    EXPECT_EQ(named("%02d/image.exr", 3), "03/image.exr");
    EXPECT_EQ(named("100%%.%d.exr", 3), "100%.3.exr");
    EXPECT_EQ(named("%0d.exr", 5), "5.exr");
    for (const char* text : {"a.#.exr", "a%d.exr", "a%03d.exr"})
        EXPECT_TRUE(OutputName(text, "-o").has_pattern()) << text;
}

TEST(OutputName, NoPattern) {
    EXPECT_EQ(named("still.exr", 7), "still.exr");
    EXPECT_EQ(named("50%%.exr", 7), "50%.exr");
    EXPECT_FALSE(OutputName("still.exr", "-o").has_pattern());
    EXPECT_FALSE(OutputName("50%%.exr", "-o").has_pattern());
    EXPECT_FALSE(OutputName().has_pattern());
    EXPECT_EQ(OutputName().for_frame(3), "");
}

TEST(OutputName, EveryFrameHasItsOwnName) {
    for (const char* text : {"a.##.exr", "a%d.exr", "a%03d.exr"}) {
        std::vector<std::string> names;
        for (int frame = 0; frame < 1200; ++frame) names.push_back(named(text, frame));
        std::sort(names.begin(), names.end());
        EXPECT_EQ(std::unique(names.begin(), names.end()), names.end()) << text;
    }
}

TEST(OutputName, LayersStandBeforeTheFrameNumberOrTheExtension) {
    const auto named = [](const char* text) { return OutputName(text, "-o").for_layer(12, "diffuse"); };
    EXPECT_EQ(named("beauty.####.exr"), "beauty.diffuse.0012.exr");
    EXPECT_EQ(named("out/beauty_%04d.exr"), "out/beauty_diffuse_0012.exr");
    EXPECT_EQ(named("beauty%d.exr"), "beauty.diffuse.12.exr");
    EXPECT_EQ(named("out/####.exr"), "out/diffuse.0012.exr");
    EXPECT_EQ(named("####.exr"), "diffuse.0012.exr");
    EXPECT_EQ(named("%02d/beauty.exr"), "12/beauty.diffuse.exr");
    EXPECT_EQ(named("v1.2/beauty.exr"), "v1.2/beauty.diffuse.exr");
    EXPECT_EQ(named("beauty.exr"), "beauty.diffuse.exr");
}

TEST(OutputName, NumberSignsOfFoldersAreTheirOwn) {
    for (const std::string text : {"sh#t/a.exr", "####/####/a.exr", "/#/a", "a#/"}) {
        EXPECT_FALSE(OutputName(text, "-o").has_pattern()) << text;
        EXPECT_EQ(OutputName(text, "-o").for_frame(7), text);
    }
    EXPECT_EQ(OutputName("#1/##/f.##.exr", "-o").for_frame(7), "#1/##/f.07.exr");
    EXPECT_EQ(OutputName("#1/#.exr", "-o").for_layer(7, "N"), "#1/N.7.exr");
    EXPECT_EQ(OutputName("#%d/f.exr", "-o").for_frame(7), "#7/f.exr");
}

TEST(OutputName, Errors) {
    const auto conversion = [](const std::string& text) {
        return "-o " + text + ": after % only d, as in %d or %04d, or another % for a percent sign";
    };
    for (const std::string text : {"a%s.exr", "a%4d.exr", "50%.exr", "a%", "a%0", "a%-3d.exr", "a%ld.exr"})
        EXPECT_ERROR(OutputName(text, "-o"), ExitCode::usage, conversion(text));
    for (const std::string text : {"%d/a.##.exr", "%d%d.exr", "#.%d.exr"})
        EXPECT_ERROR(OutputName(text, "--preview"), ExitCode::usage,
                     "--preview " + text + ": two places for the frame number; a name has one, #### or %04d");
    EXPECT_ERROR(OutputName("%099d.exr", "-o"), ExitCode::usage, "-o %099d.exr: a frame number of more than 32 digits");
    EXPECT_ERROR(OutputName("%0999999999999999999d.exr", "-o"), ExitCode::usage,
                 "-o %0999999999999999999d.exr: a frame number of more than 32 digits");
    EXPECT_ERROR(OutputName("", "-o"), ExitCode::usage, "-o: the file name is empty");
}

TEST(OutputName, PatternsOfOtherProgramsAreNamedWithTheRightOne) {
    for (const std::string other : {"$F4", "$F", "@@@@", "<frame>", "<FRAME>", "<f4>", "{frame:04d}"})
        EXPECT_ERROR(OutputName("$FILMS/a." + other + ".exr", "-o"), ExitCode::usage,
                     "-o $FILMS/a." + other + ".exr: " + other +
                         " is no place for the frame number here; #### or %04d is, as in $FILMS/a.####.exr");
    EXPECT_THROW(OutputName(std::string(1000000, '@'), "-o"), Error);
    for (const char* text : {"@@/a.exr", "a@b.exr", "$FILM.exr", "<free>.exr", "{a}.exr"})
        EXPECT_EQ(named(text, 3), text);
}

TEST(OutputName, KindsByExtension) {
    EXPECT_EQ(file_kind("a.exr"), FileKind::exr);
    EXPECT_EQ(file_kind("x.out/a.EXR"), FileKind::exr);
    EXPECT_EQ(file_kind("frame%d.out"), FileKind::raw);
    EXPECT_EQ(file_kind("frame.data"), FileKind::raw);
    const std::string rule = ": images are written as .exr, or as the seed's raw frames .out and .data; ";
    EXPECT_ERROR(file_kind("a.png"), ExitCode::usage, "-o a.png" + rule + "for a PNG add --preview FILE.png");
    EXPECT_ERROR(file_kind("a.jpg"), ExitCode::usage, "-o a.jpg" + rule + "name it *.exr");
    EXPECT_ERROR(file_kind("a"), ExitCode::usage, "-o a" + rule + "name it *.exr");
    EXPECT_ERROR(file_kind("exr"), ExitCode::usage, "-o exr" + rule + "name it *.exr");
}

TEST(OutputName, Default) {
    SceneDescription scene;
    scene.source = "scenes/glass.json";
    EXPECT_EQ(default_output(scene, 0), "glass.exr");
    EXPECT_EQ(default_output(scene, 1), "glass.exr");
    EXPECT_EQ(default_output(scene, 2), "glass.####.exr");
    scene.source = "-";
    EXPECT_EQ(default_output(scene, 0), "stdin.exr");
    scene.source = "50%#1.json";
    EXPECT_EQ(named(default_output(scene, 2).c_str(), 3), "50%_1.0003.exr");
    scene.film.output = "frames/frame%d.out";
    EXPECT_EQ(default_output(scene, 0), "frames/frame%d.out");
}

TEST(OutputName, FramesToRender) {
    const OutputName pattern("b.####.exr", "-o"), plain("dir/b.exr", "-o");
    EXPECT_EQ(frames_to_render(pattern, {}, 3), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(frames_to_render(pattern, {5, 2}, 3), (std::vector<int>{5, 2}));
    EXPECT_EQ(frames_to_render(plain, {}, 3), std::vector<int>{0});
    EXPECT_EQ(frames_to_render(plain, {9}, 3), std::vector<int>{9});
    EXPECT_ERROR(frames_to_render(plain, {1, 2}, 3), ExitCode::usage,
                 "-o dir/b.exr holds one frame and --frames names 2; put the frame number into the name, as in "
                 "-o dir/b.####.exr");
}

TEST(OutputName, DirectoriesAreMade) {
    const ScratchDirectory scratch;
    make_directory_of(scratch.file("a.exr"));
    make_directory_of("a.exr");
    EXPECT_TRUE(scratch.names().empty());
    make_directory_of(scratch.file("new/er/a.exr"));
    make_directory_of(scratch.file("new/er/a.exr"));
    EXPECT_EQ(scratch.names(), std::vector<std::string>{"new"});
    EXPECT_TRUE(std::filesystem::is_directory(scratch.file("new/er")));
    EXPECT_TRUE(std::filesystem::is_empty(scratch.file("new/er")));
    make_directories(OutputName(scratch.file("f%d/a.exr"), "-o"), {3, 1});
    for (const char* name : {"f1", "f3"}) EXPECT_TRUE(std::filesystem::is_directory(scratch.file(name))) << name;
    put_bytes(scratch.file("file"), "");
    EXPECT_ERROR(make_directory_of(scratch.file("file/a.exr")), ExitCode::file,
                 scratch.file("file/a.exr") + ": cannot be written: the directory " + scratch.file("file") +
                     " cannot be made: Not a directory; give another");
    std::filesystem::create_directory(scratch.file("d.exr"));
    EXPECT_ERROR(make_directory_of(scratch.file("d.exr")), ExitCode::file,
                 scratch.file("d.exr") + ": cannot be written: it is a directory; name a file in it");
}

TEST(OutputName, FramesThatAPathMayBeOf) {
    const std::vector<int> frames = parse_frames("0-999999x5,7");
    EXPECT_EQ(frames_named_in({"d/f.000125.exr"}, frames), (std::vector<int>{0, 5, 25, 125}));
    EXPECT_EQ(frames_named_in({"f17.exr"}, frames), (std::vector<int>{7}));
    EXPECT_EQ(frames_named_in({"f17.exr", "a", "0/17"}, frames), (std::vector<int>{0, 7}));
    EXPECT_EQ(frames_named_in({"a.exr"}, frames), std::vector<int>());
    EXPECT_EQ(frames_named_in({"99999999999999999999"}, {0, 1, 2, 3, 4}), std::vector<int>());
}

}  // namespace
}  // namespace cistula
