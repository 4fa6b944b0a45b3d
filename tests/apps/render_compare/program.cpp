// The built `render-compare` from outside: statistics against values worked out by hand, verdicts, exit codes, files.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <functional>

#include "apps/common/command_line.h"
#include "apps/render_compare/fixture.h"
#include "image/exr/exr.h"
#include "testing/support/special_values.h"

namespace cistula {
namespace {

using test::infinity;

float float_of(uint32_t bits) {
    return std::bit_cast<float>(bits);
}

TEST_F(RenderCompare, StatisticsAreThoseWorkedOutByHand) {
    const auto result = compare(1, {zeros, first_r}, {zeros, second_r});
    EXPECT_FALSE(result.at("holds").get<bool>());
    EXPECT_EQ(result.at("pixels"), 8);
    ASSERT_EQ(result.at("channels").size(), 2u);
    const auto &g = result.at("channels")[0], &r = result.at("channels")[1];
    EXPECT_EQ(g.at("name"), "G");
    EXPECT_EQ(g.at("differing"), 0);
    EXPECT_EQ(g.at("max"), 0);
    EXPECT_EQ(g.at("psnr"), "inf");
    EXPECT_TRUE(g.at("worst").is_null());
    EXPECT_EQ(r.at("differing"), 2);
    EXPECT_EQ(r.at("infinite"), 0);
    EXPECT_EQ(r.at("max"), 0.5);
    EXPECT_EQ(r.at("mean"), 0.75 / 8);
    EXPECT_DOUBLE_EQ(r.at("rmse").get<double>(), std::sqrt(0.3125 / 8));
    EXPECT_NEAR(r.at("psnr").get<double>(), 10 * std::log10(4 / (0.3125 / 8)), 1e-12);  // the peak is 2
    EXPECT_EQ(r.at("worst"), nlohmann::json({{"x", 8}, {"y", 7}, {"first", 2.0}, {"second", 1.5}}));
    const std::string text = expect_code(1, {"a.exr", "b.exr"});
    EXPECT_TRUE(contains(text, "(8, 7): 2 / 1.5\n")) << text;
    EXPECT_TRUE(contains(text, "\ndiffer: 2 of 16 floats differ\n")) << text;
}

TEST_F(RenderCompare, ThePeakOfPsnrIsAtLeastOne) {
    Channel dim = zeros, dimmer = zeros;
    dim.values[7] = 0.5f;
    dimmer.values[7] = 0.25f;
    const auto g = compare(1, {dim}, {dimmer}).at("channels")[0];
    EXPECT_NEAR(g.at("psnr").get<double>(), 10 * std::log10(1 / (0.0625 / 8)), 1e-12);
    EXPECT_EQ(g.at("worst").at("x"), 8);
    EXPECT_EQ(g.at("worst").at("y"), 8);
}

TEST_F(RenderCompare, WhatIsNotFiniteIsCountedApart) {
    const float nan = float_of(0x7fc00000), other_nan = float_of(0x7fc00001);
    const Channel a{"Z", false, {infinity, infinity, 1, nan, -0.0f, nan, 3, -infinity}};
    const Channel b{"Z", false, {infinity, 1, nan, nan, 0.0f, other_nan, 3.5f, infinity}};
    const auto z = compare(1, {a}, {b}).at("channels")[0];
    EXPECT_EQ(z.at("differing"), 6);
    EXPECT_EQ(z.at("infinite"), 3);
    EXPECT_EQ(z.at("max"), "inf");
    EXPECT_EQ(z.at("mean"), 0.5 / 5);
    EXPECT_DOUBLE_EQ(z.at("rmse").get<double>(), std::sqrt(0.25 / 5));
    EXPECT_NEAR(z.at("psnr").get<double>(), 10 * std::log10(3.5 * 3.5 / 0.05), 1e-12);
    EXPECT_EQ(z.at("worst"), nlohmann::json({{"x", 6}, {"y", 7}, {"first", "inf"}, {"second", 1.0}}));
    EXPECT_EQ(compare(1, {a}, {b}, {"--hardfail", "1e30"}).at("over_hardfail"), 3);
    EXPECT_EQ(compare(1, {a}, {b}, {"--fail", "0"}).at("over_fail"), 4);
    EXPECT_EQ(compare(1, {a}, {b}, {"--fail", "0.5", "--failpercent", "37.5"}).at("over_fail"), 3);
    EXPECT_EQ(z.at("nonfinite_alike"), 3);
    EXPECT_EQ(z.at("nonfinite_other"), 3);
    compare(0, {a}, {a});  // NaN and infinity equal themselves
}

/// Thresholds that no finite difference exceeds.
const std::vector<Arguments> loosest = {
    {"--fail", "1e30", "--failpercent", "100"}, {"--hardfail", "1e30"}, {"--failssim", "-1"}};

TEST_F(RenderCompare, WhatIsNotFinitePassesNoThreshold) {
    const float nan = float_of(0x7fc00000);
    const Channel one{"R", false, std::vector<float>(8, 1)};
    const auto with = [&](size_t i, float value) {
        Channel channel = one;
        channel.values[i] = value;
        return channel;
    };
    const std::pair<Channel, Channel> others[] = {{with(2, nan), one},
                                                  {one, with(2, infinity)},
                                                  {with(2, nan), with(3, nan)},
                                                  {with(2, nan), with(2, infinity)},
                                                  {with(2, infinity), with(2, -infinity)}};
    for (Arguments thresholds : loosest) {
        compare(0, {one}, {zeros, one}, thresholds);
        for (const bool allowed : {false, true}) {
            if (allowed) thresholds.push_back("--allow-nonfinite");
            for (const auto& [a, b] : others) {
                const std::string verdict = compare(1, {zeros, a}, {zeros, b}, thresholds).at("verdict");
                EXPECT_TRUE(contains(verdict, "not finite in one, or differently in both; the first: R at (7, 7): "))
                    << verdict;
            }
            for (const float value : {nan, infinity, -infinity}) {
                const std::vector<Channel> both = {with(5, value)};
                EXPECT_EQ(contains(compare(allowed ? 0 : 1, both, both, thresholds).at("verdict"),
                                   "1 value is not finite in both; the first: R at (6, 8): "),
                          true);
            }
        }
    }
    compare(0, {with(2, nan), zeros}, {with(3, nan), zeros}, {"--fail", "0", "--layers", "G"});  // R does not count
    expect_refused({"a.exr", "b.exr", "--allow-nonfinite"}, ExitCode::usage, "--allow-nonfinite: is for thresholds");
}

TEST_F(RenderCompare, SignsOfZeroAndKindsOfNanAreBitsAndNoDifference) {
    Channel a = zeros, b = zeros;
    a.values[5] = -0.0f;
    a.values[6] = float_of(0x7fc00000);
    b.values[6] = float_of(0x7fc00123);
    const auto g = compare(1, {a}, {b}).at("channels")[0];
    EXPECT_EQ(g.at("differing"), 2);
    EXPECT_EQ(g.at("max"), 0);
    const std::string text = expect_code(1, {"a.exr", "b.exr"});
    EXPECT_TRUE(contains(text, "(6, 8): -0 (bits 80000000) / 0 (bits 00000000)\n")) << text;
    compare(0, {a}, {b}, {"--fail", "0", "--allow-nonfinite"});
    compare(0, {a}, {b}, {"--hardfail", "0", "--allow-nonfinite"});
}

TEST_F(RenderCompare, Thresholds) {
    const auto code = [&](int expected, const Arguments& thresholds) {
        return compare(expected, {first_r, zeros}, {second_r, zeros}, thresholds);
    };
    EXPECT_EQ(code(0, {"--fail", "0.5"}).at("over_fail"), 0);
    EXPECT_EQ(code(1, {"--fail", "0.25"}).at("over_fail"), 1);  // a difference of 0.25 is not over it
    EXPECT_EQ(code(1, {"--fail", "0.1"}).at("over_fail"), 2);
    code(0, {"--fail", "0.25", "--failpercent", "12.5"});
    code(1, {"--fail", "0.25", "--failpercent", "12.4"});
    code(0, {"--fail", "0.1", "--failpercent", "25"});
    code(0, {"--hardfail", "0.5"});
    EXPECT_EQ(code(1, {"--hardfail", "0.3"}).at("over_hardfail"), 1);
    code(1, {"--fail", "0.1", "--failpercent", "100", "--hardfail", "0.3"});
    code(1, {"--fail", "0", "--hardfail", "1"});
    const auto all = code(0, {"--fail", "0.1", "--failpercent", "30", "--hardfail", "0.5"});
    EXPECT_EQ(all.at("thresholds"), nlohmann::json({{"fail", 0.1},
                                                    {"failpercent", 30.0},
                                                    {"hardfail", 0.5},
                                                    {"failflip", nullptr},
                                                    {"failssim", nullptr},
                                                    {"allow_nonfinite", false}}));
    EXPECT_EQ(
        all.at("verdict"),
        "within the thresholds: 2 of 8 pixels (25 %) over --fail 0.1, 30 % allowed; 0 pixels over --hardfail 0.5");
    // A pixel counts once, however many of its channels fail.
    Channel again = second_r, zeros_r = zeros;
    again.name = "B";
    zeros_r.name = "B";
    EXPECT_EQ(compare(1, {first_r, zeros_r}, {second_r, again}, {"--fail", "0.1"}).at("over_fail"), 3);
}

TEST_F(RenderCompare, WithThresholdsWhatBothHaveIsJudged) {
    put("a.exr", picture_of({first_r, zeros}));
    put("b.exr", picture_of({first_r}));
    const std::string text = expect_code(0, {"a.exr", "b.exr", "--fail", "0.1"});
    EXPECT_TRUE(contains(text, "not compared: channel G: only in the first\n")) << text;
    EXPECT_TRUE(contains(text, "within the thresholds: 0 of 8 pixels")) << text;
    expect_code(1, {"a.exr", "b.exr"});
    expect_code(1, {"a.exr", "b.exr", "--fail", "0.1", "--layers", "G"});
    expect_code(0, {"a.exr", "b.exr", "--layers", "R"});
    put("b.exr", picture_of({{"Z", false, first_r.values}}));
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "b.exr", "--fail", "9"}), "no channel is in both"));
}

TEST_F(RenderCompare, PartsThatAreNotChosenMayBeAlone) {
    const LayeredPicture picture = picture_of({first_r});
    write_exr(file("a.exr"), std::vector<PicturePart>{{"rgba", picture}, {"diffuse", picture}});
    write_exr(file("b.exr"),
              std::vector<PicturePart>{{"rgba", picture}, {"diffuse", picture}, {"spec", picture_of({second_r})}});
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "b.exr"}), "part spec: only in the second\n"));
    EXPECT_TRUE(contains(expect_code(0, {"a.exr", "b.exr", "--layers", "rgba"}), "that --layers leaves out: spec.R"));
    expect_code(0, {"a.exr", "b.exr", "--fail", "0"});
    expect_code(1, {"a.exr", "b.exr", "--layers", "spec"});
}

TEST_F(RenderCompare, FoldersAndSequencesAreComparedByNamesAndNumbers) {
    for (const char* folder : {"a", "b"}) std::filesystem::create_directory(file(folder));
    for (const char* name : {"a/f.0001.exr", "a/f.0002.exr", "b/f.0001.exr", "b/g1.exr", "b/g2.exr"})
        put(name, picture_of({first_r}));
    put_bytes(file("a/notes.txt"), "");
    put("b/f.0002.exr", picture_of({second_r}));
    const std::string text = expect_code(1, {"a", "b", "--json", "r.json"});
    EXPECT_EQ(text,
              "f.0001.exr: equal: every bit of 8 floats and of the header\nf.0002.exr: differ: 2 of 8 floats differ\n"
              "g1.exr: only in the second\ng2.exr: only in the second\ndiffer: 3 of 4 images\n");
    EXPECT_EQ(nlohmann::json::parse(bytes_of(file("r.json"))).at("images")[1].at("max"), 0.5);
    EXPECT_EQ(expect_code(0, {"a/f.####.exr", "b/g%d.exr"}),
              "1: equal: every bit of 8 floats and of the header\n2: equal: every bit of 8 floats and of the "
              "header\nhold: all 2 images\n");
    expect_code(0, {"a", "a/", "--fail", "1", "-q", "--mask", "b/f.0001.exr"});
    expect_refused({"a", "a/f.0001.exr"}, ExitCode::usage, "give two folders, or two sequences");
    expect_refused({"a", "b", "--diff", "d.exr"}, ExitCode::usage, "--diff d.exr: is one image");
    expect_refused({"c.##.exr", "a/f.##.exr"}, ExitCode::file, "c.##.exr: has no images");
}

TEST_F(RenderCompare, FoldersAreComparedWithAllThatIsInThem) {
    namespace fs = std::filesystem;
    for (const char* folder : {"a/deep/er", "b/deep/er", "b/other.exr", "linked"}) fs::create_directories(file(folder));
    for (const char* name : {"a/f.exr", "b/f.exr", "a/deep/er/f.exr", "linked/g.exr"}) put(name, picture_of({first_r}));
    put("b/deep/er/f.exr", picture_of({second_r}));
    EXPECT_EQ(expect_code(1, {"a", "b"}),
              "deep/er/f.exr: differ: 2 of 8 floats differ\nf.exr: equal: every bit of 8 floats and of the header\n"
              "differ: 1 of 2 images\n");
    put("b/deep/er/f.exr", picture_of({first_r}));
    expect_code(0, {"a", "b"});
    fs::create_directory_symlink(file("linked"), file("a/deep/link"));
    EXPECT_TRUE(contains(expect_code(1, {"a", "b"}), "deep/link/g.exr: only in the first\n"));
    EXPECT_TRUE(contains(expect_code(1, {"b", "a"}), "deep/link/g.exr: only in the second\n"));
    expect_refused({"a", "a", "--json", "a/deep/er/f.exr"}, ExitCode::usage, "would be both an image and --json");
    fs::create_directory_symlink(file("b/deep"), file("b/deep/er/round"));
    expect_refused({"a", "b"}, ExitCode::file, "b/deep/er/round: leads back to a folder that it is in");
    fs::remove(file("b/deep/er/round"));
    if (geteuid() == 0) GTEST_SKIP() << "root reads every folder";
    fs::permissions(file("b/deep"), fs::perms::none);
    expect_refused({"a", "b"}, ExitCode::file, "b/deep");
    fs::permissions(file("b/deep"), fs::perms::owner_all);
}

/// Where no window is the same, headers decide.
TEST_F(RenderCompare, ValuesThatCannotCountAreNotRead) {
    LayeredPicture other = picture_of({first_r});
    put("a.exr", other);
    other.x = 6;
    put("b.exr", other);
    for (const char* name : {"a.exr", "b.exr"}) {
        const std::string bytes = bytes_of(file(name));
        put_bytes(file(name), bytes.substr(0, bytes.size() - 10));  // of the pixels
    }
    EXPECT_TRUE(contains(expect_code(1, {"a.exr", "b.exr"}), "data window: 4x2+5+7 / 4x2+6+7\n"));
    expect_refused({"a.exr", "b.exr", "--intersection"}, ExitCode::file, "a.exr: cannot read");
}

/// Every output against every input, by other names.
TEST_F(RenderCompare, NoOutputIsAnInput) {
    std::filesystem::create_directory(file("d"));
    for (const char* name : {"a.exr", "b.exr", "m.exr", "d/1.exr"}) put(name, picture_of({first_r}));
    std::filesystem::create_symlink(file("a.exr"), file("link.exr"));
    const std::string bytes = bytes_of(file("a.exr"));
    const Arguments images = {"a.exr", "b.exr", "--mask", "m.exr"};
    for (const char* option : {"--diff", "--json"})
        for (const char* input : {"a.exr", "./b.exr", "d/../m.exr", "link.exr"}) {
            Arguments words = images;
            words.insert(words.end(), {option, input});
            expect_refused(words, ExitCode::usage, "would be both");
        }
    expect_refused({"d", "d", "--json", "d/1.exr"}, ExitCode::usage, "would be both an image and --json");
    expect_refused({"d/#.exr", "d/#.exr", "--json", "d/1.exr"}, ExitCode::usage, "would be both an image and --json");
    for (const char* name : {"a.exr", "b.exr", "m.exr", "d/1.exr"}) EXPECT_EQ(bytes_of(file(name)), bytes) << name;
}

TEST_F(RenderCompare, JsonGoesToStandardOutputWhereItIsAsked) {
    put("a.exr", picture_of({first_r}));
    put("b.exr", picture_of({second_r}));
    EXPECT_FALSE(nlohmann::json::parse(expect_code(1, {"a.exr", "b.exr", "--json", "-"})).at("holds").get<bool>());
    EXPECT_FALSE(exists("-"));
}

TEST_F(RenderCompare, PointersOfGitLfsAreNamed) {
    put("a.exr", picture_of({first_r}));
    for (const char* name : {"b.exr", "b.png"}) {
        put_bytes(file(name), "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 4\n");
        expect_refused({"a.exr", name}, ExitCode::file, "it is a pointer of Git LFS, not the file; git lfs pull");
    }
}

TEST_F(RenderCompare, EqualImagesAreEqual) {
    const auto result = compare(0, {first_r, zeros}, {first_r, zeros});
    EXPECT_TRUE(result.at("holds").get<bool>());
    EXPECT_EQ(result.at("verdict"), "equal: every bit of 16 floats and of the header");
    EXPECT_EQ(expect_code(0, {"a.exr", "b.exr", "-q"}), "");
    EXPECT_EQ(expect_code(0, {"a.exr", "a.exr"}).find("differ:"), std::string::npos);
}

TEST_F(RenderCompare, WindowsMustBeTheSameWhateverTheThresholds) {
    const auto differs = [&](const std::function<void(LayeredPicture&)>& change, const std::string& part,
                             const std::string& layers = "*") {
        LayeredPicture other = picture_of({first_r, zeros});
        put("a.exr", other);
        change(other);
        put("b.exr", other);
        std::filesystem::remove(file("d.exr"));
        for (const Arguments& more :
             {Arguments{}, Arguments{"--fail", "100", "--failpercent", "100", "--layers", layers}}) {
            Arguments arguments{"a.exr", "b.exr", "--diff", "d.exr"};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const std::string text = expect_code(1, arguments);
            EXPECT_TRUE(contains(text, part + "\n")) << text;
            EXPECT_TRUE(contains(text, "differ: the parts, windows or channels differ")) << text;
        }
    };
    differs([](LayeredPicture& p) { p.x = 6; }, "data window: 4x2+5+7 / 4x2+6+7");
    EXPECT_FALSE(exists("d.exr"));
    differs([](LayeredPicture& p) { std::swap(p.width, p.height); }, "data window: 4x2+5+7 / 2x4+5+7");
    differs(
        [](LayeredPicture& p) {
            p.height = 1;
            for (Channel& channel : p.channels) channel.values.resize(4);
        },
        "data window: 4x2+5+7 / 4x1+5+7");
    differs([](LayeredPicture& p) { p.display_width = 21; }, "display window: 20x10+0+0 / 21x10+0+0");
    differs([](LayeredPicture& p) { p.channels.pop_back(); }, "channel G: only in the first");
    EXPECT_EQ(read_exr(file("d.exr")).channels.size(), 1u);
    differs(
        [](LayeredPicture& p) {
            p.channels.push_back({"Z", false, std::vector<float>(8)});
        },
        "channel Z: only in the second");
}

TEST_F(RenderCompare, TheHeaderCountsWhereEveryBitDoes) {
    const auto differs = [&](const std::function<void(LayeredPicture&)>& change, const std::string& line) {
        LayeredPicture other = picture_of({first_r});
        put("a.exr", other);
        change(other);
        put("b.exr", other);
        const std::string strict = expect_code(1, {"a.exr", "b.exr"});
        EXPECT_TRUE(contains(strict, "header: " + line + "\n")) << strict;
        EXPECT_TRUE(contains(strict, "differ: all 8 floats compared are equal; the header differs")) << strict;
        const std::string within = expect_code(0, {"a.exr", "b.exr", "--fail", "0"});
        EXPECT_TRUE(contains(within, "header: " + line + "\n")) << within;
    };
    differs([](LayeredPicture& p) { p.attributes["cistula:depth"] = 8; }, "cistula:depth: 4 / 8");
    differs([](LayeredPicture& p) { p.attributes.erase("cistula:sceneHash"); }, "cistula:sceneHash: abc / (none)");
    differs([](LayeredPicture& p) { p.attributes["by"] = std::string("me\n"); }, "by: (none) / me\\n");
    differs([](LayeredPicture& p) { p.attributes["cistula:depth"] = 4.0; }, "cistula:depth: 4 (int) / 4 (double)");
    differs([](LayeredPicture& p) { p.channels[0].half = true; }, "channel R: float / half");
}

TEST_F(RenderCompare, TheDifferenceImageHoldsTheDifferences) {
    Channel z{"Z", false, {infinity, infinity, 1, 1, 1, 1, 1, 1}}, other = z;
    other.values[1] = -3;
    compare(1, {first_r, z}, {second_r, other}, {"--diff", "d.exr"});
    const LayeredPicture d = read_exr(file("d.exr"));
    EXPECT_EQ(d.x, 5);
    EXPECT_EQ(d.y, 7);
    EXPECT_EQ(d.display_width, 20);
    EXPECT_EQ(d.display_height, 10);
    ASSERT_EQ(d.channels.size(), 2u);
    EXPECT_EQ(d.channels[0].values, (std::vector<float>{0, 0.25f, 0, 0.5f, 0, 0, 0, 0}));
    EXPECT_EQ(d.channels[1].values, (std::vector<float>{0, infinity, 0, 0, 0, 0, 0, 0}));
}

TEST_F(RenderCompare, RefusesInOneLine) {
    put("a.exr", picture_of({first_r}));
    expect_refused({}, ExitCode::usage, "no images are given");
    expect_refused({"a.exr"}, ExitCode::usage, "only one image is given");
    expect_refused({"a.exr", "b.exr", "c.exr"}, ExitCode::usage, "c.exr: one image too many");
    expect_refused({"a.exr", "b.exr", "--fial", "1"}, ExitCode::usage, "did you mean '--fail'?");
    for (const char* text : {"-1", "nan", "inf", "x", "0.1f"}) {
        expect_refused({"a.exr", "a.exr", "--fail", text}, ExitCode::usage, "must be a number, 0 or above");
        expect_refused({"a.exr", "a.exr", "--hardfail", text}, ExitCode::usage, "must be a number, 0 or above");
    }
    expect_refused({"a.exr", "a.exr", "--fail", "0", "--failpercent", "101"}, ExitCode::usage, "from 0 to 100");
    expect_refused({"a.exr", "a.exr", "--failpercent", "1"}, ExitCode::usage, "--failpercent requires --fail");
    expect_refused({"a.exr", "a.exr", "--diff", "d.png"}, ExitCode::usage, "name it *.exr");
    expect_refused({"a.exr", "a.exr", "--diff", "./a.exr"}, ExitCode::usage, "the first image and --diff");
    expect_refused({"b.exr", "a.exr", "--json", file("a.exr")}, ExitCode::usage, "the second image and --json");
    expect_refused({"a.exr", "a.exr", "--diff", "d.exr", "--json", "d.exr"}, ExitCode::usage, "--diff and --json");
    expect_refused({"a.exr", "none.exr"}, ExitCode::file, "none.exr: cannot read");
    ASSERT_EQ(mkfifo(file("pipe.exr").c_str(), 0600), 0);
    for (const char* pipe : {"pipe.exr", "/dev/null"})
        expect_refused({"a.exr", pipe}, ExitCode::file, "it is a pipe, a socket or a device; give a file");
    put_bytes(file("text.exr"), "no image");
    expect_refused({"text.exr", "a.exr"}, ExitCode::file, "text.exr: cannot read");
    const std::string bytes = bytes_of(file("a.exr"));
    put_bytes(file("short.exr"), bytes.substr(0, bytes.size() - 3));
    expect_refused({"a.exr", "short.exr"}, ExitCode::file, "short.exr: cannot read");
    expect_refused({"a.exr", "a.exr", "--diff", "none/d.exr"}, ExitCode::file, "none/d.exr");
    expect_refused({"a.exr", "a.exr", "--json", "none/d.json"}, ExitCode::file, "none/d.json");
    EXPECT_EQ(bytes_of(file("a.exr")), bytes);
    const std::string help = expect_code(0, {"--help"});
    EXPECT_TRUE(contains(help, "Exit codes: 0 the comparison holds"));
    EXPECT_EQ(help.find_first_of("{}"), std::string::npos) << help;
    EXPECT_EQ(expect_code(0, {"--version"}), "render-compare (Cistula) " CISTULA_VERSION "\n");
}

}  // namespace
}  // namespace cistula
