// render-report's page: texts, drawings, records; the program from end to end on a small scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "apps/render_report/html.h"
#include "apps/render_report/html_page.h"
#include "apps/render_report/image.h"
#include "apps/render_report/measure.h"
#include "apps/render_report/svg_chart.h"
#include "apps/render_report/target_table.h"
#include "testing/support/endless_scene.h"
#include "testing/support/run_program.h"

namespace cistula::report {
namespace {

// ---- numbers and drawings

TEST(Text, OfNumbers) {
    EXPECT_EQ(number_text(0), "0");
    EXPECT_EQ(number_text(0.00123), "0.00123");
    EXPECT_EQ(number_text(0.0001), "10⁻⁴");
    EXPECT_EQ(number_text(3.4e-7), "3.4·10⁻⁷");
    EXPECT_EQ(number_text(1e7), "10⁷");
    EXPECT_EQ(number_text(9.99e-5), "10⁻⁴");
    EXPECT_EQ(time_text(0.7712), "0.771 ms");
    EXPECT_EQ(time_text(1234), "1.23 s");
    EXPECT_EQ(count_text(1234567), "1,234,567");
    EXPECT_EQ(count_text(999), "999");
    EXPECT_EQ(percent_text(0.25), "25 %");
    EXPECT_EQ(escaped("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
}

TEST(Chart, TicksAreRound) {
    EXPECT_EQ(ticks(0.5, 2000, true), (std::vector<double>{1, 10, 100, 1000}));
    EXPECT_EQ(ticks(0, 4, false), (std::vector<double>{0, 1, 2, 3, 4}));
    EXPECT_FALSE(ticks(3, 4, true).empty());
    // Values that no chart shows, as damaged records have them.
    EXPECT_TRUE(ticks(0, 1e308, true).empty());
    EXPECT_TRUE(ticks(-1e308, 1e308, false).empty());
    EXPECT_LE(ticks(1e16, 1e16 + 2, false).size(), 32u);
}

TEST(Chart, LeavesOutWhatCannotBeDrawn) {
    Chart chart;
    ChartSeries series;
    for (const double y : {1.0, 10.0, 0.0, -1.0, std::nan(""), double(INFINITY)})
        series.points.push_back({1, y, 0, 0, "", false});
    chart.series = {series};
    const std::string svg = chart_svg(chart);
    EXPECT_EQ(svg.find("nan"), svg.npos);
    EXPECT_EQ(svg.find("inf"), svg.npos);
    size_t dots = 0;
    for (size_t at = 0; (at = svg.find("<circle", at)) != svg.npos; ++at) ++dots;
    EXPECT_EQ(dots, 2u);
}

TEST(Chart, DiamondsStandApart) {
    Chart chart;
    ChartSeries series;
    series.points.push_back({1, 1, 0, 0, "here", false});
    series.shape = DotShape::diamond;
    series.label = "a";
    series.color = 6;
    chart.series = {series, series};
    EXPECT_EQ(chart_svg(chart).find("<circle"), std::string::npos);
    EXPECT_NE(chart_svg(chart).find("<path class=\"dot s6\""), std::string::npos);
    EXPECT_NE(chart_legend(chart).find("key s6 diamond"), std::string::npos);
}

TEST(Png, IsOneAndBase64IsRight) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    ColorPicture picture{2, 1, {glm::vec3(0), glm::vec3(1)}};
    const Image image = to_image(picture);
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.png.substr(0, 11), base64("\x89PNG\r\n\x1a\n").substr(0, 11));
    EXPECT_EQ(to_heat_image(2, 1, {1, 100}).png.substr(0, 10), image.png.substr(0, 10));
}

// ---- records and pages

constexpr const char* small_scene = R"({
    "film": {"width": 32, "height": 18}, "depth": 3, "camera": {"position": [0, -4, 2], "target": [0, 0, 1], "fov": 60},
    "materials": {
        "glass": {"color": [0.9, 0.5, 0.2], "diffuse": 0.8, "specular": 0.4, "reflection": 0.2, "transmission": 0.5},
        "floor": {"color": 0.8, "diffuse": 0.8, "reflection": 0.2}
    },
    "objects": [
        {"name": "body", "solid": "octahedron", "center": [0, 0, 1], "radius": 1, "material": "glass"},
        {"name": "floor", "quad": [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]], "material": "floor"}
    ],
    "lights": [{"position": [-2, -2, 3]}, {"position": [3, 0, 4]}]
})";

/// Elements that are closed in order, no more and no less.
std::string unbalanced(const std::string& page) {
    static const std::set<std::string> single = {"meta", "img", "br", "!doctype"};
    std::vector<std::string> open;
    const std::regex tag(R"(<(/?)([!a-z0-9]+)((?:[^<>"]|"[^"]*")*?)(/?)>)");
    size_t brackets = 0, tags = 0;
    for (const char c : page) brackets += c == '<';
    for (std::sregex_iterator at(page.begin(), page.end(), tag), end; at != end; ++at, ++tags) {
        const std::string name = (*at)[2];
        if (single.count(name) || (*at)[4] == "/") continue;
        if ((*at)[1] != "/") {
            open.push_back(name);
        } else {
            if (open.empty() || open.back() != name)
                return "</" + name + "> after <" + (open.empty() ? "" : open.back());
            open.pop_back();
        }
    }
    if (!open.empty()) return "<" + open.back() + "> stays open";
    return tags == brackets ? "" : "a < that begins no tag";
}

class Program : public testing::Test {
  protected:
    Program() { put_bytes(folder.file("small.json"), small_scene); }

    ProgramResult run(const std::vector<std::string>& arguments) {
        return RunningProgram(std::string(CISTULA_BIN_DIR) + "/render-report", arguments, folder.file("")).wait();
    }

    ScratchDirectory folder;
};

TEST_F(Program, MeasuresASmallSceneAndShowsItFromItsRecord) {
    const ProgramResult result =
        run({"small.json", "--quick", "--cache", "cache", "--limit", "5", "--json", "r.json", "-o", "r.html"});
    ASSERT_EQ(result.code, 0) << result.error;
    EXPECT_NE(result.error.find("small: reference"), std::string::npos) << result.error;
    const std::string text = bytes_of(folder.file("r.json")), page = bytes_of(folder.file("r.html"));

    const Record record = parse_record(text, "r.json");
    EXPECT_EQ(record_text(record), text);
    EXPECT_EQ(report_page({record}), page);
    const ProgramResult again = run({"--from", "r.json", "-o", "again.html"});
    ASSERT_EQ(again.code, 0) << again.error;
    EXPECT_EQ(bytes_of(folder.file("again.html")), page);

    // What was measured is what the knobs promise.
    ASSERT_EQ(record.scenes.size(), 1u);
    const SceneRecord& scene = record.scenes[0];
    std::map<int, double> by_depth;
    for (const Entry& entry : record.entries) {
        EXPECT_EQ(entry.wall.runs.size(), 3u);
        EXPECT_DOUBLE_EQ(static_cast<double>(entry.rays.primary), 32 * 18 * entry.samples);
        if (!entry.setting.adaptive()) {
            EXPECT_EQ(entry.samples, entry.setting.supersample * entry.setting.supersample);
        }
        if (entry.alone.count("depth")) by_depth[entry.setting.depth] = entry.alone.at("depth").rmse;
    }
    ASSERT_GE(by_depth.size(), 4u);
    for (auto at = std::next(by_depth.begin()); at != by_depth.end(); ++at)
        EXPECT_LE(at->second, std::prev(at)->second) << "depth " << at->first;
    EXPECT_GT(by_depth.begin()->second, 0);
    // Whatever quicker settings take, what is within the limit is there.
    EXPECT_EQ(scene.left_out, std::vector<std::string>());
    const std::string full_lattice = "depth:256/cutoff:0.002/float/samples:16x16";
    EXPECT_TRUE(std::any_of(record.entries.begin(), record.entries.end(),
                            [&](const Entry& entry) { return setting_name(entry.setting) == full_lattice; }));
    const Json table = Json::parse(text).at("targets").at("small");
    std::vector<const Entry*> entries;
    for (const Entry& entry : record.entries) entries.push_back(&entry);
    EXPECT_EQ(Json(target_table(entries)), table);
    ASSERT_EQ(table.at("rows").size(), 5u);
    for (size_t i = 0; i < 5; ++i) {
        const Json& row = table.at("rows").at(i);
        EXPECT_GE(row.at("samples"), 4);
        EXPECT_LE(row.at("samples"), 256);
        EXPECT_EQ(row.at("missed"), 0);
        EXPECT_LE(row.at("rmse"), row.at("target_error"));
        if (i == 0) continue;
        EXPECT_LT(row.at("rmse"), table.at("rows").at(i - 1).at("rmse"));
        EXPECT_GT(row.at("samples"), table.at("rows").at(i - 1).at("samples"));
    }
    ASSERT_EQ(table.at("in_double").size(), 4u);
    EXPECT_EQ(table.at("in_double").at(3).at("target_error"), 0.004);
    EXPECT_EQ(table.at("in_double").at(3).at("missed"), 0);
    EXPECT_EQ(table.at("uniform").at("samples"), 16);
    uint64_t rays = 0;
    for (const Level& level : scene.levels) rays += level.rays.total();
    for (const Entry& entry : record.entries) {
        if (entry.setting == scene.base) {
            EXPECT_EQ(entry.rays.total(), rays);
        }
    }
    ASSERT_EQ(scene.parity.size(), 4u);  // bvh and brute in two precisions
    for (const ParityCase& one : scene.parity) EXPECT_EQ(one.differing, 0u);
    EXPECT_EQ(Json::parse(text).at("parity").at("differing"), 0);
    EXPECT_EQ(scene.mirror.value, 0.2);
    EXPECT_EQ(scene.strongest.value, 0.5);

    // A page that needs nothing else.
    EXPECT_EQ(unbalanced(page), "");
    EXPECT_EQ(page.find("http"), page.npos);
    EXPECT_EQ(page.find("<script"), page.npos);
    EXPECT_EQ(page.find("url("), page.npos);
    for (const char* id : {"pareto", "knobs", "where", "seed", "parity", "verify", "machine", "scaling"}) {
        EXPECT_NE(page.find(std::string("<section id=\"") + id), page.npos) << id;
        EXPECT_NE(page.find(std::string("href=\"#") + id), page.npos) << id;
    }
    EXPECT_NE(page.find("lang=\"en\""), page.npos);
    EXPECT_NE(page.find("render small.json --res 32x18"), page.npos);
    for (const char* part : {"dot s6", "error = target", "quickest fixed setting as close", "Beside a uniform grid"})
        EXPECT_NE(page.find(part), page.npos) << part;
    EXPECT_LT(page.size(), 400000u);
}

TEST_F(Program, StopsSettingsThatTakeTooLongAndNamesThem) {
    const ProgramResult result = run({"small.json", "--quick", "--repetitions", "1", "--res", "80x45", "--threads", "1",
                                      "--no-cache", "--limit", "0.05", "--json", "r.json", "-o", "r.html"});
    ASSERT_EQ(result.code, 0) << result.error;
    const Record record = parse_record(bytes_of(folder.file("r.json")), "r.json");
    ASSERT_EQ(record.scenes.size(), 1u);
    const std::vector<std::string>& left_out = record.scenes[0].left_out;
    const std::string full_lattice = "depth:256/cutoff:0.002/float/samples:16x16";
    EXPECT_NE(std::find(left_out.begin(), left_out.end(), full_lattice), left_out.end());
    for (const Entry& entry : record.entries)
        EXPECT_EQ(std::find(left_out.begin(), left_out.end(), setting_name(entry.setting)), left_out.end());
    EXPECT_FALSE(record.entries.empty());
    EXPECT_NE(bytes_of(folder.file("r.html")).find(full_lattice), std::string::npos);
}

TEST_F(Program, GivesUpWhereTheReferenceHasNoEnd) {
    put_bytes(folder.file("room.json"), test::room_of_mirrors_text);
    const ProgramResult result =
        run({"room.json", "--quick", "--res", "16x9", "--no-cache", "--limit", "0.01", "-o", "r.html"});
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.error.find("room.json: the reference, depth:256/"), std::string::npos) << result.error;
    EXPECT_NE(result.error.find("ray trees have no end"), std::string::npos) << result.error;
    EXPECT_FALSE(std::filesystem::exists(folder.file("r.html")));
}

TEST_F(Program, ShowsVerdictsAndTheSeedsTimes) {
    Record record;
    record.context = {{"cpu", "Z80"}, {"num_cpus", 1}, {"host_name", "here"}, {"backend", "embree"}};
    put_bytes(folder.file("r.json"), record_text(record));
    put_bytes(
        folder.file("verify.json"),
        R"({"context": {"cpu": "Z80"}, "cases": [{"case": "geometry/a", "intersector": "bvh", "precision": "float",
              "worst": 3, "bound": "inf", "unit": "rays", "holds": false, "exact": "a < b", "complaint": "3 of 9 failed"}]})");
    put_bytes(folder.file("seed.json"),
              R"({"context": {"cpu": "Z80", "num_cpus": 1, "host_name": "there", "scene": "small.json"}, "benchmarks": [
              {"name": "seed/32x18/depth:4/cpu", "repetition_times": [5, 7, 6]}]})");
    const ProgramResult result =
        run({"--from", "r.json", "--verify", "verify.json", "--seed-baseline", "seed.json", "-o", "r.html"});
    ASSERT_EQ(result.code, 0) << result.error;
    const std::string page = bytes_of(folder.file("r.html"));
    EXPECT_NE(page.find("0 of 1 hold"), page.npos);
    EXPECT_NE(page.find("3 of 9 failed"), page.npos);
    EXPECT_NE(page.find("a &lt; b"), page.npos);
    EXPECT_NE(page.find("6 ms<small>5 ms to 7 ms"), page.npos);
    EXPECT_NE(page.find("no speed-up is given"), page.npos);
    EXPECT_EQ(unbalanced(page), "");
}

TEST_F(Program, HelpShowsEveryOptionAsItIsWritten) {
    const ProgramResult help = run({"--help"});
    EXPECT_EQ(help.code, 0) << help.error;
    EXPECT_NE(help.out.find("  --scaling "), std::string::npos) << help.out;
    EXPECT_EQ(help.out.find_first_of("{}"), std::string::npos) << help.out;
}

TEST_F(Program, RefusesWhatIsWrong) {
    put_bytes(folder.file("bad.json"), "{\"context\": {}}");
    const struct {
        std::vector<std::string> arguments;
        int code;
        const char* message;
    } cases[] = {
        {{"-o", "r.html"}, 2, "no scene is given"},
        {{"small.json"}, 2, "nothing would be written"},
        {{"small.json", "-o", "r.html", "--res", "12"}, 2, "--res 12"},
        {{"small.json", "-o", "r.html", "--repetitions", "0"}, 2, "--repetitions 0"},
        {{"small.json", "-o", "r.html", "--limit", "-1"}, 2, "--limit -1"},
        {{"small.json", "-o", "r.html", "--quik"}, 2, "did you mean '--quick'?"},
        {{"small.json", "-o", "r.html", "--scaling=all"}, 2, "--scaling all"},
        {{"small.json", "small.json", "-o", "r.html", "--scaling=only"}, 2, "looks at one scene"},
        {{"small.json", "--seed-baseline", "bad.json", "-o", "r.html", "--scaling=only"}, 2, "measures none"},
        {{"small.json", "-o", "small.json"}, 2, "a file of its own"},
        {{"small.json", "-o", "r.html", "--json", "r.html"}, 2, "a file of its own"},
        {{"small.json", "--from", "r.json", "-o", "r.html"}, 2, "a scene and --from"},
        {{"--from", "r.json", "--quick", "-o", "r.html"}, 2, "--quick: is for measuring"},
        {{"--from", "none.json", "-o", "r.html"}, 3, "none.json"},
        {{"--from", "bad.json", "-o", "r.html"}, 3, "is no record of render-report"},
        {{"small.json", "--verify", "bad.json", "-o", "r.html"}, 3, "is no record of render-verify"},
        {{"small.json", "--seed-baseline", "bad.json", "-o", "r.html"}, 3, "is no record of seed_baseline"},
        {{"small.json", "-o", "no/such/r.html"}, 3, "no/such/r.html"},
        {{"none.json", "-o", "r.html", "-q"}, 3, "none.json"},
        {{"bad.json", "-o", "r.html", "-q"}, 2, "bad.json"},
    };
    for (const auto& one : cases) {
        const ProgramResult result = run(one.arguments);
        EXPECT_EQ(result.code, one.code) << one.message << "\n" << result.error;
        EXPECT_NE(result.error.find(one.message), std::string::npos) << result.error;
        EXPECT_EQ(result.error.rfind("render-report: ", 0), 0u) << result.error;
        EXPECT_FALSE(std::filesystem::exists(folder.file("r.html"))) << one.message;
    }
}

TEST_F(Program, ScalingByItselfIsARecordToShowBesideOthers) {
    const ProgramResult result =
        run({"small.json", "--quick", "--repetitions", "1", "--scaling=only", "-q", "--json", "s.json"});
    ASSERT_EQ(result.code, 0) << result.error;
    const Record record = parse_record(bytes_of(folder.file("s.json")), "s.json");
    EXPECT_TRUE(record.scenes.empty());
    EXPECT_TRUE(record.entries.empty());
    std::vector<std::string> names;
    for (const ScalingSeries& series : record.scaling) {
        names.push_back(series.name);
        EXPECT_GE(series.points.size(), 3u) << series.name;
    }
    EXPECT_EQ(names, (std::vector<std::string>{"triangles", "lights", "depth", "pixels"}));
    ASSERT_EQ(run({"--from", "s.json", "-o", "s.html"}).code, 0);
    EXPECT_NE(bytes_of(folder.file("s.html")).find("Time against triangles"), std::string::npos);
}

TEST_F(Program, AnInterruptionLeavesNothing) {
    RunningProgram program(std::string(CISTULA_BIN_DIR) + "/render-report",
                           {"small.json", "--res", "640x360", "--no-cache", "-o", "r.html", "--json", "r.json"},
                           folder.file(""));
    ASSERT_TRUE(program.wait_until([&] { return program.error_so_far().find("small:") != std::string::npos; }, 20));
    program.send(SIGINT);
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.code, 130);
    EXPECT_NE(result.error.find("interrupted"), std::string::npos) << result.error;
    EXPECT_EQ(folder.names(), std::vector<std::string>{"small.json"});
}

TEST(SeedTable, IsOfThisMachineOnlyIfAllAgrees) {
    const Json gpu = {{"cpu", "a"}, {"num_cpus", 4}, {"gpu", "H"}, {"driver", "580"}};
    Json context = {{"cpu", "a"}, {"num_cpus", 4}, {"devices", {"H"}}, {"gpu_driver", "580"}};
    EXPECT_TRUE(is_same_machine(gpu, context));
    for (const auto& [key, value] :
         {std::pair<const char*, Json>("cpu", "b"), {"num_cpus", 5}, {"devices", {"H", "H"}}, {"gpu_driver", "581"}}) {
        Json other = context;
        other[key] = value;
        EXPECT_FALSE(is_same_machine(gpu, other)) << key;
    }
    context.erase("devices");
    EXPECT_FALSE(is_same_machine(gpu, context));
    EXPECT_FALSE(is_same_machine(Json::object(), Json::object()));
}

}  // namespace
}  // namespace cistula::report
