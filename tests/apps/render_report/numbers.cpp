// render-report's numbers: metrics, the front and its knee, the plan of settings, targets beside them, kept references.
#include <gtest/gtest.h>

#include <cmath>

#include "apps/render_report/html.h"
#include "apps/render_report/measure.h"
#include "apps/render_report/metrics.h"
#include "apps/render_report/options.h"
#include "apps/render_report/pareto.h"
#include "apps/render_report/reference.h"
#include "apps/render_report/sweep_plan.h"
#include "apps/render_report/target_table.h"
#include "testing/support/expect_error.h"

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
    film.pixels.begin(sums.size());
    for (size_t i = 0; i < sums.size(); ++i) {
        PixelRecord pixel = {};
        for (size_t c = 0; c < 3; ++c) pixel.radiance[c] = sums[i][c];
        film.pixels.set(i, pixel);
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
    film.pixels.change(1, [](PixelRecord& pixel) { pixel.pruned[0] = pixel.cut[0] = 8; });
    const Remainder remainder = remainder_of(film);
    EXPECT_EQ(remainder.max, 1);
    EXPECT_DOUBLE_EQ(remainder.mean, 1.0 / 6);
    EXPECT_DOUBLE_EQ(remainder.rms, std::sqrt(1.0 / 6));
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
        const auto plan = plan_sweep(base, quick);
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
    EXPECT_EQ(setting_name(setting).rfind("depth:4/", 0), 0u);
    setting = with_target(setting, 0.004);
    EXPECT_EQ(setting_name(setting), "target:0.004/float");
    EXPECT_EQ(setting_text(setting), "target error 0.004, float");
    EXPECT_EQ(command_line("a.json", 64, 48, setting, "embree"),
              "render a.json --res 64x48 --target-error 0.004 --precision float");
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

// ---- targets beside fixed settings

Entry entry_of(const Setting& setting, double rmse, double time, double samples) {
    Entry entry;
    entry.setting = setting;
    entry.error.rmse = rmse;
    entry.error.p999 = 3 * rmse;
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

TEST(TargetTable, KeepsTargetsInDoubleApart) {
    std::vector<Entry> entries = {grid_entry(4, 0.02, 16), target_entry(0.01, 0.02, 8, 8),
                                  target_entry(0.01, 0.01, 9, 7)};
    entries[2].setting.precision = Precision::double_;
    const TargetTable table = table_of(entries);
    ASSERT_EQ(table.rows.size(), 1u);
    EXPECT_EQ(table.rows[0].entry, &entries[1]);
    ASSERT_EQ(table.in_double.size(), 1u);
    EXPECT_EQ(table.in_double[0].entry, &entries[2]);
    EXPECT_EQ(table.uniform->closer, &entries[1]);
    const Json json = table;
    EXPECT_EQ(json.at("rows").size(), 1u);
    EXPECT_EQ(json.at("in_double").at(0).at("samples"), 7);
}

TEST(TargetTable, OnePixelFarOffMakesNoSettingAsClose) {
    std::vector<Entry> entries = {grid_entry(1, 0.1, 1), grid_entry(4, 0.02, 16), target_entry(0.01, 0.03, 8, 6)};
    entries[2].error.p999 = 0.01;  // a few pixels make its RMSE
    EXPECT_EQ(table_of(entries).rows[0].fixed, nullptr);
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
    reference.record.remainder = {0.25, 0.5, 1};
    const std::string bytes = pack_reference(reference, "key");
    const auto back = unpack_reference(bytes, "key");
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(back->picture.pixels, reference.picture.pixels);
    EXPECT_EQ(back->record.remainder.rms, 0.5);
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

}  // namespace
}  // namespace cistula::report
