// The built `render` from outside: exit codes, messages, files.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string_view>

#include "base/stages.h"
#include "image/exr/exr.h"
#include "image/picture/picture_io.h"
#include "image/picture/raw_picture.h"
#include "image/view/picture_view.h"
#include "render/target.h"
#include "sequence/backends.h"
#include "testing/support/gpu.h"
#include "testing/support/render_program.h"
#include "testing/support/scene_dump.h"

namespace cistula {
namespace {

constexpr const char* text_input = R"(2
floor.data
frame%d.out
32 20 90
6.0 5.0 0.0 2.0 1.0 0.05 0.1 0.05 0.0 0.0
3.0 0.0 3.1415926 1.5 0.5 0.03 0.07 0.02 0.0 0.0
-2.5 2.5 2 0.9843 0.4745 0.0156 2.25 0.1 0.6
2.5 2.5 2 0.49 0.3216 0.0078 1.732 0.1 0.6
2.5 -2.5 2 0.949 0.773 0.05 2.118 0.1 0.6
-5 -5 0
5 -5 0
5 5 0
-5 5 0
1
-4 4 3 1 1 1
3 1
)";

const std::vector<float>& channel(const LayeredPicture& picture, std::string_view name) {
    for (const LayeredPicture::Channel& one : picture.channels)
        if (one.name == name) return one.values;
    throw std::runtime_error("no channel " + std::string(name));
}

TEST_F(RenderProgram, PrintsWhatItIsAskedFor) {
    const ProgramResult help = run({"--help"}), version = run({"--version"}), sample = run({"--print-template"});
    EXPECT_EQ(help.code, 0);
    EXPECT_NE(help.out.find("Examples:"), std::string::npos);
    EXPECT_NE(help.out.find("  --explain "), std::string::npos) << help.out;
    EXPECT_EQ(help.out.find_first_of("{}"), std::string::npos) << help.out;
    EXPECT_EQ(version.code, 0);
    EXPECT_EQ(version.out, "render (Cistula) " CISTULA_VERSION "\n");
    EXPECT_EQ(sample.code, 0);
    EXPECT_NE(sample.out.find("frame%d"), std::string::npos);
    put_bytes(file("sample.txt"), sample.out);  // and needs nothing beside it
    expect_done({"sample.txt", "-q", "--res", "16x9", "-f", "0", "-o", "sample.exr"});
    EXPECT_EQ(help.error + version.error + sample.error, "");
}

TEST_F(RenderProgram, ExplainsAndRendersNothing) {
    const ProgramResult result = run({"s.json", "--explain", "-o", "a.exr"});
    EXPECT_EQ(result.code, 0) << result.error;
    for (const char* part : {"effect", "refraction           yes", "absorption           no", "Left out: "})
        EXPECT_NE(result.out.find(part), std::string::npos) << result.out;
    EXPECT_FALSE(exists("a.exr"));
}

TEST_F(RenderProgram, MeasuresWhatEffectsCost) {
    const ProgramResult result = run({"s.json", "--explain=measure"});
    EXPECT_EQ(result.code, 0) << result.error;
    for (const char* part : {"cost", " %", "medians of 7 frames"})
        EXPECT_NE(result.out.find(part), std::string::npos) << result.out;
    const std::string shown = run({"s.json", "--explain=measure", "--progress", "plain"}).error;
    EXPECT_EQ(shown.rfind("compiling\n", 0), 0u) << shown;
    EXPECT_NE(shown.find("\nmeasuring\n"), std::string::npos) << shown;
    EXPECT_EQ(run({"s.json", "--explain=measure", "--progress", "plain", "-q"}).error, "");
}

TEST_F(RenderProgram, AllEffectsWriteTheSameFile) {
    for (const char* effects : {"auto", "all"})
        ASSERT_EQ(run({"s.json", "-q", "--effects", effects, "-o", std::string(effects) + ".exr"}).code, 0);
    EXPECT_EQ(bytes_of(file("auto.exr")), bytes_of(file("all.exr")));
}

TEST_F(RenderProgram, RefusesInOneLine) {
    expect_refused({}, ExitCode::usage, "no scene is given");
    expect_refused({"s.json", "--dept", "3"}, ExitCode::usage, "did you mean '--depth'?");
    expect_refused({"s.json", "--fps", "25"}, ExitCode::usage, "the scene file says it, as 'frames_per_second'");
    expect_refused({"s.json", "-o", "a.exr", "-o", "b.exr"}, ExitCode::usage,
                   "--output: given 2 times, as a.exr and b.exr; give it once");
    expect_refused({"s.json", "-o", "a.png"}, ExitCode::usage, "for a PNG add --preview");
    expect_refused({"s.json", "-o", "a.exr", "-f", "1-2"}, ExitCode::usage, "-o a.####.exr");
    expect_refused({"s.json", "-o", "a.exr", "--crop", "8x8+33+0"}, ExitCode::usage,
                   "leaves the frame, which is 40x24");
    expect_refused({"s.json", "-o", "a.exr", "--crop", "8x8-1+0"}, ExitCode::usage,
                   "--crop 8x8-1+0: leaves the frame, which is 40x24");
    expect_refused({"s.json", "-o", "a.out", "--layers", "id"}, ExitCode::usage, "--layers needs an .exr");
    expect_refused({"s.json", "-o", "a.out", "--resume"}, ExitCode::usage, "--resume needs an .exr");
    expect_refused({"s.json", "-o", "a.out", "--bits", "half"}, ExitCode::usage, "--bits half needs an .exr");
    expect_refused({"s.json", "-o", "a.##.exr", "--preview", "p.png"}, ExitCode::usage, "put #### into the name");
    expect_refused({"s.json", "-o", "a.exr", "--preview", "p.jpg"}, ExitCode::usage, "a preview is a PNG");
    expect_refused({"none.json", "-o", "a.exr"}, ExitCode::file, "none.json");
    put_bytes(file("bad.json"), R"({"film": {"widht": 3}, "objects": []})");
    expect_refused({"bad.json", "-o", "a.exr"}, ExitCode::usage, "'width'");
    expect_refused({"s.json", "-o", "bad.json/a.exr"}, ExitCode::file, "bad.json cannot be made: Not a directory");
    expect_refused({"s.json", "-o", "a.exr", "--stats", "bad.json/a.json"}, ExitCode::file,
                   "bad.json cannot be made: Not a directory");
    expect_refused({"s.json", "-o", "none/a.exr", "--stats", "none/a.exr"}, ExitCode::usage, "would be both");
    EXPECT_FALSE(exists("a.exr") || exists("none"));
}

TEST_F(RenderProgram, RefusesNamesThatMeet) {
    const std::string scene = bytes_of(file("s.json"));
    std::filesystem::create_directory(file("d"));
    std::filesystem::create_symlink("d", file("link"));
    const std::string both = ": would be both ";
    expect_refused({"s.json", "-o", "x.exr", "--stats", "x.exr"}, ExitCode::usage,
                   "x.exr" + both + "--stats and an image; give each a file of its own");
    expect_refused({"s.json", "-o", "./x.exr", "--stats", "d/../x.exr"}, ExitCode::usage,
                   both + "--stats and an image");
    expect_refused({"s.json", "-o", "d/x.exr", "--stats", "link/x.exr"}, ExitCode::usage,
                   both + "--stats and an image");
    expect_refused({"s.json", "-o", "x.exr", "--stats", file("x.exr")}, ExitCode::usage, both + "--stats and an image");
    expect_refused({"s.json", "-o", "x.#.exr", "--stats", "x.2.exr"}, ExitCode::usage,
                   "x.2.exr" + both + "--stats and an image");
    expect_refused({"s.json", "-o", "x.#.exr", "--preview", "p%02d.png", "--stats", "p01.png"}, ExitCode::usage,
                   "p01.png" + both + "--stats and a preview");
    expect_refused({"s.json", "-o", "x.exr", "--stats", "s.json"}, ExitCode::usage, both + "the scene and --stats");
    put_bytes(file("s1.exr"), scene);
    expect_refused({"s1.exr", "-o", "s#.exr"}, ExitCode::usage, "s1.exr" + both + "the scene and an image");
    put_bytes(file("s.png"), scene);
    expect_refused({"s.png", "-o", "x.exr", "--preview", "s.png"}, ExitCode::usage, both + "the scene and a preview");
    for (const char* name : {"s.json", "s1.exr", "s.png"}) EXPECT_EQ(bytes_of(file(name)), scene) << name;
    EXPECT_FALSE(exists("x.exr") || exists("d/x.exr") || exists("s0.exr"));
    expect_done({"s.json", "-q", "-o", "x.#.exr", "--stats", "x.3.exr", "-f", "1"});  // frame 3 is not rendered
}

TEST_F(RenderProgram, CudaRendersTheSameFile) {
    CISTULA_NEEDS_GPU();
    expect_done({"s.json", "-q", "-o", "a.exr", "--backend", "cuda", "--stats", "a.json"});
    expect_done({"s.json", "-q", "-o", "b.exr"});
    EXPECT_EQ(bytes_of(file("a.exr")), bytes_of(file("b.exr")));
    EXPECT_EQ(nlohmann::json::parse(bytes_of(file("a.json"))).at("context").at("devices").size(), 1u);
    expect_refused({"s.json", "-o", "c.exr", "--backend", "cuda", "--device", "4096"}, ExitCode::device,
                   "--device 4096: there is no such GPU");
    EXPECT_FALSE(exists("c.exr"));
}

TEST_F(RenderProgram, CudaIsInterruptedInTreesWithoutEnd) {
    CISTULA_NEEDS_GPU();
    expect_interrupted_within_a_pixel({"--backend", "cuda"});
}

TEST_F(RenderProgram, CudaIsRefusedAndNeverReplaced) {
    if (!test::missing_gpu().empty()) {
        for (const char* device : {"0", "4096"}) {
            expect_refused({"s.json", "-q", "-o", "a.exr", "--backend", "cuda", "--device", device}, ExitCode::device,
                           has_cuda_backend() ? "" : "no CUDA backend");
            EXPECT_FALSE(exists("a.exr"));
        }
    }
    expect_refused({"s.json", "-o", "c.exr", "--device", "0"}, ExitCode::usage, "add --backend cuda");
    EXPECT_FALSE(exists("c.exr"));
    // What the scene calls for does not depend on the backend.
    expect_done({"s.json", "--explain", "--backend", "cuda"});
}

TEST_F(RenderProgram, ListsDevices) {
    const ProgramResult result = run({"--list-devices"});
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_EQ(result.out, with_options(list_devices_text()));
    if (test::missing_gpu().empty()) {
        EXPECT_EQ(result.out.rfind("0: ", 0), 0u) << result.out;
    } else {
        EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1) << result.out;
    }
}

TEST_F(RenderProgram, OneFrameOrAllOrSome) {
    expect_done({"s.json", "-q"});
    EXPECT_TRUE(exists("s.exr"));
    expect_done({"s.json", "-q", "-o", "all.##.exr"});
    for (const char* name : {"all.00.exr", "all.01.exr", "all.02.exr"}) EXPECT_TRUE(exists(name)) << name;
    EXPECT_FALSE(exists("all.03.exr"));
    EXPECT_EQ(bytes_of(file("s.exr")), bytes_of(file("all.00.exr")));
    expect_done({"s.json", "-q", "-o", "one.exr", "-f", "2"});
    EXPECT_EQ(bytes_of(file("one.exr")), bytes_of(file("all.02.exr")));
    EXPECT_NE(bytes_of(file("one.exr")), bytes_of(file("all.01.exr")));
    expect_done({"s.json", "-q", "-o", "some%03d.exr", "-f", "0-2x2,7"});
    for (const char* name : {"some000.exr", "some002.exr", "some007.exr"}) EXPECT_TRUE(exists(name)) << name;
    EXPECT_FALSE(exists("some001.exr"));
    expect_done({"s.json", "-q", "-f", "0,1"});
    EXPECT_TRUE(exists("s.0000.exr") && exists("s.0001.exr"));
    EXPECT_FALSE(has_part_files());
}

TEST_F(RenderProgram, Previews) {
    expect_done({"s.json", "-q", "-o", "a.##.exr", "--preview", "p.%d.png"});
    for (const char* name : {"p.0.png", "p.1.png", "p.2.png"})
        EXPECT_EQ(bytes_of(file(name)).substr(1, 3), "PNG") << name;
    EXPECT_FALSE(exists("p.3.png"));
    expect_done({"s.json", "-q", "-f", "0", "-o", "t.exr", "--background", "transparent", "--preview", "t.png"});
    const std::string png = bytes_of(file("t.png"));
    EXPECT_EQ(png[25], 6);  // the color type: with alpha
    EXPECT_EQ(bytes_of(file("p.0.png"))[25], 2);
}

TEST_F(RenderProgram, ViewsChangeThePreviewAlone) {
    const auto render = [&](const std::string& name, const Arguments& more) {
        Arguments arguments{"s.json", "-q", "-f", "0", "-o", name + ".exr", "--preview", name + ".png"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_done(arguments);
        EXPECT_EQ(bytes_of(file(name + ".exr")), bytes_of(file("plain.exr"))) << name;
        return bytes_of(file(name + ".png"));
    };
    const std::string plain = render("plain", {});
    EXPECT_EQ(render("same", {"--exposure", "0", "--view", "srgb", "--bloom", "0"}), plain);
    std::set<std::string> previews{plain};
    previews.insert(render("bright", {"--exposure", "2"}));
    previews.insert(render("film", {"--exposure", "2", "--view", "filmic"}));
    previews.insert(render("glow", {"--exposure", "2", "--view", "filmic", "--bloom", "1"}));
    EXPECT_EQ(previews.size(), 4u);
    // They are what a picture of the image's channels becomes.
    const LayeredPicture image = read_exr(file("plain.exr"));
    ColorPicture color{40, 24, {}};
    for (size_t i = 0; i < 40 * 24; ++i)
        color.texels.emplace_back(channel(image, "R")[i], channel(image, "G")[i], channel(image, "B")[i]);
    EXPECT_EQ(encode_png(viewed(color, {2, ViewCurve::filmic, 1}, 24)), bytes_of(file("glow.png")));
}

TEST_F(RenderProgram, ViewsLeaveRawFrames) {
    expect_done({"s.json", "-q", "-f", "0", "-o", "plain.out"});
    expect_done({"s.json", "-q", "-f", "0", "-o", "a.out", "--preview", "a.png", "--exposure", "2", "--bloom", "1"});
    EXPECT_EQ(bytes_of(file("a.out")), bytes_of(file("plain.out")));
}

TEST_F(RenderProgram, ReadsStandardInput) {
    expect_done({"s.json", "-q", "-o", "file.exr"});
    expect_done({"-", "-q", "-o", "input.exr"}, scene_text);
    EXPECT_EQ(bytes_of(file("file.exr")), bytes_of(file("input.exr")));
}

TEST_F(RenderProgram, TheTextInputGivesRawFrames) {
    ColorPicture floor{2, 2, {{1, 1, 1}, {0, 0, 0}, {0, 0, 0}, {1, 1, 1}}};
    write_raw_picture(file("floor.data"), floor);
    expect_done({"-", "-q"}, text_input);
    EXPECT_TRUE(exists("frame0.out") && exists("frame1.out"));
    EXPECT_FALSE(exists("frame2.out"));
    const std::string bytes = bytes_of(file("frame0.out"));
    ASSERT_EQ(bytes.size(), 8u + 32 * 20 * 4);
    int32_t size[2];
    std::memcpy(size, bytes.data(), 8);
    EXPECT_EQ(size[0], 32);
    EXPECT_EQ(size[1], 20);
    // The scene from a file and written as OpenEXR: the same picture before rounding to bytes.
    put_bytes(file("input.txt"), text_input);
    expect_done({"input.txt", "-q", "-o", "frame.exr"});
    const LayeredPicture image = read_exr(file("frame.exr"));
    ColorPicture color{32, 20, {}};
    for (size_t i = 0; i < 32 * 20; ++i)
        color.texels.emplace_back(channel(image, "R")[i], channel(image, "G")[i], channel(image, "B")[i]);
    write_raw_picture(file("again.out"), color);
    EXPECT_EQ(bytes_of(file("again.out")), bytes);
}

TEST_F(RenderProgram, MakesTheFoldersOfItsFiles) {
    expect_done(
        {"s.json", "-q", "-f", "0", "-o", "images/a.exr", "--preview", "png/a/b.png", "--stats", "json/a.json"});
    for (const char* name : {"images/a.exr", "png/a/b.png", "json/a.json"}) EXPECT_TRUE(exists(name)) << name;
    expect_done({"s.json", "-q", "-o", "%d/a.exr"});
    for (const char* name : {"0/a.exr", "1/a.exr", "2/a.exr"}) EXPECT_TRUE(exists(name)) << name;
}

TEST_F(RenderProgram, TheExampleOfTheTextInputRuns) {
    const std::filesystem::path scenes = std::filesystem::path(CISTULA_SOURCE_DIR) / "scenes";
    std::filesystem::create_directory_symlink(scenes, file("scenes"));
    expect_done({"-", "-q", "--res", "16x9", "-f", "0,299"}, bytes_of(file("scenes/input.txt")));
    for (const char* name : {"out/frames/frame0.out", "out/frames/frame299.out"})
        EXPECT_EQ(bytes_of(file(name)).size(), 8u + 16 * 9 * 4) << name;
}

TEST_F(RenderProgram, TheExampleOfThePageOfScenesRunsAndItsFilmCloses) {
    const std::string page = bytes_of((source_root() / "docs/scene.md").string());
    const size_t start = page.find("```json\n") + 8;
    put_bytes(file("scene.json"), page.substr(start, page.find("```", start) - start));
    for (const char* name : {"marble.data", "knot.ply"})
        put_bytes(file(name), bytes_of((source_root() / "scenes" / name).string()));
    expect_done({"scene.json", "-q", "--res", "32x18", "--supersample", "1", "-f", "0,100", "-o", "f.###.exr"});
    const LayeredPicture first = read_exr(file("f.000.exr")), after = read_exr(file("f.100.exr"));
    for (size_t i = 0; i < size_t{32} * 18; ++i) EXPECT_NEAR(channel(first, "R")[i], channel(after, "R")[i], 1e-4) << i;
}

TEST_F(RenderProgram, ACropIsTheSameRegion) {
    const Arguments layers{"-q", "--layers", "error,id,samples,cost,Z,N", "--cutoff", "0.01", "--supersample", "2"};
    Arguments full{"s.json", "-o", "full.exr"}, crop{"s.json", "-o", "crop.exr", "--crop", "13x7+21+11"};
    full.insert(full.end(), layers.begin(), layers.end());
    crop.insert(crop.end(), layers.begin(), layers.end());
    expect_done(full);
    expect_done(crop);
    const LayeredPicture a = read_exr(file("full.exr")), b = read_exr(file("crop.exr"));
    EXPECT_EQ(b.display_width, 40);
    EXPECT_EQ(b.display_height, 24);
    EXPECT_EQ(b.x, 21);
    EXPECT_EQ(b.y, 11);
    ASSERT_EQ(b.width, 13);
    ASSERT_EQ(b.height, 7);
    ASSERT_EQ(a.channels.size(), 14u);
    ASSERT_EQ(b.channels.size(), 14u);
    for (size_t c = 0; c < a.channels.size(); ++c) {
        EXPECT_EQ(a.channels[c].name, b.channels[c].name);
        for (size_t y = 0; y < 7; ++y)
            for (size_t x = 0; x < 13; ++x) {
                const float whole = a.channels[c].values[(y + 11) * 40 + x + 21],
                            part = b.channels[c].values[y * 13 + x];
                ASSERT_EQ(std::memcmp(&whole, &part, sizeof whole), 0) << a.channels[c].name << " " << x << " " << y;
            }
    }
    EXPECT_EQ(*std::max_element(channel(b, "samples").begin(), channel(b, "samples").end()), 4);
}

TEST_F(RenderProgram, ThreadsNeverShow) {
    for (const char* threads : {"1", "2", "7"})
        expect_done(
            {"s.json", "-q", "--layers", "id,cost", "-o", std::string("t") + threads + ".exr", "--threads", threads});
    EXPECT_EQ(bytes_of(file("t1.exr")), bytes_of(file("t2.exr")));
    EXPECT_EQ(bytes_of(file("t1.exr")), bytes_of(file("t7.exr")));
}

TEST_F(RenderProgram, OptionsReachTheImage) {
    expect_done({"s.json", "-q", "-o", "base.exr"});
    const std::string base = bytes_of(file("base.exr"));
    const std::vector<Arguments> changes = {{"--depth", "1"},   {"--precision", "double"}, {"--supersample", "2"},
                                            {"--res", "20x12"}, {"--bits", "half"},        {"--cutoff", "0.1"},
                                            {"--layers", "N"}};
    for (const Arguments& change : changes) {
        Arguments arguments{"s.json", "-q", "-o", "other.exr"};
        arguments.insert(arguments.end(), change.begin(), change.end());
        expect_done(arguments);
        EXPECT_NE(bytes_of(file("other.exr")), base) << change[0];
    }
    expect_done({"s.json", "-q", "-o", "other.exr", "--bits", "half", "--layers", "Z"});
    for (const LayeredPicture::Channel& one : read_exr(file("other.exr")).channels)
        EXPECT_EQ(one.half, one.name != "Z");
}

TEST_F(RenderProgram, HalfNeverHoldsAnInfinity) {
    std::string bright = scene_text;
    const std::string light = R"({"position": [-4, 4, 5]})";
    bright.replace(bright.find(light), light.size(), R"({"position": [-4, 4, 5], "color": 2e6})");
    put_bytes(file("bright.json"), bright);
    const Arguments film{"bright.json", "-o", "b.#.exr", "--bits", "half", "--layers", "error", "--depth", "2"};
    const ProgramResult result = run(film);
    EXPECT_EQ(result.code, 0) << result.error;
    uint64_t at_most = 0;
    for (const char* name : {"b.0.exr", "b.1.exr", "b.2.exr"})
        for (const LayeredPicture::Channel& one : read_exr(file(name)).channels)
            for (const float value : one.values) {
                EXPECT_LE(value, 65504) << one.name;
                at_most += value == 65504;
            }
    EXPECT_GT(at_most, 1000u);
    const std::string said = fmt::format(
        "render: warning: b.#.exr: in 3 of 3 frames: clamped: {} values are over 65504, the largest half", at_most);
    EXPECT_NE(result.error.find(said), std::string::npos) << said << "\n" << result.error;
    EXPECT_EQ(result.error.find("largest half"), result.error.rfind("largest half")) << "one line";
    Arguments strict = film;
    strict.insert(strict.end(), {"--strict", "-q", "-f", "1", "-o", "strict.exr"});
    strict.erase(strict.begin() + 1, strict.begin() + 3);
    expect_refused(strict, ExitCode::failed, "strict.exr: not written: ");
    EXPECT_FALSE(exists("strict.exr"));
    expect_done({"bright.json", "-q", "-o", "float.exr", "--strict"});  // floats hold all
    expect_done({"s.json", "-q", "-o", "dim.exr", "--bits", "half", "--strict"});
    EXPECT_EQ(run({"s.json", "-o", "dim.exr", "--bits", "half"}).error.find("half"), std::string::npos);
}

TEST_F(RenderProgram, WhatTheDepthTookIsSaidInOneLine) {
    const ProgramResult film = run({"s.json", "-o", "d.#.exr", "--depth", "1"});
    EXPECT_EQ(film.code, 0) << film.error;
    const std::string said = "render: warning: d.#.exr: in 3 of 3 frames, most in frame ";
    ASSERT_NE(film.error.find(said), std::string::npos) << film.error;
    EXPECT_NE(film.error.find(": depth 1 may have taken up to "), std::string::npos) << film.error;
    EXPECT_EQ(film.error.find("see --depth"), film.error.rfind("see --depth")) << "one line";
    const ProgramResult frame = run({"s.json", "-f", "1", "-o", "d.exr", "--depth", "1"});
    EXPECT_NE(frame.error.find("render: warning: d.exr: depth 1 may"), std::string::npos) << frame.error;
    EXPECT_EQ(run({"s.json", "-o", "d.#.exr", "--depth", "1", "-q"}).error, "");
    EXPECT_EQ(run({"s.json", "-o", "d.#.exr", "--depth", "64"}).error.find("depth"), std::string::npos);
    EXPECT_EQ(run({"s.json", "-o", "d.#.exr", "--depth", "1", "--target-error", "9"}).error.find("warning"),
              std::string::npos);
}

TEST_F(RenderProgram, ALightThatSumsCannotHoldIsRefusedByName) {
    std::string bright = scene_text;
    const std::string light = R"({"position": [-4, 4, 5]})";
    bright.replace(bright.find(light), light.size(),
                   R"({"position": [-4, 4, 5]}, {"position": [0, 0, 9], "radius": 1, "glow": 1e20})");
    put_bytes(file("bright.json"), bright);
    expect_refused({"bright.json", "-o", "b.#.exr"}, ExitCode::usage, "bright.json: /lights/1: its glow of 1e+20");
    EXPECT_FALSE(exists("b.0.exr"));
}

TEST_F(RenderProgram, AFilmOverTheZenithSaysWhereItTurns) {
    std::string over = scene_text;
    const std::string path = R"({"r0": 5, "z0": 3, "wphi": 0.1})";
    over.replace(over.find(path), path.size(), R"({"z0": 6, "Ar": 3, "wr": 0.5, "pr": -0.5})");
    put_bytes(file("over.json"), over);
    const ProgramResult result = run({"over.json", "-o", "o.#.exr"});
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_NE(result.error.find("render: warning: over.json: /camera/path: the view passes along up and the picture "
                                "turns at once: by 180 degrees between frames 1 and 2\n"),
              std::string::npos)
        << result.error;
    EXPECT_EQ(run({"over.json", "-f", "1", "-o", "o.exr"}).error.find("turns"), std::string::npos);
    // The text input has no `up` to change.
    std::string text = text_input;
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace("6.0 5.0 0.0 2.0 1.0 0.05 0.1 0.05 0.0 0.0", "0 9 0 0 0 0 0 0 0 0");
    replace("3.0 0.0 3.1415926 1.5 0.5 0.03 0.07 0.02 0.0 0.0", "0 0 0 0 0 0 0 0 0 0");
    write_raw_picture(file("floor.data"), ColorPicture{1, 1, {glm::vec3(1, 1, 1)}});
    expect_done({"-", "-q", "-o", "down.exr", "-f", "0", "--layers", "id"}, text);
    const LayeredPicture down = read_exr(file("down.exr"));
    // As from a little off the axis, on its +x side: the right is +y, below is +x.
    const auto id_at = [&](size_t x, size_t y) { return channel(down, "id")[y * 32 + x]; };
    EXPECT_EQ((std::vector{id_at(21, 4), id_at(21, 15), id_at(10, 15), id_at(10, 4)}),
              (std::vector<float>{1, 2, 3, 4}));
}

TEST_F(RenderProgram, WhatAFilmSaysOfAFrameNamesIt) {
    put_bytes(file("dark.json"), R"({"film": {"width": 8, "height": 6}, "camera": {"position": [0, -5, 0]},
        "materials": {"m": {}}, "objects": [{"solid": "cube", "material": "m"}], "background": {"stops": [[0, 1]]}, "ambient": 0,
        "lights": [{"position": [0, -9, 9], "color": {"keys": [[0, 1], [2, 0], [3, 0], [4, 1]]}}]})");
    const std::string said =
        "dark.json: /background: it is seen, mirrored and refracted, but lights nothing; `ambient` "
        "and lights do\n";
    const auto lines = [&](const char* frames) {
        const ProgramResult result = run({"dark.json", "--progress", "none", "--frames", frames, "-o", "d.#.exr"});
        EXPECT_EQ(result.code, 0) << result.error;
        std::string found, line;
        for (std::istringstream text(result.error); std::getline(text, line);)
            if (line.find("lights nothing") != std::string::npos) found += line + "\n";
        return found;
    };
    EXPECT_EQ(lines("0-1"), "");
    EXPECT_EQ(lines("0-4"), "render: frame 2: " + said + "render: frame 3: " + said);
    EXPECT_EQ(lines("2-4"), "render: warning: frame 2: " + said) << "what the first frame said";
}

TEST_F(RenderProgram, TheHeaderSaysWhatTheImageDependsOn) {
    expect_done(
        {"s.json", "-q", "-o", "a.exr", "-f", "2", "--cutoff", "0.125", "--precision", "double", "--supersample", "2"});
    const LayeredPicture picture = read_exr(file("a.exr"));
    const auto& attributes = picture.attributes;
    std::vector<std::string> names;
    for (const auto& entry : attributes) names.push_back(entry.first);
    EXPECT_EQ(names,
              (std::vector<std::string>{"chromaticities", "cistula:cameraHash", "cistula:cutoff", "cistula:depth",
                                        "cistula:frame", "cistula:precision", "cistula:sceneHash",
                                        "cistula:supersample", "cistula:time", "cistula:version", "colorInteropID",
                                        "imageCounter", "screenWindowWidth", "worldToCamera", "worldToNDC"}));
    EXPECT_EQ(std::get<double>(attributes.at("cistula:cutoff")), 0.125);
    EXPECT_EQ(std::get<int>(attributes.at("cistula:depth")), 6);
    EXPECT_EQ(std::get<int>(attributes.at("cistula:frame")), 2);
    EXPECT_EQ(std::get<double>(attributes.at("cistula:time")), 2);
    EXPECT_EQ(std::get<int>(attributes.at("cistula:supersample")), 2);
    EXPECT_EQ(std::get<std::string>(attributes.at("cistula:precision")), "double");
    EXPECT_EQ(std::get<std::string>(attributes.at("cistula:version")), CISTULA_VERSION);
    EXPECT_GE(std::get<std::string>(attributes.at("cistula:sceneHash")).size(), 16u);
    EXPECT_EQ(std::get<std::vector<float>>(attributes.at("worldToNDC")).size(), 16u);
    // Both precisions of one scene have one hash; another scene has another.
    expect_done({"s.json", "-q", "-o", "b.exr", "--depth", "2"});
    EXPECT_EQ(read_exr(file("b.exr")).attributes.at("cistula:sceneHash"), attributes.at("cistula:sceneHash"));
    std::string other = scene_text;
    other.replace(other.find("0.5, 0.1]"), 3, "0.4");
    expect_done({"-", "-q", "-o", "c.exr"}, other);
    EXPECT_NE(read_exr(file("c.exr")).attributes.at("cistula:sceneHash"), attributes.at("cistula:sceneHash"));
}

TEST_F(RenderProgram, StatsAreJson) {
    expect_done({"s.json", "-q", "-o", "a.##.exr", "--stats", "s.stats.json", "--threads", "2", "--layers", "cost",
                 "--cutoff", "0.05"});
    const auto stats = nlohmann::json::parse(bytes_of(file("s.stats.json")));
    const auto& context = stats.at("context");
    EXPECT_EQ(context.at("threads"), 2);
    EXPECT_EQ(context.at("backend"), "embree");
    EXPECT_EQ(context.at("precision"), "float");
    EXPECT_EQ(context.at("resolution"), nlohmann::json({40, 24}));
    EXPECT_EQ(context.at("intersector"), context.at("lanes") > 1 ? "lanes" : "embree");
    EXPECT_FALSE(context.at("host_name").get<std::string>().empty());
    EXPECT_NE(context.at("flags").get<std::string>().find("-ffp-contract=off"), std::string::npos);
    EXPECT_GE(context.at("commit").get<std::string>().size(), 7u);
    EXPECT_GT(context.at("peak_rss_bytes").get<uint64_t>(), 1u << 20);
    EXPECT_GT(context.at("scene_bytes").get<uint64_t>(), 0u);
    const auto has = [&](const char* list, const char* effect) {
        const auto& names = context.at(list);
        return std::find(names.begin(), names.end(), effect) != names.end();
    };
    EXPECT_TRUE(has("effects_required", "refraction") && has("effects", "refraction"));
    EXPECT_FALSE(has("effects_required", "absorption"));
    std::map<std::string, nlohmann::json> entries;
    for (const auto& entry : stats.at("benchmarks")) entries[entry.at("name")] = entry;
    for (const char* name : {"frame/0", "frame/1", "frame/2"}) {
        ASSERT_EQ(entries.count(name), 1u) << name;
        EXPECT_GE(entries[name].at("real_time").get<double>(), 0);
        EXPECT_EQ(entries[name].at("time_unit"), "ms");
    }
    const auto& frame = entries["frame/1"];
    EXPECT_EQ(frame.at("file"), "a.01.exr");
    EXPECT_EQ(frame.at("rays").at("primary"), 40 * 24);
    const auto& rays = frame.at("rays");
    EXPECT_EQ(rays.at("total").get<uint64_t>(),
              rays.at("primary").get<uint64_t>() + rays.at("reflected").get<uint64_t>() +
                  rays.at("transmitted").get<uint64_t>() + rays.at("shadow").get<uint64_t>());
    const LayeredPicture image = read_exr(file("a.01.exr"));
    double cost = 0;
    for (const float value : channel(image, "cost")) cost += value;
    EXPECT_EQ(rays.at("total").get<double>(), cost);
    EXPECT_GT(frame.at("rays_per_second").get<double>(), 0);
    EXPECT_EQ(frame.at("film_hash").get<std::string>().size(), 32u);
    EXPECT_GT(frame.at("ledger").at("pruned").at("worst").at(0).get<double>(), 0);
    EXPECT_LE(frame.at("ledger").at("pruned").at("worst").at(0).get<double>(), 0.05);
}

TEST_F(RenderProgram, StagesAddUpToTheWholeCommand) {
    // They are never more. Another program may hold up this one where it sees nothing, so that the best of some runs
    // counts.
    double named = 0;
    for (int i = 0; i < 5 && named < 0.95; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        expect_done({"s.json", "-q", "-o", "a.exr", "-f", "0", "--res", "480x360", "--supersample", "12", "--stats",
                     "s.stats.json"});
        const double all = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const auto stages = nlohmann::json::parse(bytes_of(file("s.stats.json")))
                                .at("context")
                                .at("stages_ms")
                                .get<std::map<std::string, double>>();
        double sum = 0;
        for (const auto& [name, milliseconds] : stages) sum += milliseconds / 1e3;
        EXPECT_EQ(stages.size(), stage_names.size());
        EXPECT_LE(sum, all);
        EXPECT_GT(stages.at("start"), 0);
        EXPECT_GT(stages.at("render"), 500 * sum);
        named = std::max(named, (sum - stages.at("other") / 1e3) / all);
    }
    EXPECT_GE(named, 0.95);
}

TEST_F(RenderProgram, OfATargetItIsSaidWhatIsProvenAndWhatIsEstimated) {
    const ProgramResult result = run({"s.json", "-o", "a.exr", "--target-error", "0.02", "--layers", "samples,error",
                                      "--stats", "s.stats.json", "--progress", "none"});
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_NE(result.error.find("render: target error 0.02: truncation is proven to reach its quarter, taking "),
              std::string::npos)
        << result.error;
    const LayeredPicture image = read_exr(file("a.exr"));
    EXPECT_EQ(std::get<double>(image.attributes.at("cistula:targetError")), 0.02);
    EXPECT_EQ(std::get<int>(image.attributes.at("cistula:maxSamples")), 256);
    EXPECT_EQ(std::get<double>(image.attributes.at("cistula:cutoff")), 0.005);
    EXPECT_EQ(std::get<int>(image.attributes.at("cistula:depth")), 1024);
    EXPECT_EQ(std::get<int>(image.attributes.at("cistula:supersample")), 16);

    const std::vector<float>& samples = channel(image, "samples");
    const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
    EXPECT_GE(*least, 5);
    EXPECT_LT(*least, *most);
    EXPECT_LE(*most, 256);
    for (const char* name : {"error.R", "error.G", "error.B"})
        for (const float error : channel(image, name)) ASSERT_LE(error, 0.005f * (1 + 0x1p-20f)) << name;

    const auto stats = nlohmann::json::parse(bytes_of(file("s.stats.json")));
    EXPECT_EQ(stats.at("context").at("target_error"), 0.02);
    EXPECT_EQ(stats.at("context").at("max_samples"), 256);
    EXPECT_EQ(stats.at("context").at("cutoff"), 0.005);
    const auto& frame = stats.at("benchmarks").back();
    double sum = 0;
    for (const float value : samples) sum += value;
    EXPECT_EQ(frame.at("samples").get<double>(), sum);
    EXPECT_EQ(frame.at("rays").at("primary").get<double>(), sum);
    const auto& target = frame.at("target");
    EXPECT_EQ(target.at("pixels_missed"), 0);
    const auto& proven = target.at("truncation_proven");
    EXPECT_EQ(proven.at("reached"), true);
    EXPECT_EQ(proven.at("pixels_truncated"), 0);
    EXPECT_LE(proven.at("worst").get<double>(), 0.005);
    EXPECT_GT(proven.at("worst").get<double>(), 0);
    const auto& estimated = target.at("sampling_estimated");
    for (const char* key : {"pixels_undersampled", "pixels_rounded"}) EXPECT_EQ(estimated.at(key), 0);
    const uint64_t checked = estimated.at("pixels_checked"), off = estimated.at("pixels_off");
    EXPECT_GT(checked, 0u);
    EXPECT_LE(checked, 6u);  // blocks of 16 x 16 pixels
    EXPECT_GE(size_t(std::count(samples.begin(), samples.end(), 256.0f)), checked);
    EXPECT_EQ(estimated.at("rate_at_most"), rate_at_most(off, checked));
    EXPECT_NE(result.error.find(fmt::format("is off by more in {} of {} checked pixels", off, checked)),
              std::string::npos)
        << result.error;
    EXPECT_EQ(std::get<double>(image.attributes.at("cistula:provenTruncation")), proven.at("worst").get<double>());
    EXPECT_EQ(std::get<int>(image.attributes.at("cistula:checkedPixels")), int(checked));
    EXPECT_EQ(std::get<int>(image.attributes.at("cistula:offPixels")), int(off));
    // What is known of the image afterwards does not make it another.
    EXPECT_NE(run({"s.json", "-o", "a.exr", "--target-error", "0.02", "--layers", "samples,error", "--resume"})
                  .error.find("1 of 1 frames are complete"),
              std::string::npos);

    expect_done({"s.json", "-q", "-o", "b.exr"});
    for (const char* name : {"cistula:targetError", "cistula:provenTruncation", "cistula:checkedPixels"})
        EXPECT_EQ(read_exr(file("b.exr")).attributes.count(name), 0u);
    EXPECT_EQ(run({"s.json", "-q", "-o", "a.exr", "--target-error", "0.02"}).error, "");
}

TEST_F(RenderProgram, AMissedTargetIsCountedAndTheImageWritten) {
    // Cut at once, the pixels of gem and floor lose what these mirror and transmit.
    const Arguments shallow{"s.json", "-q",      "-o", "a.exr",   "--target-error",
                            "0.02",   "--depth", "1",  "--stats", "s.stats.json"};
    expect_refused(shallow, ExitCode::target, "render: target error 0.02 missed in ");
    EXPECT_EQ(std::get<int>(read_exr(file("a.exr")).attributes.at("cistula:depth")), 1);
    const auto target = nlohmann::json::parse(bytes_of(file("s.stats.json"))).at("benchmarks").back().at("target");
    const uint64_t missed = target.at("pixels_missed");
    const auto& proven = target.at("truncation_proven");
    EXPECT_EQ(proven.at("reached"), false);
    EXPECT_GT(missed, 0u);
    EXPECT_LE(missed, 40u * 24);
    EXPECT_EQ(proven.at("pixels_truncated"), missed);
    EXPECT_GT(proven.at("worst").get<double>(), 0.005);
    expect_refused(shallow, ExitCode::target,
                   std::to_string(missed) + " of 960 pixels: " + std::to_string(missed) +
                       " lose more than a quarter of it below depth 1; a larger --depth may reach it");

    expect_refused({"s.json", "-q", "-o", "b.exr", "--target-error", "0.02", "--max-samples", "5"}, ExitCode::target,
                   "want more than 5 samples; raise --max-samples");
    EXPECT_EQ(std::get<int>(read_exr(file("b.exr")).attributes.at("cistula:maxSamples")), 5);
    EXPECT_FALSE(has_part_files());
}

TEST_F(RenderProgram, RadianceThatAnImageCannotHoldIsRefusedInEitherPrecision) {
    put_bytes(file("bright.json"), R"({"film": {"width": 8, "height": 6}, "materials": {"m": {"specular": 1e20}},
        "objects": [{"solid": "cube", "material": "m"}], "lights": [{"position": [0, 0, 9], "color": [1e30, 0, 0]}]})");
    expect_refused({"bright.json", "-o", "a.exr", "--precision", "float"}, ExitCode::usage, "above 2^100, what single");
    expect_refused({"bright.json", "-o", "a.exr", "--precision", "double"}, ExitCode::usage,
                   "above 2^127, what an image can hold; use dimmer lights");
    EXPECT_FALSE(exists("a.exr"));
}

TEST_F(RenderProgram, ATargetThatRoundingMissesAsksForDoublePrecision) {
    const std::string floor = std::string(CISTULA_SOURCE_DIR) + "/scenes/hard/far-floor.json";
    Arguments fine{floor, "-q", "-o", "a.exr", "--res", "60x34", "--target-error", "0.004"};
    expect_refused(fine, ExitCode::target, "have borders that rounding may move by more; --precision double");
    fine.insert(fine.end(), {"--precision", "double"});
    expect_done(fine);
}

TEST_F(RenderProgram, ThePrecisionIsTheOneThatTheSceneNeedsUnlessOneIsWanted) {
    put_bytes(file("small.json"), R"({"film": {"width": 8, "height": 6}, "materials": {"m": {}}, "objects": [
        {"quad": [[-1e6, -1e6, 0], [1e6, -1e6, 0], [1e6, 1e6, 0], [-1e6, 1e6, 0]], "material": "m"},
        {"name": "pebble", "solid": "cube", "center": [0, 0, 2], "material": "m"}]})");
    const auto precision = [&] {
        return std::get<std::string>(read_exr(file("a.exr")).attributes.at("cistula:precision"));
    };
    const std::string facts =
        "/objects/1: pebble: its inradius is 5.8e-07 of the scene's extent; float holds from 1.2e-04 on";
    const auto said = [&](const Arguments& more) {
        Arguments arguments{"small.json", "-o", "a.exr", "--stats", "s.stats.json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, 0) << result.error;
        const auto stats = nlohmann::json::parse(bytes_of(file("s.stats.json")));
        EXPECT_EQ(stats.at("context").at("precision"), precision());
        return result.error;
    };
    EXPECT_NE(said({}).find("render: double: " + facts + "\n"), std::string::npos);
    EXPECT_EQ(precision(), "double");
    EXPECT_NE(said({"--precision", "float"}).find("render: warning: float: " + facts), std::string::npos);
    EXPECT_EQ(precision(), "float");
    EXPECT_EQ(said({"--precision", "double"}).find("pebble"), std::string::npos);
    EXPECT_EQ(said({"-q"}), "");
    EXPECT_EQ(precision(), "double");
    const ProgramResult pixel = run({"small.json", "--pixel", "4,3", "--json", "-"});
    EXPECT_EQ(nlohmann::json::parse(pixel.out).at("precision"), "double");
    EXPECT_NE(pixel.error.find(facts), std::string::npos);
    expect_done({"s.json", "-o", "a.exr"});
    EXPECT_EQ(precision(), "float");
}

TEST_F(RenderProgram, ProgressAndSilence) {
    const Arguments film{"s.json", "-o", "a.##.exr"};
    const auto error_of = [&](const Arguments& more) {
        Arguments arguments = film;
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = run(arguments);
        EXPECT_EQ(result.code, 0) << result.error;
        EXPECT_EQ(result.out, "");
        return result.error;
    };
    EXPECT_EQ(error_of({"-q"}), "");
    const std::string plain = error_of({"--progress", "plain"});
    for (const char* part : {"frame 0 (1/3): 100 %", "frame 2 (3/3): 100 %", "ETA 0:00", "rays/s"})
        EXPECT_NE(plain.find(part), std::string::npos) << plain;
    EXPECT_EQ(plain.find('\r'), std::string::npos);
    EXPECT_EQ(error_of({"--progress", "none"}).find("ETA"), std::string::npos);
    EXPECT_EQ(error_of({}).find('\r'), std::string::npos);
    const std::string verbose = error_of({"-v"});
    EXPECT_NE(verbose.find("scene hash"), std::string::npos) << verbose;
    const size_t effects = verbose.find("; effects: texture, diffuse, ");
    ASSERT_NE(effects, std::string::npos) << verbose;
    EXPECT_NE(verbose.substr(effects, verbose.find('\n', effects) - effects).find(", refraction"), std::string::npos);
}

}  // namespace
}  // namespace cistula
