// render-report: metrics, the front, records and the page; the program from end to end on a small scene.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "apps/render_report/html.h"
#include "apps/render_report/html_page.h"
#include "apps/render_report/measure.h"
#include "apps/render_report/metrics.h"
#include "apps/render_report/options.h"
#include "apps/render_report/pareto.h"
#include "apps/render_report/png.h"
#include "apps/render_report/reference.h"
#include "apps/render_report/svg_chart.h"
#include "apps/render_report/sweep_plan.h"
#include "apps/render_report/target_table.h"
#include "expect_error.h"
#include "run_program.h"
#include "scene/film_difference.h"

namespace cistula::report {
namespace {

// ---- metrics

/// Two pixels of these sums, of which 2^4 are 1.
Film film_of(const std::vector<std::array<int64_t, 3>>& sums, int samples = 1) {
    Film film;
    film.full_width = film.rect.width = static_cast<int>(sums.size());
    film.full_height = film.rect.height = 1;
    film.fixed_shift = 4;
    film.samples = samples;
    for (const auto& sum : sums) {
        PixelRecord pixel = {};
        for (size_t c = 0; c < 3; ++c) pixel.radiance[c] = sum[c];
        film.pixels.push_back(pixel);
    }
    return film;
}

TEST(Metrics, ResolveAFilmByItsScale) {
    Film film = film_of({{16, 8, 0}}, 2);
    film.radiance_exponent = 3;
    const Picture picture = resolve_picture(film);
    EXPECT_EQ(picture.pixels.at(0), (std::array<double, 3>{4, 2, 0}));  // 16 / 2^4 / 2 * 2^3
}

TEST(Metrics, AreKnownForTwoPixels) {
    const Picture reference = resolve_picture(film_of({{16, 16, 16}, {32, 0, 0}}));
    const Picture picture = resolve_picture(film_of({{16, 16, 16}, {32, 8, 0}}));
    const Metrics m = compare_with(picture, reference);
    EXPECT_EQ(m.max, 0.5);
    EXPECT_DOUBLE_EQ(m.rmse, std::sqrt(0.25 / 6));
    EXPECT_DOUBLE_EQ(m.relative_mse, 0.25 / relative_epsilon / 6);
    EXPECT_EQ(m.peak, 2);
    EXPECT_DOUBLE_EQ(m.psnr(), 20 * std::log10(2 / std::sqrt(0.25 / 6)));
    EXPECT_EQ(m.over_half_code, 0.5);
    EXPECT_EQ(m.worst_x, 1);
    EXPECT_EQ(m.worst_y, 0);
    EXPECT_EQ(m.worst_here, (std::array<double, 3>{2, 0.5, 0}));
    EXPECT_EQ(m.worst_reference, (std::array<double, 3>{2, 0, 0}));
}

TEST(Metrics, OfThePictureItselfAreZero) {
    const Picture picture = resolve_picture(film_of({{1, 2, 3}, {4, 5, 6}}));
    const Metrics m = compare_with(picture, picture);
    EXPECT_EQ(m.max, 0);
    EXPECT_EQ(m.rmse, 0);
    EXPECT_EQ(m.over_half_code, 0);
    EXPECT_TRUE(std::isinf(m.psnr()));
    EXPECT_EQ(Json(m).at("psnr"), "inf");
}

TEST(Metrics, AThousandthOfThePixelsMayLieBeyondTheQuantile) {
    for (const size_t count : {size_t{999}, size_t{1000}, size_t{3000}}) {
        std::vector<std::array<int64_t, 3>> sums(count, {0, 0, 0}), off = sums;
        for (size_t i = 0; i < count; ++i) off[i][i % 3] = -static_cast<int64_t>(i);
        const Metrics m = compare_with(resolve_picture(film_of(off)), resolve_picture(film_of(sums)));
        EXPECT_EQ(m.max, static_cast<double>(count - 1) / 16);
        EXPECT_EQ(m.p999, static_cast<double>(count - 1 - count / 1000) / 16) << count;
        EXPECT_EQ(Json(m).get<Metrics>().p999, m.p999);
    }
}

TEST(Metrics, ShareOverCountsPixelsOnceAndNotThoseOnTheLine) {
    const Picture reference = resolve_picture(film_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
    const Picture picture = resolve_picture(film_of({{0, 0, 0}, {8, 0, 0}, {9, -9, 9}, {0, 0, -16}}));
    EXPECT_EQ(share_over(0.5, picture, reference), 0.5);
    EXPECT_EQ(share_over(0.49, picture, reference), 0.75);
    EXPECT_EQ(share_over(1, picture, reference), 0);
    EXPECT_THROW(share_over(1, picture, resolve_picture(film_of({{0, 0, 0}}))), std::invalid_argument);
}

TEST(Metrics, RefusePicturesOfTwoSizes) {
    EXPECT_THROW(compare_with(resolve_picture(film_of({{1, 2, 3}})), resolve_picture(film_of({{1, 2, 3}, {1, 2, 3}}))),
                 std::invalid_argument);
}

TEST(Metrics, TheRemainderIsTheWholeLedger) {
    Film film = film_of({{0, 0, 0}, {0, 0, 0}});
    film.pixels[1].pruned[0] = 8;
    film.pixels[1].cut[0] = 8;
    const Remainder remainder = remainder_of(film);
    EXPECT_EQ(remainder.max, 1);
    EXPECT_DOUBLE_EQ(remainder.mean, 1.0 / 6);
    EXPECT_DOUBLE_EQ(remainder.rms, std::sqrt(1.0 / 6));
}

TEST(FilmDifference, CountsEveryIntegerOfAPixel) {
    const Film a = film_of({{1, 2, 3}, {4, 5, 6}});
    Film b = a;
    EXPECT_EQ(film_difference(a, b).compared, 2 * 18 + 5u);
    EXPECT_EQ(film_difference(a, b).differing, 0u);
    b.pixels[0].radiance[2] += 1;
    b.pixels[1].rays += 1;
    b.pixels[0].samples += 1;
    b.pixels[0].unmet = 1;
    b.pixels[1].normal[0] = -0.0f;  // another bit
    b.rays.shadow = 7;
    EXPECT_EQ(film_difference(a, b).differing, 6u);
    b.pixels.pop_back();
    EXPECT_EQ(film_difference(a, b).differing, film_difference(a, b).compared);
}

// ---- the front

TEST(Pareto, FrontHasWhatNothingBeats) {
    const std::vector<CostPoint> points = {{1, 1}, {2, 2}, {2, 0.5}, {4, 0.5}, {8, 0.1}, {1, 3}};
    EXPECT_EQ(pareto_front(points), (std::vector<size_t>{0, 2, 4}));
    EXPECT_TRUE(pareto_front({}).empty());
    EXPECT_EQ(pareto_front({{1, 1}, {2, 0.995}}), (std::vector<size_t>{0}));  // closer by a hair
    EXPECT_EQ(pareto_front({{1, 1}, {2, 0.995}}, 0), (std::vector<size_t>{0, 1}));
}

TEST(Pareto, KneeIsTheCornerOfAnL) {
    // Falls by a thousand at no time, then nothing more for a thousand times the time.
    const std::vector<CostPoint> points = {{1, 1}, {1.1, 0.001}, {10, 0.0009}, {1000, 0.0008}};
    EXPECT_EQ(knee_of(points, pareto_front(points)), 1u);
}

TEST(Pareto, KneeOfAStraightLineIsItsBeginning) {
    const std::vector<CostPoint> points = {{1, 1}, {10, 0.1}, {100, 0.01}};
    const auto knee = knee_of(points, pareto_front(points));
    ASSERT_TRUE(knee.has_value());
    EXPECT_EQ(knee_of({}, {}), std::nullopt);
    EXPECT_EQ(knee_of({{1, 1}}, {0}), 0u);
}

TEST(Pareto, PriceOfADigit) {
    const std::vector<CostPoint> points = {{1, 1}, {2, 0.1}, {4, 0.01}};
    EXPECT_NEAR(time_per_digit(points, {0, 1, 2}).value(), 2, 1e-12);
    EXPECT_EQ(time_per_digit(points, {0, 1}), std::nullopt);
}

TEST(Timing, MedianAndRange) {
    EXPECT_EQ((Timing{{3, 1, 2}}).median(), 2);
    EXPECT_EQ((Timing{{4, 1, 2, 3}}).median(), 2.5);
    EXPECT_EQ((Timing{{4, 1}}).least(), 1);
    EXPECT_EQ((Timing{{4, 1}}).most(), 4);
    EXPECT_EQ(Timing{}.median(), 0);
}

// ---- the plan

TEST(SweepPlan, HasEverySettingOnceAndEveryKnob) {
    for (const bool quick : {false, true}) {
        Setting base;
        base.depth = 5;
        const auto plan = plan_sweep(base, quick, {"native"});
        std::map<std::string, size_t> of_knob;
        for (size_t i = 0; i < plan.size(); ++i) {
            for (size_t j = 0; j < i; ++j) EXPECT_FALSE(plan[i].setting == plan[j].setting);
            for (const auto& [knob, alone] : plan[i].alone) {
                ++of_knob[knob];
                EXPECT_FALSE(alone == plan[i].setting) << knob;
            }
        }
        for (const Knob& knob : knobs()) EXPECT_GE(of_knob[knob.name], 4u) << knob.name;
        EXPECT_EQ(of_knob.size(), knobs().size());
        EXPECT_EQ(plan[0].setting, base);
    }
}

TEST(Setting, CommandLineSaysAll) {
    Setting setting;
    setting.depth = 7;
    setting.cutoff = 0.002;
    setting.precision = Precision::double_;
    setting.supersample = 3;
    EXPECT_EQ(
        command_line("scenes/a.json", 64, 48, setting, "cuda"),
        "render scenes/a.json --res 64x48 --supersample 3 --depth 7 --cutoff 0.002 --precision double --backend cuda");
    EXPECT_EQ(Json(setting).get<Setting>(), setting);
}

TEST(Setting, ATargetStandsForSamplesAndCutoff) {
    Setting setting;
    setting.supersample = 3;
    setting.cutoff = 0.5;
    setting.intersector = "native";
    EXPECT_EQ(setting_name(setting).rfind("depth:4/", 0), 0u);
    setting = with_target(setting, 0.004);
    EXPECT_EQ(setting_name(setting), "target:0.004/float/native");
    EXPECT_EQ(setting_text(setting), "target error 0.004, float, native");
    EXPECT_EQ(command_line("a.json", 64, 48, setting, "embree"),
              "render a.json --res 64x48 --target-error 0.004 --precision float --intersector native");
    setting.intersector = "exact";
    setting.precision = Precision::double_;
    EXPECT_EQ(command_line("a.json", 64, 48, setting, "cuda"),
              "render a.json --res 64x48 --target-error 0.004 --precision double --backend cuda");
    EXPECT_EQ(Json(setting).get<Setting>(), setting);
    const FrameSettings frame = frame_settings(setting, 64, 48);
    EXPECT_EQ(frame.target_error, 0.004);
    EXPECT_EQ(frame.depth, 1024);
    EXPECT_EQ(frame.truncation(), 0.001);
    EXPECT_EQ(frame.grid(), 16);
    EXPECT_EQ(frame_settings(Setting(), 64, 48).target_error, 0);
}

TEST(Intersectors, NativeIsEmbreesAlone) {
    std::map<std::string, const Intersector*> by_name;
    for (const Intersector& one : intersectors()) by_name[one.name] = &one;
    ASSERT_EQ(by_name.count("native"), 1u);
    EXPECT_TRUE(by_name["native"]->offered(Backend::embree));
    EXPECT_FALSE(by_name["native"]->offered(Backend::cuda));
    EXPECT_TRUE(by_name["exact"]->offered(Backend::cuda));
}

// ---- targets beside fixed settings

Entry entry_of(const Setting& setting, double rmse, double time, double samples) {
    Entry entry;
    entry.setting = setting;
    entry.error.rmse = rmse;
    entry.wall.runs = {time};
    entry.samples = samples;
    if (setting.adaptive()) entry.target = TargetOutcome{0.25, 3};
    return entry;
}

Entry grid_entry(int supersample, double rmse, double time) {
    Setting setting;
    setting.supersample = supersample;
    return entry_of(setting, rmse, time, supersample * supersample);
}

Entry target_entry(double target, double rmse, double time, double samples) {
    return entry_of(with_target(Setting(), target), rmse, time, samples);
}

TargetTable table_of(const std::vector<Entry>& entries) {
    std::vector<const Entry*> all;
    for (const Entry& entry : entries) all.push_back(&entry);
    return target_table(all);
}

TEST(TargetTable, FindsTheQuickestFixedSettingThatIsAsClose) {
    const std::vector<Entry> entries = {grid_entry(1, 0.1, 1),  grid_entry(2, 0.05, 4),  target_entry(0.01, 0.01, 8, 6),
                                        grid_entry(3, 0.05, 3), grid_entry(4, 0.02, 16), target_entry(0.1, 0.05, 6, 4)};
    const TargetTable table = table_of(entries);
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.rows[0].entry, &entries[5]);  // the larger target first
    EXPECT_EQ(table.rows[0].fixed, &entries[3]);
    EXPECT_EQ(table.rows[0].ratio(), 2);
    EXPECT_EQ(table.rows[1].entry, &entries[2]);
    EXPECT_EQ(table.rows[1].fixed, nullptr);
    const Json json = table;
    EXPECT_EQ(json.at("rows").at(0).at("fixed"), "depth:4/cutoff:0/float/samples:3x3");
    EXPECT_EQ(json.at("rows").at(0).at("ratio"), 2);
    EXPECT_EQ(json.at("rows").at(0).at("over_target"), 0.25);
    EXPECT_EQ(json.at("rows").at(1).at("fixed"), "none");
    EXPECT_FALSE(json.at("rows").at(1).contains("ratio"));
}

TEST(TargetTable, InterpolatesTheSamplesForTheErrorOfAGrid) {
    // The error falls by four while the samples double: half of that, in the logarithm, is at 8 / sqrt(2).
    std::vector<Entry> entries = {grid_entry(4, 0.02, 16), grid_entry(8, 0.001, 64), grid_entry(4, 0.03, 15),
                                  target_entry(0.1, 0.04, 6, 4), target_entry(0.01, 0.01, 8, 8)};
    TargetTable table = table_of(entries);
    ASSERT_TRUE(table.uniform.has_value());
    EXPECT_EQ(table.uniform->uniform, &entries[0]);
    EXPECT_EQ(table.uniform->farther, &entries[3]);
    EXPECT_EQ(table.uniform->closer, &entries[4]);
    EXPECT_NEAR(table.uniform->samples, 8 / std::sqrt(2.0), 1e-12);
    EXPECT_EQ(Json(table).at("uniform").at("adaptive"), "interpolated");

    entries[3].error.rmse = 0.015;  // the first is closer already
    table = table_of(entries);
    EXPECT_EQ(table.uniform->closer, &entries[3]);
    EXPECT_EQ(table.uniform->samples, 4);
    EXPECT_EQ(Json(table).at("uniform").at("adaptive"), "first target");

    entries[3].error.rmse = entries[4].error.rmse = 0.05;  // none is
    table = table_of(entries);
    EXPECT_EQ(table.uniform->closer, nullptr);
    EXPECT_EQ(Json(table).at("uniform").at("adaptive"), "none");
    EXPECT_FALSE(Json(table).at("uniform").contains("adaptive_samples"));

    entries[3].error.rmse = 0.04;
    entries[4].error.rmse = 0;  // without a logarithm
    EXPECT_EQ(table_of(entries).uniform->samples, 8);
    EXPECT_FALSE(table_of({entries[3]}).uniform.has_value());
    EXPECT_TRUE(table_of({entries[0]}).rows.empty());
}

// ---- the cache

TEST(Reference, ComesBackFromItsBytes) {
    ReferencePicture reference;
    reference.picture = resolve_picture(film_of({{1, 2, 3}, {4, 5, 6}}));
    reference.yardstick.remainder = {0.25, 0.5, 1};
    const std::string bytes = pack_reference(reference, "key");
    const auto back = unpack_reference(bytes, "key");
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(back->picture.pixels, reference.picture.pixels);
    EXPECT_EQ(back->yardstick.remainder.rms, 0.5);
    EXPECT_FALSE(unpack_reference(bytes, "another key"));
    EXPECT_FALSE(unpack_reference("", "key"));
    EXPECT_FALSE(unpack_reference("{}\n", "key"));
    EXPECT_FALSE(unpack_reference("[1]\nx", "key"));
    for (const size_t at : {size_t{5}, bytes.size() - 1}) {
        std::string damaged = bytes;
        damaged[at] ^= 1;
        EXPECT_FALSE(unpack_reference(damaged, "key")) << at;
    }
    EXPECT_FALSE(unpack_reference(bytes.substr(0, bytes.size() - 8), "key"));
}

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
    size_t native = 0;
    for (const Entry& entry : record.entries) {
        EXPECT_EQ(entry.wall.runs.size(), 3u);
        EXPECT_DOUBLE_EQ(static_cast<double>(entry.rays.primary), 32 * 18 * entry.samples);
        if (!entry.setting.adaptive()) {
            EXPECT_EQ(entry.samples, entry.setting.supersample * entry.setting.supersample);
        }
        if (entry.setting.intersector == "native") ++native;
        if (entry.alone.count("depth")) by_depth[entry.setting.depth] = entry.alone.at("depth").rmse;
    }
    ASSERT_GE(by_depth.size(), 4u);
    for (auto at = std::next(by_depth.begin()); at != by_depth.end(); ++at)
        EXPECT_LE(at->second, std::prev(at)->second) << "depth " << at->first;
    EXPECT_GT(by_depth.begin()->second, 0);
    EXPECT_GE(native, 4u);
    const Json table = Json::parse(text).at("targets").at("small");
    std::vector<const Entry*> entries;
    for (const Entry& entry : record.entries) entries.push_back(&entry);
    EXPECT_EQ(Json(target_table(entries)), table);
    ASSERT_EQ(table.at("rows").size(), 4u);
    for (size_t i = 0; i < 4; ++i) {
        const Json& row = table.at("rows").at(i);
        EXPECT_GE(row.at("samples"), 4);
        EXPECT_LE(row.at("samples"), 256);
        EXPECT_EQ(row.at("missed"), 0);
        EXPECT_LE(row.at("rmse"), row.at("target_error"));
        if (i == 0) continue;
        EXPECT_LT(row.at("rmse"), table.at("rows").at(i - 1).at("rmse"));
        EXPECT_GT(row.at("samples"), table.at("rows").at(i - 1).at("samples"));
    }
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
    for (const char* part : {"dot s6", "error = target", "quickest fixed setting as close", "Beside a uniform grid",
                             "Intersector: native against the exact one"})
        EXPECT_NE(page.find(part), page.npos) << part;
    EXPECT_LT(page.size(), 400000u);
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
