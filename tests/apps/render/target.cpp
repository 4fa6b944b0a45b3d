// What is said of a frame with a target error: counts, and the rate that they allow.
#include <gtest/gtest.h>

#include "render/target.h"

using namespace cistula;

namespace {

TEST(Target, TheRateIsBoundedByThePixelsThatWereChecked) {
    // Tables of the binomial distribution, and 1 - 0.05^(1/n) where none is off.
    EXPECT_NEAR(rate_at_most(0, 1), 0.95, 1e-12);
    EXPECT_NEAR(rate_at_most(0, 100), 0.0295130, 1e-7);
    EXPECT_NEAR(rate_at_most(0, 3600), 0.00083180, 1e-8);
    EXPECT_NEAR(rate_at_most(1, 20), 0.2161062, 1e-6);
    EXPECT_NEAR(rate_at_most(5, 100), 0.1022534, 1e-6);
    EXPECT_EQ(rate_at_most(0, 0), 1);
    EXPECT_EQ(rate_at_most(7, 7), 1);
    double last = 0;
    for (uint64_t off = 0; off < 40; ++off) {
        const double rate = rate_at_most(off, 2000);
        EXPECT_GT(rate, last);
        EXPECT_GT(rate, double(off) / 2000);
        last = rate;
    }
}

TEST(Target, ChecksAreCountedApartFromWhatIsProven) {
    Film film;
    film.pixels.assign(4);
    film.samples = 256;
    film.pixels.change(1, [](PixelRecord& pixel) { pixel.checked = 1; });
    film.pixels.change(2, [](PixelRecord& pixel) { pixel.checked = pixel.off = 1; });
    FrameSettings settings;
    settings.target_error = 0.1;
    const TargetReport report = target_report(film, settings);
    EXPECT_EQ(report.checked, 2u);
    EXPECT_EQ(report.off, 1u);
    EXPECT_EQ(report.missed, 0u);
    EXPECT_TRUE(report.proven());
    TargetReport both = report;
    both.add(report);
    EXPECT_EQ(both.checked, 4u);
    EXPECT_EQ(both.off, 2u);
}

TEST(Target, WholeUnitsOfTheSumsCountAsTruncation) {
    Film film;
    PixelRecord pixel = {};
    pixel.samples = 256;
    pixel.rays = 256;
    film.pixels.assign(2, pixel);
    film.samples = 256;
    film.fixed_shift = 54;
    film.radiance_exponent = 40;
    pixel.rays = 256 << 10;  // 2^-4 of them
    film.pixels.set(1, pixel);
    FrameSettings settings;
    settings.target_error = 0.1;
    const TargetReport report = target_report(film, settings);
    EXPECT_EQ(report.worst_truncation, 0x1p-4);
    EXPECT_EQ(report.truncated, 1u);
    EXPECT_EQ(report.coarse, 1u);
    EXPECT_EQ(report.bushy, 0u);
    EXPECT_FALSE(report.proven());
    EXPECT_NE(
        describe_target(report, 2, settings, Precision::single_).find("1 lose more than a quarter of it to whole"),
        std::string::npos);
}

}  // namespace
