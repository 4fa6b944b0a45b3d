// `render-compare suite` from outside: what holds, what does not and how that is said, what --update changes, files.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>

#include <nlohmann/json.hpp>

#include "apps/common/command_line.h"
#include "image/exr/exr.h"
#include "image/picture/picture_hash.h"
#include "sequence/backends.h"
#include "testing/support/gpu.h"
#include "testing/support/run_program.h"

namespace cistula {
namespace {

using Words = std::vector<std::string>;
namespace fs = std::filesystem;

constexpr const char* cube_scene = R"({"film": {"width": 24, "height": 16, "frames": 8}, "depth": 3,
    "camera": {"path": {"position": {"r0": 5, "z0": 2, "wphi": 10}}}, "materials": {"m": {"reflection": 0.5}},
    "objects": [{"solid": "cube", "material": "m"}], "lights": [{"position": [3, -4, 5]}]})";

/// A folder s with a suite of one scene; the program runs beside it.
class SuiteProgram : public ::testing::Test {
  protected:
    SuiteProgram() {
        fs::create_directory(file("s"));
        put_bytes(file("s/cube.json"), cube_scene);
    }
    std::string file(const std::string& name) const { return folder_.file(name); }
    std::string text(const std::string& name) const { return bytes_of(file(name)); }
    nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(text(name)); }

    /// suite.json of these cases, each a text without its braces and its scene.
    void cases(const Words& list, const std::string& defaults = "") const {
        std::string all;
        for (const std::string& one : list) all += (all.empty() ? "    {" : ",\n    {") + one + "}";
        put_bytes(file("s/suite.json"), "{\n  \"defaults\": {\"scene\": \"cube.json\"" +
                                            (defaults.empty() ? "" : ", " + defaults) + "},\n  \"cases\": [\n" + all +
                                            "\n  ]\n}\n");
    }
    ProgramResult run(Words words) const {
        words.insert(words.begin(), {"suite", "s"});
        return RunningProgram(CISTULA_BIN_DIR "/render-compare", words, file("")).wait();
    }
    std::string expect(int code, const Words& words = {}) const {
        const ProgramResult result = run(words);
        EXPECT_EQ(result.code, code) << result.out << result.error;
        EXPECT_EQ(result.error, "");
        return result.out;
    }
    void expect_has(const std::string& out, const std::string& part) const {
        EXPECT_NE(out.find(part), std::string::npos) << out << "\nhas no " << part;
    }
    void expect_refused_suite(const Words& words, ExitCode code, const std::string& part) const {
        const ProgramResult result = run(words);
        EXPECT_EQ(result.code, static_cast<int>(code)) << result.out << result.error;
        EXPECT_EQ(result.error.rfind("render-compare: ", 0), 0u) << result.error;
        EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
        EXPECT_NE(result.error.find(part), std::string::npos) << result.error << "\nhas no " << part;
    }
    void render(Words words, const std::string& to) const {
        words.insert(words.begin(), {"s/cube.json", "-q", "-o", to});
        const ProgramResult result = RunningProgram(CISTULA_BIN_DIR "/render", words, file("")).wait();
        ASSERT_EQ(result.code, 0) << result.error;
    }
    void change(const std::string& exr, const std::function<void(LayeredPicture&)>& how) const {
        LayeredPicture picture = read_exr(file(exr));
        how(picture);
        write_exr(file(exr), picture);
    }

    const ScratchDirectory folder_;
};

TEST_F(SuiteProgram, PicturesAreThoseThatRenderWrites) {
    cases(
        {R"("name": "plain", "golden": "plain.exr")",
         R"("name": "all", "golden": "g/all.####.exr", "frames": "2-6x4", "resolution": [32, 20], "crop": [20, 10, 4, 2],
              "supersample": 2, "depth": 2, "cutoff": 0.01, "precision": "double", "layers": "N,id,cryptomatte",
              "bits": "half", "background": "transparent", "colorspace": "lin_ap1_scene")",
         R"("name": "target", "golden": "target.exr", "target_error": 0.05, "max_samples": 64, "layers": "samples,Z",
              "z_far": "inf")"});
    render({}, "s/plain.exr");
    render({"-f",
            "2-6x4",
            "--res",
            "32x20",
            "--crop",
            "20x10+4+2",
            "--supersample",
            "2",
            "--depth",
            "2",
            "--cutoff",
            "0.01",
            "--precision",
            "double",
            "--layers",
            "N,id,cryptomatte",
            "--bits",
            "half",
            "--background",
            "transparent",
            "--colorspace",
            "lin_ap1_scene"},
           "s/g/all.####.exr");
    render({"--target-error", "0.05", "--max-samples", "64", "--layers", "samples,Z", "--z-far", "inf"},
           "s/target.exr");
    const std::string out = expect(0);
    expect_has(out, "hold: all 4 pictures\n");
    EXPECT_EQ(out.find("header"), std::string::npos) << out;
    const std::string plain = text("s/plain.exr"), half = text("s/g/all.0006.exr");
    fs::remove(file("s/plain.exr"));
    fs::remove_all(file("s/g"));
    expect(0, {"--update"});
    EXPECT_EQ(text("s/plain.exr"), plain);
    EXPECT_EQ(text("s/g/all.0006.exr"), half);
}

TEST_F(SuiteProgram, WhatDiffersIsSaidAndTheOthersGoOn) {
    cases(
        {R"("name": "gone", "golden": "gone.exr")", R"("name": "size", "golden": "size.exr", "resolution": [12, 8])",
         R"("name": "layers", "golden": "layers.exr", "layers": "Z")", R"("name": "damaged", "golden": "damaged.exr")",
         R"("name": "scene", "scene": "none.json", "golden": "a.exr")",
         R"("name": "crop", "golden": "good.exr", "crop": [10, 10, 20, 0])",
         R"("name": "light", "golden": "good.exr", "layers": "Combined_key")",
         R"("name": "value", "golden": "value.exr")", R"("name": "bare")", R"("name": "good", "golden": "good.exr")"});
    for (const char* name : {"size", "damaged", "value", "good"}) render({}, "s/" + std::string(name) + ".exr");
    render({"--layers", "N"}, "s/layers.exr");
    put_bytes(file("s/damaged.exr"), text("s/damaged.exr").substr(0, 500));
    change("s/value.exr", [](LayeredPicture& picture) { picture.channels[1].values[24 * 3 + 5] = 9; });
    const std::string out = expect(1, {"--json", "r.json", "--junit", "r.xml"});
    expect_has(out, "no golden image: s/gone.exr is not there; --update gone records it\n");
    expect_has(out, "another size: 24x16 in the golden image, 12x8 rendered\n");
    expect_has(out, "layers of the golden image alone: N.X, N.Y, N.Z; layers that the golden image lacks: Z\n");
    expect_has(out, "failed: s/damaged.exr: cannot read");
    expect_has(out, "failed: s/none.json: cannot read the scene");
    expect_has(out, "failed: /cases/5: \"crop\" 10x10+20+0: leaves the frame, which is 24x16\n");
    expect_has(out, "failed: --layers Combined_key: the scene has no such group of lights");
    expect_has(out, "differ: 1 of 1536 floats differ; worst: B at (5, 3): 9 / ");
    expect_has(out, "neither \"golden\" nor \"hash\" says what is expected; --update bare records it\n");
    expect_has(out, "24x16    0.0");
    expect_has(out, "\ndiffer: 9 of 10 pictures\n");
    const auto result = json("r.json");
    EXPECT_FALSE(result.at("holds").get<bool>());
    EXPECT_EQ(result.at("parity"), nlohmann::json({{"compared", 10}, {"differing", 9}}));
    Words outcomes;
    for (const auto& one : result.at("cases")) outcomes.push_back(one.at("outcome"));
    EXPECT_EQ(outcomes, (Words{"missing", "differs", "differs", "broken", "broken", "broken", "broken", "differs",
                               "missing", "holds"}));
    const auto& value = result.at("cases")[7];
    EXPECT_EQ(value.at("comparison").at("channels")[1].at("differing"), 1);
    EXPECT_EQ(value.at("precision"), "float");
    EXPECT_EQ(value.at("hash"), picture_hash(read_exr(file("s/good.exr"))));
    const std::string xml = text("r.xml");
    expect_has(xml, R"(<testsuites tests="10" failures="5" errors="4" skipped="0" time=")");
    expect_has(xml, R"(<testcase classname="s" name="value" time=")");
    expect_has(xml, R"(<failure type="differs" message="differ: 1 of 1536 floats differ; worst: B at (5, 3): 9 / )");
    expect_has(xml, R"(says what is expected; --update bare records it"/>)");
    expect_has(xml, R"(neither &quot;golden&quot; nor)");
    EXPECT_EQ(expect(1, {"-q"}), "");
}

TEST_F(SuiteProgram, HeadersAreComparedAndDoNotDecide) {
    cases({R"("name": "a", "golden": "a.exr")"});
    render({}, "s/a.exr");
    change("s/a.exr", [](LayeredPicture& picture) {
        picture.attributes["cistula:version"] = std::string("0.0.7");
        picture.attributes["owner"] = std::string("<me>");
        picture.compression = Compression::none;
    });
    expect_has(expect(0, {"--json", "r.json", "--junit", "r.xml"}), "  equal\n");
    const auto notes = json("r.json").at("cases")[0].at("notes");
    EXPECT_EQ(notes.at(0), "recorded by version 0.0.7, rendered by " CISTULA_VERSION);
    EXPECT_EQ(notes.at(2), "header: owner: <me> / (none)");
    expect_has(text("r.xml"), "header: owner: &lt;me&gt; / (none)\n");
    change("s/a.exr", [](LayeredPicture& picture) { picture.channels[0].half = true; });
    expect_has(expect(1), "recorded by version 0.0.7, rendered by " CISTULA_VERSION ": differ: ");
}

TEST_F(SuiteProgram, ThresholdsAreThoseOfTwoImages) {
    cases({R"("name": "within", "golden": "a.exr", "thresholds": {"hardfail": 0.5})",
           R"("name": "percent", "golden": "a.exr", "thresholds": {"fail": 0.1, "failpercent": 1})",
           R"("name": "over", "golden": "a.exr", "thresholds": {"fail": 0.1})",
           R"("name": "bits", "golden": "a.exr")"});
    render({}, "s/a.exr");
    change("s/a.exr", [](LayeredPicture& picture) { picture.channels[0].values[7] += 0.25f; });
    const std::string out = expect(1, {"--json", "r.json"});
    expect_has(out, "within the thresholds: 0 pixels over --hardfail 0.5\n");
    expect_has(out, "\ndiffer: 2 of 4 pictures\n");
    EXPECT_EQ(json("r.json").at("cases")[1].at("outcome"), "holds");
}

TEST_F(SuiteProgram, WhatIsNotFinitePassesNoThreshold) {
    render({}, "s/a.exr");
    render({}, "s/b.exr");
    const auto put_nan = [](LayeredPicture& picture) { picture.channels[2].values[3] = NAN; };
    for (const std::string name : {"s/theirs.exr", "s/same.exr"}) {
        render({}, name);
        change(name, put_nan);
    }
    const auto one = [](const std::string& name, const std::string& golden, const std::string& thresholds) {
        return fmt::format(R"("name": "{}", "rendered": "theirs.exr", "golden": "{}", "thresholds": {{{}}})", name,
                           golden, thresholds);
    };
    cases({one("ssim", "a.exr", R"("failssim": 0.5)"),
           one("anyway", "a.exr", R"("failssim": 0.5, "allow_nonfinite": true)"),
           one("percent", "a.exr", R"("fail": 1, "failpercent": 50)"), one("both", "same.exr", R"("fail": 1)"),
           one("said", "same.exr", R"("failssim": 0.5, "allow_nonfinite": true)")});
    const std::string out = expect(1);
    expect_has(out, "\ndiffer: 4 of 5 pictures\n");
    expect_has(out, "1 value is not finite in one, or differently in both; the first: G at (3, 0): ");
    expect_has(out,
               "1 value is not finite in both; the first: G at (3, 0): nan / nan; --allow-nonfinite lets these pass");
    expect(0, {"said"});
}

TEST_F(SuiteProgram, HashesHoldAndSayWhatRecordedThem) {
    cases({R"("name": "a", "layers": "N")", R"("name": "film", "frames": "0-2")"});
    expect_has(expect(0, {"--update"}), "\nrecorded: 4 of 4 pictures\n");
    expect_has(expect(0), "hold: all 4 pictures\n");
    render({"--layers", "N", "--compression", "piz"}, "a.exr");
    const auto suite = json("s/suite.json");
    EXPECT_EQ(suite.at("cases")[0].at("hash"), picture_hash(read_exr(file("a.exr"))));
    EXPECT_EQ(suite.at("cases")[0].at("recorded"),
              nlohmann::json({{"version", CISTULA_VERSION}, {"precision", "float"}}));
    EXPECT_EQ(suite.at("cases")[1].at("hash").size(), 3u);

    const std::string hash = suite.at("cases")[0].at("hash");
    const auto recorded = [&](const std::string& what) {
        cases({R"("name": "a", "layers": "N", "precision": "double", "hash": ")" + hash + "\"" + what});
        return expect(1);
    };
    expect_has(recorded(""), "  the hash is ");
    expect_has(recorded(R"(, "recorded": {"version": "0.0.7", "precision": "float"})"),
               "  recorded in float by version 0.0.7, rendered in double by " CISTULA_VERSION ": the hash is ");
    expect_has(recorded(R"(, "recorded": {"version": "0.0.7", "precision": "double"})"),
               "  recorded by version 0.0.7, rendered by " CISTULA_VERSION ": the hash is ");
}

TEST_F(SuiteProgram, TheFilmsIntegersCountWhereTheyAreAskedFor) {
    const std::string none(32, '0');
    cases({R"("name": "a", "golden": "a.exr", "film_hash": ")" + none + "\""});
    render({"--stats", "stats.json"}, "s/a.exr");
    const std::string film = json("stats.json").at("benchmarks").back().at("film_hash");
    expect_has(expect(1), "  equal; the film's integers differ: film_hash is " + film + ", " + none + " is expected\n");
    expect_has(expect(0, {"--update"}), "recorded: film_hash is " + film + ", was " + none + "\n");
    EXPECT_EQ(json("s/suite.json").at("cases")[0].at("film_hash"), film);
    expect_has(expect(0), "hold: all 1 pictures\n");
}

TEST_F(SuiteProgram, UpdatesWhatDiffersAndNothingElse) {
    cases({R"("name": "a", "golden": "a.exr")", R"("name": "b", "golden": "b.exr")",
           R"("name": "c", "golden": "c.exr", "thresholds": {"fail": 100})", R"("name": "bad", "scene": "none.json")"},
          R"("layers": "Z")");
    for (const char* name : {"a", "b", "c"}) render({"--layers", "Z"}, "s/" + std::string(name) + ".exr");
    for (const char* name : {"s/b.exr", "s/c.exr"})
        change(name, [](LayeredPicture& picture) { picture.channels[0].values[7] += 0.25f; });
    const std::string a = text("s/a.exr"), b = text("s/b.exr"), suite = text("s/suite.json");
    expect_has(expect(0, {"--update", "c"}), "recorded: s/c.exr is written; before, within the thresholds: ");
    EXPECT_EQ(text("s/c.exr"), a);
    EXPECT_EQ(text("s/b.exr"), b);
    const std::string out = expect(1, {"--update"});
    expect_has(out, "  unchanged\n");
    expect_has(out, "recorded: s/b.exr is written; before, differ: 1 of 1920 floats differ; worst: ");
    expect_has(out, "failed: s/none.json: cannot read");
    expect_has(out, "\nrecorded: 1 of 4 pictures; 1 failed\n");
    EXPECT_EQ(text("s/b.exr"), a);
    EXPECT_EQ(text("s/suite.json"), suite);
}

TEST_F(SuiteProgram, UpdateKeepsTheFormOfTheFile) {
    cases({"\n      \"name\": \"a\", // the first\n      \"frames\": \"0-1\"\n    ", R"("name": "b")"});
    expect(0, {"--update"});
    const std::string suite = text("s/suite.json");
    expect_has(suite, "      \"name\": \"a\", // the first\n      \"frames\": \"0-1\",\n      \"hash\": [\n        \"");
    expect_has(suite, "\"\n      ],\n      \"recorded\": {\"version\": \"" CISTULA_VERSION
                      "\", \"precision\": \"float\"}\n    },\n");
    expect_has(suite, "    {\"name\": \"b\", \"hash\": \"");
    expect(0);
    EXPECT_EQ(text("s/suite.json"), suite);
}

TEST_F(SuiteProgram, CasesAreChosenByNamesAndTags) {
    cases({R"("name": "glass/a", "tags": ["smoke"])", R"("name": "glass/b")",
           R"("name": "glass", "tags": ["slow", "x"])"});
    const auto listed = [&](Words words) {
        words.push_back("--list");
        return expect(0, words);
    };
    EXPECT_EQ(listed({}), "glass/a\tsmoke\nglass/b\t\nglass\tslow,x\n");
    EXPECT_EQ(listed({"glass"}), "glass\tslow,x\n");
    EXPECT_EQ(listed({"--filter", "glass"}), "glass\tslow,x\n");
    EXPECT_EQ(listed({"--filter", "glass/*"}), "glass/a\tsmoke\nglass/b\t\n");
    EXPECT_EQ(listed({"--filter", "?low", "--filter", "smoke"}), "glass/a\tsmoke\nglass\tslow,x\n");
    EXPECT_EQ(listed({"glass", "glass/a", "--filter", "smoke"}), "glass/a\tsmoke\n");
    expect_refused_suite({"glas"}, ExitCode::usage, "glas: s/suite.json has no such case; the cases are: glass");
    expect_refused_suite({"--filter", "smok"}, ExitCode::usage,
                         "--filter smok: s/suite.json has no such case; the names "
                         "and tags are: smoke");
    expect_refused_suite({"glass/b", "--filter", "smoke"}, ExitCode::usage, "no case has both");
}

TEST_F(SuiteProgram, SeveralAtOnceSayTheSameInTheSameOrder) {
    Words list;
    for (int i = 0; i < 12; ++i)
        list.push_back(R"("name": "c)" + std::to_string(i) + R"(", "frames": )" + std::to_string(i % 5) +
                       (i == 3 || i == 9 ? R"(, "golden": "none.exr")" : ""));
    cases(list);
    const auto parts = [&](const Words& words) {
        expect(1, words);
        auto all = json("r.json").at("cases");
        for (auto& one : all) one.erase("render_seconds");
        return all;
    };
    expect(0, {"c0", "c1", "c2", "c4", "c5", "--update", "--jobs", "3"});
    const auto alone = parts({"--json", "r.json"});
    EXPECT_EQ(alone.size(), 12u);
    EXPECT_EQ(parts({"--json", "r.json", "--jobs", "5"}), alone);
    const std::string out = expect(1, {"--fail-fast", "--json", "r.json"});
    expect_has(out, "\ndiffer: 1 of 4 pictures; 8 cases not rendered\n");
    EXPECT_EQ(json("r.json").at("not_begun"), 8);
}

TEST_F(SuiteProgram, ThePageShowsWhatDiffersAndWhy) {
    cases({R"("name": "grid", "golden": "grid.exr", "supersample": 2)", R"("name": "scene", "golden": "scene.exr")",
           R"("name": "bare", "golden": "bare.exr")", R"("name": "value", "golden": "value.exr")",
           R"("name": "good", "golden": "good.exr")"});
    for (const char* name : {"grid", "scene", "bare", "value", "good"}) render({}, "s/" + std::string(name) + ".exr");
    const auto brighter = [](LayeredPicture& picture) { picture.channels[0].values[24 * 3 + 5] = 7; };
    change("s/bare.exr", [&](LayeredPicture& picture) {
        brighter(picture);
        picture.attributes.clear();
    });
    change("s/scene.exr", [&](LayeredPicture& picture) {
        brighter(picture);
        picture.attributes["cistula:sceneHash"] = std::string("another");
    });
    change("s/value.exr", brighter);
    expect(1, {"--html", "page"});
    const std::string page = text("page/index.html");
    EXPECT_EQ(page.find("http"), std::string::npos);
    expect_has(page, "src=\"data:image/png;base64,");
    expect_has(page, "<a href=\"#failure4\">value</a>");
    EXPECT_EQ(page.find("failure5"), std::string::npos);
    expect_has(page, "; depth 3, cutoff 0, float, one sample");  // of the golden image of `grid`, by its header
    expect_has(page, "; depth 3, cutoff 0, float, 4 samples");
    expect_has(page, "<h3>Pixel 5,3</h3>");
    expect_has(page, "its header does not name a scene.</p>");
    expect_has(page, "it shows the scene, or the camera, as it was before a change.</p>");
    expect_has(page, "this version gets others from the scene and the settings that its header names.</p>");
    expect_has(page, "render-compare suite 's' value --update");
}

/// What a header claims decides neither memory nor time.
TEST_F(SuiteProgram, ForgedGoldenImagesCostNothing) {
    if (needs_all_memory) GTEST_SKIP() << "the sanitizer needs memory for itself";
    put_bytes(file("s/box.json"), R"({"film": {"width": 8, "height": 6}, "depth": 3, "cutoff": 0.01,
        "ambient": 1, "background": 1,
        "materials": {"m": {"reflection": 0.5, "transmission": 0.5, "diffuse": 0}},
        "camera": {"position": [0, 5, 1], "target": [0, 0, 0]},
        "objects": [{"solid": "cube", "material": "m"}, {"solid": "icosahedron", "center": [2, 0, 0], "material": "m"}]})");
    cases({R"("name": "a", "golden": "a.exr", "scene": "box.json")"});
    expect(0, {"--update"});
    const std::string good = text("s/a.exr");
    const auto page_of = [&](int depth, int supersample, double cutoff) {
        put_bytes(file("s/a.exr"), good);
        change("s/a.exr", [&](LayeredPicture& picture) {
            picture.channels[0].values[27] = 9;
            picture.attributes["cistula:depth"] = depth;
            picture.attributes["cistula:supersample"] = supersample;
            picture.attributes["cistula:cutoff"] = cutoff;
        });
        const ProgramResult result =
            RunningProgram("/bin/sh",
                           {"-c", "ulimit -v 4000000; exec " CISTULA_BIN_DIR "/render-compare suite s --html page"},
                           file(""))
                .wait();
        EXPECT_EQ(result.code, 1) << result.error;
        return text("page/index.html");
    };
    expect_has(page_of(1024, 64, 0), "only its values are known: the pixel's rays branch too often");
    for (const double cutoff : {-1.0, std::nan("")})
        expect_has(page_of(3, 1, cutoff), "its header names no grid of samples to follow");
}

TEST_F(SuiteProgram, AnInterruptionLeavesWhatIsKnown) {
    cases({R"("name": "a", "golden": "none.exr")", R"("name": "b", "resolution": [1600, 900], "supersample": 64)"});
    RunningProgram program(CISTULA_BIN_DIR "/render-compare",
                           {"suite", "s", "--junit", "r.xml", "--json", "r.json", "--html", "page"}, file(""));
    ASSERT_TRUE(program.wait_until(
        [&] { return program.output_so_far().find("none.exr is not there") != std::string::npos; }, 60));
    program.send(SIGUSR1);  // is render's alone
    program.send(SIGTERM);
    const auto start = std::chrono::steady_clock::now();
    const ProgramResult result = program.wait();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
    EXPECT_EQ(result.code, 130);
    EXPECT_EQ(result.error, "render-compare: interrupted; 1 of 2 cases are judged\n");
    EXPECT_EQ(json("r.json").at("not_begun"), 1);
    EXPECT_FALSE(json("r.json").at("holds").get<bool>());
    expect_has(text("r.xml"), R"(<testsuites tests="1" failures="1")");
    expect_has(text("page/index.html"), ">a</a>");
}

TEST_F(SuiteProgram, CasesThatAreNotChosenCostNothing) {
    std::string tags;
    for (int i = 0; i < 20'000; ++i) tags += (i == 0 ? "\"t" : ", \"t") + std::to_string(i) + "\"";
    cases({R"("name": "a")", R"("name": "many", "frames": "0-999999", "golden": "####.exr", "tags": [)" + tags + "]",
           R"("name": "fifo", "scene": "fifo.json")"});
    ASSERT_EQ(mkfifo(file("s/fifo.json").c_str(), 0600), 0);
    put_bytes(file("r.json"), "");
    const auto start = std::chrono::steady_clock::now();
    expect(0, {"a", "--update", "--json", "r.json"});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
    expect_refused_suite({"a", "--json", "s/0123.exr"}, ExitCode::usage, "the golden image of many and --json");
    expect_has(expect(1, {"fifo"}), "s/fifo.json: cannot read: it is a pipe");
}

TEST_F(SuiteProgram, NamesOfAllCharactersMakeWholeXml) {
    cases({"\"name\": \"a\", \"scene\": \"\xef\xbf\xbe\xef\xbf\xbf<&.json\""});
    expect(1, {"--junit", "r.xml"});
    expect_has(text("r.xml"), "\\ufffe\\uffff&lt;&amp;.json");
}

TEST_F(SuiteProgram, UpdatesOfOneSuiteAtOnceLoseNothing) {
    cases({R"("name": "a", "resolution": [200, 150])", R"("name": "b", "resolution": [201, 150])"});
    RunningProgram first(CISTULA_BIN_DIR "/render-compare", {"suite", "s", "a", "--update"}, file(""));
    expect(0, {"b", "--update"});
    EXPECT_EQ(first.wait().code, 0);
    expect_has(expect(0), "hold: all 2 pictures\n");
}

TEST_F(SuiteProgram, AnUpdateKeepsWhatChangedMeanwhile) {
    cases({R"("name": "a")", R"("name": "b")"}, R"("resolution": [900, 600], "supersample": 4)");
    RunningProgram program(CISTULA_BIN_DIR "/render-compare", {"suite", "s", "--update"}, file(""));
    ASSERT_TRUE(program.wait_until([&] { return program.output_so_far().find("\na ") != std::string::npos; }, 60));
    cases({R"("name": "b")", R"("name": "a", "depth": 2)", R"("name": "c")"},
          R"("resolution": [900, 600], "supersample": 4)");
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.code, 3);
    expect_has(result.error,
               "s/suite.json: was changed while its cases were rendered; the hashes of these are not "
               "recorded: a; run --update for them again\n");
    const auto after = json("s/suite.json").at("cases");
    EXPECT_TRUE(after.at(0).contains("hash"));
    EXPECT_FALSE(after.at(1).contains("hash") || after.at(2).contains("hash"));
}

TEST_F(SuiteProgram, NothingIsWrittenOutsideOfItsFolder) {
    fs::create_directories(file("out"));
    fs::create_directory_symlink(file("out"), file("s/link"));
    cases({R"("name": "up", "golden": "../out/a.exr")", R"("name": "link", "golden": "link/b.exr")",
           R"("name": "whole", "golden": ")" + file("out/c.exr") + "\"", R"("name": "in", "golden": "g/../d.exr")"});
    const std::string out = expect(1, {"--update"});
    expect_has(out, "is outside of s, the suite's folder");
    expect_has(out, "recorded: 1 of 4 pictures; 3 failed\n");
    EXPECT_TRUE(fs::is_empty(file("out")));
    EXPECT_TRUE(fs::exists(file("s/d.exr")));
}

TEST_F(SuiteProgram, PicturesOfOtherProgramsAreCases) {
    render({}, "s/golden.exr");
    render({}, "theirs.exr");
    change("theirs.exr", [](LayeredPicture& picture) {
        std::erase_if(picture.channels, [](const auto& channel) { return channel.name == "A"; });
        picture.channels[0].values[7] += 0.001f;
        picture.attributes.clear();
    });
    const std::string command = R"("command": ["sh", "-c", "cp ../theirs.exr \"$0\"", "{output}"], )";
    cases({R"("name": "file", "rendered": "../theirs.exr", "golden": "golden.exr", "thresholds": {"fail": 0.01})",
           R"("name": "bits", "rendered": "../theirs.exr", "golden": "golden.exr")",
           R"("name": "run", )" + command + R"("golden": "golden.exr", "thresholds": {"failssim": 0.9})",
           R"("name": "hash", )" + command + R"("frames": "0-1")",
           R"("name": "bad", "command": ["sh", "-c", "echo no scene; exit 3", "{output}"], "golden": "golden.exr")"});
    std::string out = expect(1, {"--json", "r.json", "--html", "page"});
    expect_has(out, " command ");
    expect_has(out, "within the thresholds: 0 of 384 pixels (0 %) over --fail 0.01");
    expect_has(out, "layers of the golden image alone: A");
    expect_has(out, "its command is not run: sh -c ");
    EXPECT_EQ(json("r.json").at("cases")[0].at("backend"), "file");
    expect_has(text("page/index.html"), "another program rendered it");
    expect(0, {"hash", "--update", "--run-commands"});
    out = expect(1, {"--run-commands"});
    expect_has(out, "within the thresholds: least SSIM ");
    expect_has(out, "failed: sh ended with exit code 3: no scene\\n\n");
    expect_has(out, "\ndiffer: 2 of 6 pictures\n");
    cases({R"("name": "a", "rendered": "a.exr", "depth": 3)"});
    expect_refused_suite({}, ExitCode::usage, "another program renders; leave it out");
    cases({R"("name": "a", "command": ["sh"])"});
    expect_refused_suite({}, ExitCode::usage, "{output}");
}

TEST_F(SuiteProgram, ManyJobsWithLittleMemoryAreALineEach) {
    if (needs_all_memory) GTEST_SKIP() << "the sanitizer needs memory for itself";
    cases({R"("name": "a")", R"("name": "b")", R"("name": "c")"});
    expect(0, {"--update"});
    const ProgramResult result =
        RunningProgram("/bin/sh",
                       {"-c", "ulimit -v 1500000; exec " CISTULA_BIN_DIR "/render-compare suite s --jobs 1024"},
                       file(""))
            .wait();
    EXPECT_TRUE(result.code == 0 || result.code == 1) << result.code << result.error;
    EXPECT_LE(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
}

TEST_F(SuiteProgram, ABackendThatIsNotThereIsSkippedOrRefused) {
    if (test::missing_gpu().empty()) GTEST_SKIP() << "this machine has a GPU";
    cases({R"("name": "both", "golden": "a.exr", "backends": ["cuda", "embree"])",
           R"("name": "gpu", "golden": "a.exr", "backends": ["cuda"])", R"("name": "cpu", "golden": "a.exr")"});
    render({}, "s/a.exr");
    const std::string out = expect(0, {"--junit", "r.xml"});
    expect_has(out, "\nhold: all 2 pictures; 2 skipped\n");
    expect_has(text("r.xml"), R"(name="both [cuda]" time="0.000">)");
    expect_has(text("r.xml"), "<skipped message=\"");
    expect_has(expect(4, {"gpu"}), "\nnothing was compared; 1 skipped\n");
    expect_refused_suite({"--backend", "cuda"}, ExitCode::device, "");
    expect_refused_suite({"cpu", "--backend", "cuda"}, ExitCode::usage, "no case that is asked for names it");
    expect_has(expect(0, {"--backend", "embree"}), "\nhold: all 2 pictures\n");
}

TEST_F(SuiteProgram, CudaHoldsTheSameGoldenImages) {
    CISTULA_NEEDS_GPU();
    cases({R"("name": "a", "golden": "a.exr", "layers": "N,Z", "backends": ["embree", "cuda"])"});
    render({"--layers", "N,Z"}, "s/a.exr");
    expect_has(expect(0), "\nhold: all 2 pictures\n");
}

TEST_F(SuiteProgram, RefusesInOneLine) {
    cases({R"("name": "a", "golden": "a.exr")", R"("name": "b", "golden": "./a.exr")"});
    render({}, "s/a.exr");
    const std::string good = text("s/a.exr");
    expect_refused_suite({"--json", "s/a.exr"}, ExitCode::usage, "the golden image of a and --json");
    expect_refused_suite({"--junit", "s/cube.json"}, ExitCode::usage, "--junit");
    expect_refused_suite({"--json", "s/suite.json"}, ExitCode::usage, "the suite and --json");
    expect_refused_suite({"--json", "x", "--junit", "./x"}, ExitCode::usage, "--junit and --json");
    expect_refused_suite({"--update"}, ExitCode::usage, "the golden image of a and the golden image of b");
    expect_refused_suite({"--fliter", "a"}, ExitCode::usage, "did you mean '--filter'?");
    expect_refused_suite({"--jobs", "0"}, ExitCode::usage, "--jobs 0: must be a whole number from 1 to 1024");
    expect_refused_suite({"--device", "0"}, ExitCode::usage, "add --backend cuda");
    EXPECT_EQ(text("s/a.exr"), good);
    put_bytes(file("s/suite.json"), "{\"cases\": [{\"nam\": 1}]}");
    expect_refused_suite({}, ExitCode::usage, "s/suite.json: /cases/0/nam: unknown key; did you mean 'name'?");
    fs::remove(file("s/suite.json"));
    expect_refused_suite({}, ExitCode::file, "s/suite.json: cannot read");
    const ProgramResult help = run({"--help"});
    EXPECT_EQ(help.code, 0);
    expect_has(help.out, "Exit codes: 0 all cases hold");
    EXPECT_EQ(help.out.find_first_of("{}"), std::string::npos) << help.out;
}

}  // namespace
}  // namespace cistula
