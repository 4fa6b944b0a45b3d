// The lattice of adaptive sampling, with made-up samples: which of them a pixel wants, and what they stand for.
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "cistula/adaptive/lattice.h"
#include "testing/support/scene.h"

using namespace cistula;

namespace {

/// A pixel of made-up samples: value(column, row) is a sample's radiance in all channels, hash(column, row) its path
/// hash, rays(column, row) its tree's rays.
template <class Value, class Hash, class Rays>
PixelRecord sampled(const LatticeSettings& settings, const Value& value, const Hash& hash, const Rays& rays,
                    std::set<std::pair<int, int>>* taken = nullptr, bool checked = false) {
    LatticePixel pixel;
    LatticeSample samples[lattice_samples];
    PixelRecord record = PixelRecord();
    for (pixel.begin(checked); pixel.wanted() > 0;) {
        for (int i = 0; i < pixel.wanted(); ++i) {
            const int slot = pixel.wanted(i), column = slot % lattice_side, row = slot / lattice_side;
            EXPECT_TRUE(slot >= 0 && slot < lattice_samples);
            if (taken) {
                EXPECT_TRUE(taken->insert({column, row}).second) << "twice: " << column << ", " << row;
            }
            PixelRecord sample = PixelRecord();
            for (int c = 0; c < 3; ++c) {
                sample.radiance[c] = value(column, row);
                sample.pruned[c] = value(row, column) / 3;
                sample.cut[c] = c;
            }
            sample.hits = 1;
            sample.rays = rays(column, row);
            samples[slot].keep(sample, hash(column, row), 0);
            if (LatticePixel::is_chosen(slot)) record.id = 100 + slot;
        }
        for (int i = pixel.cells(); i-- > 0;) pixel.judge(settings, samples, i);  // in any order
        pixel.divide(settings, samples);
    }
    for (int i = pixel.cells(); i-- > 0;)
        pixel.accumulate(i, [&](int slot, int weight) {
            samples[slot].give(record, weight, [](auto& to, auto more) { to += more; });
        });
    pixel.describe(record);
    return record;
}

template <class Value, class Hash>
PixelRecord sampled(const LatticeSettings& settings, const Value& value, const Hash& hash,
                    std::set<std::pair<int, int>>* taken = nullptr) {
    return sampled(
        settings, value, hash, [](int, int) { return 1u; }, taken);
}

LatticeSettings lattice(double target, int most = lattice_samples) {
    LatticeSettings settings;
    settings.target = int64_t(std::ldexp(target, color_bits));
    settings.most = most;
    return settings;
}

int64_t fixed(double radiance) {
    return int64_t(radiance * 0x1p54);
}

uint32_t one_kind(int, int) {
    return 7;
}

TEST(Lattice, AllDifferentTakesEverySampleOnceAndAddsThemUp) {
    for (uint64_t seed = 0; seed < 50; ++seed) {
        test::Random random(seed);
        std::array<std::array<int64_t, 16>, 16> values;
        for (auto& row : values)
            for (int64_t& value : row) value = fixed(random.unit());
        std::set<std::pair<int, int>> taken;
        const PixelRecord record = sampled(
            lattice(0x1p-29), [&](int x, int y) { return values[size_t(y)][size_t(x)]; },
            [](int x, int y) { return uint32_t(16 * y + x); }, &taken);
        EXPECT_EQ(taken.size(), 256u);
        EXPECT_EQ(record.samples, 256u);
        EXPECT_EQ(record.unmet, 0u);
        EXPECT_EQ(record.hits, 256u);
        EXPECT_EQ(record.id, 100 + 8 + 16 * 8);
        int64_t sum = 0, pruned = 0;
        for (size_t y = 0; y < 16; ++y)
            for (size_t x = 0; x < 16; ++x) sum += values[y][x], pruned += values[y][x] / 3;
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(record.radiance[c], sum);
            EXPECT_EQ(record.pruned[c], pruned);
            EXPECT_EQ(record.cut[c], 256 * c);
        }
    }
}

TEST(Lattice, WeightsAddUpToAllSamplesHoweverItSplits) {
    for (const double target : {0.5, 0.1, 0.02, 0.004, 0.0005})
        for (uint64_t seed = 0; seed < 100; ++seed) {
            test::Random random(seed);
            const double a = random.between(-1, 1), b = random.between(-1, 1), d = random.between(-16, 16);
            const PixelRecord record = sampled(
                lattice(target), [&](int x, int y) { return a * x + b * y < d ? fixed(0.75) : fixed(0.125); },
                [&](int x, int y) { return uint32_t(a * x + b * y < d); });
            EXPECT_EQ(record.hits, 256u);
            EXPECT_GE(record.samples, 5u);
            EXPECT_LE(record.radiance[0], 256 * fixed(0.75));
            EXPECT_GE(record.radiance[0], 256 * fixed(0.125));
        }
}

TEST(Lattice, NoSampleStandsForMoreThanItsLargestWeight) {
    std::set<uint32_t> counts;
    for (const int most : {5, 16, 20, 40, 100, 256})
        for (uint64_t seed = 0; seed < 200; ++seed) {
            test::Random random(seed);
            const double a = random.between(-1, 1), b = random.between(-1, 1), d = random.between(-16, 16);
            const int x0 = int(random.below(16)), y0 = int(random.below(16));
            // The sum is the weight of one sample.
            const PixelRecord record = sampled(
                lattice(0.001, most), [&](int x, int y) { return x == x0 && y == y0 ? fixed(0.75) : 0; },
                [&](int x, int y) { return uint32_t(a * x + b * y < d); });
            counts.insert(record.samples);
            EXPECT_LE(record.radiance[0], int64_t(largest_weight(record.samples)) * fixed(0.75)) << record.samples;
        }
    EXPECT_GT(counts.size(), 5u);
    const PixelRecord middle = sampled(
        lattice(0.5), [](int x, int y) { return x == 8 && y == 8 ? fixed(0.01) : 0; }, one_kind);
    EXPECT_EQ(middle.radiance[0], int64_t(largest_weight(5)) * fixed(0.01));
}

TEST(Lattice, AlikeSamplesEndAtOnceAndAStraightBorderIsNeverOverlooked) {
    const auto flat = [](int, int) { return fixed(0.5); };
    EXPECT_EQ(sampled(lattice(0.004), flat, one_kind).samples, 5u);
    EXPECT_EQ(sampled(lattice(0.004), flat, one_kind).radiance[0], 256 * fixed(0.5));
    test::Random random(3);
    for (int n = 0; n < 20000; ++n) {
        const double angle = random.between(0, 6.283185307179586), a = std::cos(angle), b = std::sin(angle);
        const double d = random.between(-24, 24);
        const auto beyond = [&](int x, int y) { return a * x + b * y < d; };
        int inside = 0;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) inside += beyond(x, y);
        const double target = 0x1p-6;
        const PixelRecord record = sampled(
            lattice(target), [&](int x, int y) { return beyond(x, y) ? fixed(1) : 0; },
            [&](int x, int y) { return uint32_t(beyond(x, y)); });
        EXPECT_EQ(record.samples > 5u, inside != 0 && inside != 256) << n;
        // Every cell that the border leaves undecided is worth at most half of the share that it may be worth; the
        // border runs through few.
        EXPECT_LE(std::abs(double(record.radiance[0]) * 0x1p-54 - inside) / 256, 2 * target) << n;
    }
}

TEST(Lattice, SmoothShadingIsIntegratedWithinTheTarget) {
    test::Random random(5);
    for (int n = 0; n < 2000; ++n) {
        const double target = n % 2 ? 0.004 : 0.03;
        // What bends alike to both sides is seen in the middle only. A bend of more than 0.05 within a pixel, twelve
        // times the target, may exceed it by up to a quarter: in one pixel of these 2,000 by more than a tenth.
        const double a = random.between(-0.2, 0.2), b = random.between(-0.2, 0.2), c = random.between(-0.1, 0.1),
                     d = random.between(-0.1, 0.1);
        const auto value = [&](int x, int y) {
            const double u = (x - 7.5) / 8, v = (y - 7.5) / 8;
            return fixed(0.5 + a * u + b * v + c * u * u + d * u * v);
        };
        double truth = 0;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) truth += double(value(x, y)) * 0x1p-54 / 256;
        const PixelRecord record = sampled(lattice(target), value, one_kind);
        const double allowed = std::abs(c) <= 0.05 ? target : 1.25 * target;
        EXPECT_NEAR(double(record.radiance[0]) * 0x1p-54 / 256, truth, allowed) << n;
    }
    // Shading that hardly changes costs no more than none.
    const auto gentle = [](int x, int y) { return fixed(0.5 + 0.00004 * x - 0.00002 * y); };
    EXPECT_EQ(sampled(lattice(0.004), gentle, one_kind).samples, 5u);
    EXPECT_EQ(sampled(lattice(0.03), gentle, one_kind).samples, 5u);
}

TEST(Lattice, StopsAtTheMostSamplesAndSaysSo) {
    test::Random random(7);
    for (int most = least_lattice_samples; most <= 256; ++most) {
        const auto noise = [&](int x, int y) { return fixed(test::Random(uint64_t(x * 16 + y)).unit()); };
        const auto every = [](int x, int y) { return uint32_t(16 * y + x); };
        const PixelRecord record = sampled(lattice(0.001, most), noise, every);
        EXPECT_LE(record.samples, unsigned(most));
        EXPECT_EQ(record.hits, 256u);
        EXPECT_EQ(record.unmet, most < 256 ? 1u : 0u) << most;
        EXPECT_EQ(sampled(
                      lattice(0.001, most), [](int, int) { return fixed(0.5); }, one_kind)
                      .unmet,
                  0u);
    }
}

TEST(Lattice, LargeTreesAreNotTrustedToBeAlike) {
    const auto flat = [](int, int) { return fixed(0.5); };
    const auto with = [&](const LatticeSettings& settings, uint32_t rays) {
        return sampled(settings, flat, one_kind, [&](int, int) { return rays; });
    };
    for (const double target : {0.001, 0.0001})
        EXPECT_EQ(with(lattice(target), LargeTrees::large_tree - 1).samples, 5u);
    EXPECT_EQ(with(lattice(0.1), LargeTrees::large_tree).samples, 5u);
    // The smaller the target, the more something unseen would be worth: cells of 64, 32 and 16 samples stand.
    EXPECT_EQ(with(lattice(0.02), LargeTrees::large_tree).samples, 16u);
    EXPECT_EQ(with(lattice(0.01), LargeTrees::large_tree).samples, 16u);
    EXPECT_EQ(with(lattice(0.004), LargeTrees::large_tree).samples, 32u);
    for (const double target : {0.003, 0.0005, 0.0001})
        EXPECT_EQ(with(lattice(target), LargeTrees::large_tree).samples, 64u);
    const PixelRecord few = with(lattice(0.001, 20), LargeTrees::large_tree);
    EXPECT_EQ(few.samples, 20u);
    EXPECT_EQ(few.unmet, 1u);
}

TEST(Lattice, OneLargeTreeIsEnoughForItsPixel) {
    const auto flat = [](int, int) { return fixed(0.5); };
    const LatticeSettings settings = lattice(0.00025);
    for (int corner = 0; corner < 4; ++corner) {
        const auto rays = [&](int x, int y) {
            return x == (corner & 1 ? 15 : 0) && y == (corner & 2 ? 15 : 0) ? LargeTrees::large_tree : 1;
        };
        EXPECT_EQ(sampled(settings, flat, one_kind, rays).samples, 64u) << corner;
        EXPECT_EQ(sampled(lattice(0.01), flat, one_kind, rays).samples, 16u) << corner;
    }
    // Met in a later round, by no corner of the pixel: what is then undecided is divided, whatever it met itself.
    const auto late = [](int x, int y) { return x == 15 && y == 8 ? LargeTrees::large_tree : 1; };
    const auto border = [](int x, int y) { return x + y < 8 ? fixed(1) : 0; };
    const auto side = [](int x, int y) { return uint32_t(x + y < 8); };
    EXPECT_GT(sampled(settings, border, side, late).samples, sampled(settings, border, side).samples + 24);
    // A bright image of 6 x 6 samples between corners that agree, at each place within a quarter of the pixel.
    for (int left = 0; left <= 2; ++left)
        for (int top = 0; top <= 2; ++top) {
            const auto image = [&](int x, int y) { return x >= left && x < left + 6 && y >= top && y < top + 6; };
            const PixelRecord record = sampled(
                settings, [&](int x, int y) { return image(x, y) ? fixed(0.02) : 0; },
                [&](int x, int y) { return uint32_t(image(x, y)); }, [](int, int) { return LargeTrees::large_tree; });
            EXPECT_NEAR(double(record.radiance[0]) * 0x1p-54 / 256, 0.02 * 36 / 256, 0.00025) << left << ", " << top;
        }
}

TEST(Lattice, WhatAPixelShowsIsTakenToHideElsewhereInIt) {
    // A border of colors at the left, and a patch of the other color somewhere between samples that agree.
    const auto strip = [](int x, int) { return x < 3; };
    const auto values = [&](int left, int top) {
        return [=](int x, int y) {
            const bool patch = x >= left && x < left + 4 && y >= top && y < top + 4;
            return strip(x, y) || patch ? fixed(0.5) : fixed(0.2);
        };
    };
    const auto unlike = [](int x, int y) { return uint32_t(x / 4 + 4 * (y / 4)); };
    for (int left = 4; left <= 11; ++left)
        for (int top = 1; top <= 11; ++top) {
            const double truth = 0.2 + 0.3 * (48 + 16) / 256;
            const auto off = [&](const PixelRecord& record) {
                return std::abs(double(record.radiance[0]) * 0x1p-54 / 256 - truth);
            };
            EXPECT_LE(off(sampled(lattice(0.003), values(left, top), unlike)), 0.003) << left << ", " << top;
        }
    // Cells of one kind are left alone, as is what is not worth the target.
    const auto side = [&](int x, int y) { return uint32_t(strip(x, y)); };
    EXPECT_LE(sampled(lattice(0.003), values(16, 16), side).samples, 88u);
    // Cells whose corners met different things are not left alone.
    const auto all_unlike = [&](int x, int y) { return unlike(x, y) + 16 * side(x, y); };
    EXPECT_GT(sampled(lattice(0.003), values(16, 16), all_unlike).samples, 88u);
    EXPECT_LE(sampled(lattice(0.03), values(16, 16), all_unlike).samples, 72u);
}

TEST(Lattice, ATipBetweenTexelsOfOneColorIsFound) {
    // Two dark texels that meet on the right, and the tip of a bright one between them.
    const auto bright = [](int x, int y) { return y >= 4 && y < 12 && 2 * x < 14 - std::abs(2 * y - 15); };
    const auto texel = [&](int x, int y) { return uint32_t(bright(x, y) ? 2 : y >= 8); };
    double truth = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) truth += (bright(x, y) ? 0.5 : 0.2) / 256;
    const PixelRecord record = sampled(
        lattice(0.01), [&](int x, int y) { return fixed(bright(x, y) ? 0.5 : 0.2); }, texel);
    EXPECT_NEAR(double(record.radiance[0]) * 0x1p-62, truth, 0.01);
}

TEST(Lattice, WhatComesInThroughASideIsSeenFromBesideIt) {
    // A notch from the right, which widens between the corners of the cells that it enters.
    const std::array<int, 16> first = {16, 16, 16, 16, 14, 12, 9, 15, 16, 16, 16, 16, 16, 16, 16, 16};
    const auto notch = [&](int x, int y) { return x >= first[size_t(y)]; };
    const double truth = 0.35 - 0.3 * (2 + 4 + 7 + 1) / 256;
    const PixelRecord record = sampled(
        lattice(0.004), [&](int x, int y) { return notch(x, y) ? fixed(0.05) : fixed(0.35); },
        [&](int x, int y) { return uint32_t(notch(x, y)); }, [](int, int) { return LargeTrees::large_tree; });
    EXPECT_NEAR(double(record.radiance[0]) * 0x1p-54 / 256, truth, 0.001);
}

TEST(Lattice, ACheckedPixelTakesTheOtherSamplesToo) {
    for (const double target : {0.5, 0.05, 0.004})
        for (uint64_t seed = 0; seed < 200; ++seed) {
            test::Random random(seed);
            const int left = int(random.below(16)), top = int(random.below(16)), size = 1 + int(random.below(15));
            const auto patch = [&](int x, int y) { return x >= left && x < left + size && y >= top && y < top + size; };
            const auto value = [&](int x, int y) { return patch(x, y) ? fixed(0.75) : fixed(0.125); };
            const auto met = [&](int x, int y) { return uint32_t(patch(x, y)); };
            const auto rays = [](int, int) { return 1u; };
            std::set<std::pair<int, int>> taken;
            const PixelRecord estimate = sampled(lattice(target), value, met);
            const PixelRecord checked = sampled(lattice(target), value, met, rays, &taken, true);
            int64_t sum = 0;
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x) sum += value(x, y);
            EXPECT_EQ(taken.size(), 256u);
            EXPECT_EQ(checked.samples, 256u);
            EXPECT_EQ(checked.hits, 256u);
            EXPECT_EQ(checked.radiance[0], sum);
            EXPECT_EQ(checked.id, estimate.id);
            EXPECT_EQ(checked.checked, 1u);
            EXPECT_EQ(estimate.checked + estimate.off, 0u);
            const double off = std::abs(double(estimate.radiance[0] - sum)) * 0x1p-62;
            EXPECT_EQ(checked.off, off > target ? 1u : 0u) << seed << ": " << off;
        }
}

TEST(Lattice, TargetsOfFewUnitsOfTheBoundStillCount) {
    // A bound of 2^24: what a frame asks for is 2^-32 of it.
    const auto border = [](int x, int) { return x < 7 ? 0 : fixed(0x1p-30); };
    const auto side = [](int x, int) { return uint32_t(x < 7); };
    const PixelRecord record = sampled(lattice(0x1p-32), border, side);
    EXPECT_NEAR(double(record.radiance[0]) * 0x1p-54 / 256, 0x1p-30 * 9 / 16, 0x1p-32);
}

TEST(Lattice, SpendsWhatItMayInAllQuartersAlike) {
    for (int most : {16, 32, 64, 128}) {
        std::set<std::pair<int, int>> taken;
        sampled(
            lattice(0.001, most), [](int x, int y) { return (x ^ y) & 1 ? fixed(1) : 0; },
            [](int x, int y) { return uint32_t(16 * y + x); }, &taken);
        int least = 256, greatest = 0;
        for (int quarter = 0; quarter < 4; ++quarter) {
            int count = 0;
            for (const auto& [x, y] : taken) count += (x >= 8) == (quarter & 1) && (y >= 8) == (quarter >> 1);
            least = std::min(least, count);
            greatest = std::max(greatest, count);
        }
        EXPECT_LE(greatest - least, 4 * most / 16) << most;
        EXPECT_GT(least, 0) << most;
    }
}

}  // namespace
