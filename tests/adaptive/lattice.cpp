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
                    std::set<std::pair<int, int>>* taken = nullptr) {
    LatticePixel pixel;
    LatticeSample samples[lattice_samples];
    PixelRecord record = PixelRecord();
    for (pixel.begin(settings); pixel.wanted() > 0;) {
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
            samples[slot].keep(sample, hash(column, row));
            if (LatticePixel::is_chosen(settings, slot)) record.id = 100 + slot;
        }
        for (int i = pixel.cells(); i-- > 0;) pixel.judge(settings, samples, i);  // in any order
        pixel.divide(settings);
    }
    for (int i = pixel.cells(); i-- > 0;)
        pixel.accumulate(settings, i, [&](int slot, int weight) {
            samples[slot].give(record, weight, [](auto& to, auto more) { to += more; });
        });
    record.samples = uint32_t(pixel.taken());
    record.unmet = pixel.unmet();
    return record;
}

template <class Value, class Hash>
PixelRecord sampled(const LatticeSettings& settings, const Value& value, const Hash& hash,
                    std::set<std::pair<int, int>>* taken = nullptr) {
    return sampled(
        settings, value, hash, [](int, int) { return 1u; }, taken);
}

LatticeSettings lattice(double target, bool fine, int most = lattice_samples) {
    LatticeSettings settings;
    settings.target = int64_t(std::ldexp(target, color_bits));
    settings.fine = fine;
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
    for (const bool fine : {true, false})
        for (uint64_t seed = 0; seed < 50; ++seed) {
            test::Random random(seed);
            std::array<std::array<int64_t, 16>, 16> values;
            for (auto& row : values)
                for (int64_t& value : row) value = fixed(random.unit());
            std::set<std::pair<int, int>> taken;
            const PixelRecord record = sampled(
                lattice(0x1p-29, fine), [&](int x, int y) { return values[size_t(y)][size_t(x)]; },
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
    for (const bool fine : {true, false})
        for (const double target : {0.5, 0.1, 0.02, 0.004, 0.0005})
            for (uint64_t seed = 0; seed < 100; ++seed) {
                test::Random random(seed);
                const double a = random.between(-1, 1), b = random.between(-1, 1), d = random.between(-16, 16);
                const PixelRecord record = sampled(
                    lattice(target, fine), [&](int x, int y) { return a * x + b * y < d ? fixed(0.75) : fixed(0.125); },
                    [&](int x, int y) { return uint32_t(a * x + b * y < d); });
                EXPECT_EQ(record.hits, 256u);
                EXPECT_GE(record.samples, fine ? 5u : 4u);
                EXPECT_LE(record.radiance[0], 256 * fixed(0.75));
                EXPECT_GE(record.radiance[0], 256 * fixed(0.125));
            }
}

TEST(Lattice, AlikeSamplesEndAtOnceAndAStraightBorderIsNeverOverlooked) {
    const auto flat = [](int, int) { return fixed(0.5); };
    EXPECT_EQ(sampled(lattice(0.004, true), flat, one_kind).samples, 5u);
    EXPECT_EQ(sampled(lattice(0.004, false), flat, one_kind).samples, 4u);
    EXPECT_EQ(sampled(lattice(0.004, true), flat, one_kind).radiance[0], 256 * fixed(0.5));
    test::Random random(3);
    for (int n = 0; n < 20000; ++n) {
        const bool fine = n % 2;
        const double angle = random.between(0, 6.283185307179586), a = std::cos(angle), b = std::sin(angle);
        const double d = random.between(-24, 24);
        const auto beyond = [&](int x, int y) { return a * x + b * y < d; };
        int inside = 0;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) inside += beyond(x, y);
        const double target = 0x1p-6;
        const PixelRecord record = sampled(
            lattice(target, fine), [&](int x, int y) { return beyond(x, y) ? fixed(1) : 0; },
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
        const bool fine = n % 2;
        // What bends alike to both sides is seen in the middle only, at which coarse targets do not look. A bend of
        // more than 0.05 within a pixel exceeds the target by up to a tenth: it is an estimate.
        const double a = random.between(-0.2, 0.2), b = random.between(-0.2, 0.2),
                     c = fine ? random.between(-0.1, 0.1) : 0, d = random.between(-0.1, 0.1);
        const auto value = [&](int x, int y) {
            const double u = (x - 7.5) / 8, v = (y - 7.5) / 8;
            return fixed(0.5 + a * u + b * v + c * u * u + d * u * v);
        };
        double truth = 0;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) truth += double(value(x, y)) * 0x1p-54 / 256;
        const PixelRecord record = sampled(lattice(target, fine), value, one_kind);
        const double allowed = std::abs(c) <= 0.05 ? target : 1.1 * target;
        EXPECT_NEAR(double(record.radiance[0]) * 0x1p-54 / 256, truth, allowed) << n;
    }
    // Shading that hardly changes costs no more than none.
    const auto gentle = [](int x, int y) { return fixed(0.5 + 0.00004 * x - 0.00002 * y); };
    EXPECT_EQ(sampled(lattice(0.004, true), gentle, one_kind).samples, 5u);
    EXPECT_EQ(sampled(lattice(0.03, false), gentle, one_kind).samples, 4u);
}

TEST(Lattice, StopsAtTheMostSamplesAndSaysSo) {
    test::Random random(7);
    for (int most = least_lattice_samples; most <= 256; ++most) {
        const auto noise = [&](int x, int y) { return fixed(test::Random(uint64_t(x * 16 + y)).unit()); };
        const auto every = [](int x, int y) { return uint32_t(16 * y + x); };
        for (const bool fine : {true, false}) {
            const PixelRecord record = sampled(lattice(0.001, fine, most), noise, every);
            EXPECT_LE(record.samples, unsigned(most));
            EXPECT_EQ(record.hits, 256u);
            EXPECT_EQ(record.unmet, most < 256 ? 1u : 0u) << most;
        }
        EXPECT_EQ(sampled(
                      lattice(0.001, true, most), [](int, int) { return fixed(0.5); }, one_kind)
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
        EXPECT_EQ(with(lattice(target, true), LargeTrees::large_tree - 1).samples, 5u);
    EXPECT_EQ(with(lattice(0.1, false), LargeTrees::large_tree).samples, 4u);
    // The smaller the target, the more something unseen would be worth: cells of 64, 32, 16, 8 and 4 samples stand.
    EXPECT_EQ(with(lattice(0.003, true), LargeTrees::large_tree).samples, 16u);
    EXPECT_EQ(with(lattice(0.001, true), LargeTrees::large_tree).samples, 32u);
    EXPECT_EQ(with(lattice(0.0005, true), LargeTrees::large_tree).samples, 64u);
    EXPECT_EQ(with(lattice(0.00025, true), LargeTrees::large_tree).samples, 128u);
    EXPECT_EQ(with(lattice(0.0001, true), LargeTrees::large_tree).samples, 256u);
    const PixelRecord few = with(lattice(0.001, true, 20), LargeTrees::large_tree);
    EXPECT_EQ(few.samples, 20u);
    EXPECT_EQ(few.unmet, 1u);
}

TEST(Lattice, OneLargeTreeIsEnoughForItsPixel) {
    const auto flat = [](int, int) { return fixed(0.5); };
    const LatticeSettings settings = lattice(0.00025, true);
    for (int corner = 0; corner < 4; ++corner) {
        const auto rays = [&](int x, int y) {
            return x == (corner & 1 ? 15 : 0) && y == (corner & 2 ? 15 : 0) ? LargeTrees::large_tree : 1;
        };
        EXPECT_EQ(sampled(settings, flat, one_kind, rays).samples, 128u) << corner;
        EXPECT_EQ(sampled(lattice(0.001, true), flat, one_kind, rays).samples, 32u) << corner;
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
    // A texture's border at the left, and a patch of the other color somewhere between samples that agree.
    const auto strip = [](int x, int) { return x < 3; };
    const auto values = [&](int left, int top) {
        return [=](int x, int y) {
            const bool patch = x >= left && x < left + 4 && y >= top && y < top + 4;
            return strip(x, y) || patch ? fixed(0.5) : fixed(0.2);
        };
    };
    const auto unlike = [](int x, int y) { return uint32_t(x / 4 + 4 * (y / 4)); };
    for (const bool fine : {true, false})
        for (int left = 4; left <= 11; ++left)
            for (int top = 1; top <= 11; ++top) {
                const double truth = 0.2 + 0.3 * (48 + 16) / 256;
                const auto off = [&](const PixelRecord& record) {
                    return std::abs(double(record.radiance[0]) * 0x1p-54 / 256 - truth);
                };
                EXPECT_LE(off(sampled(lattice(0.003, fine), values(left, top), one_kind)), 0.003)
                    << left << ", " << top;
                EXPECT_LE(off(sampled(lattice(0.003, fine), values(left, top), unlike)), 0.003) << left << ", " << top;
            }
    // Borders of things rather than of textures leave cells of one kind alone, as does what is not worth the target.
    const auto side = [&](int x, int y) { return uint32_t(strip(x, y)); };
    EXPECT_EQ(sampled(lattice(0.003, true), values(16, 16), one_kind).samples, 256u);
    EXPECT_LE(sampled(lattice(0.003, true), values(16, 16), side).samples, 88u);
    // Cells whose corners met different things are not left alone.
    const auto all_unlike = [&](int x, int y) { return unlike(x, y) + 16 * side(x, y); };
    EXPECT_GT(sampled(lattice(0.003, true), values(16, 16), all_unlike).samples, 88u);
    EXPECT_LE(sampled(lattice(0.03, true), values(16, 16), one_kind).samples, 72u);
}

TEST(Lattice, WhatComesInThroughASideIsSeenFromBesideIt) {
    // A notch from the right, which widens between the corners of the cells that it enters.
    const std::array<int, 16> first = {16, 16, 16, 16, 14, 12, 9, 15, 16, 16, 16, 16, 16, 16, 16, 16};
    const auto notch = [&](int x, int y) { return x >= first[size_t(y)]; };
    const double truth = 0.35 - 0.3 * (2 + 4 + 7 + 1) / 256;
    const PixelRecord record = sampled(
        lattice(0.004, true), [&](int x, int y) { return notch(x, y) ? fixed(0.05) : fixed(0.35); },
        [&](int x, int y) { return uint32_t(notch(x, y)); }, [](int, int) { return LargeTrees::large_tree; });
    EXPECT_NEAR(double(record.radiance[0]) * 0x1p-54 / 256, truth, 0.001);
}

TEST(Lattice, ShadingThatComesInSteeplyBendsBetweenCornersThatAgree) {
    // A groove between rows whose ends agree, and the slope that goes on beyond it.
    const std::array<int, 16> rows = {261, 247, 232, 227, 226, 231, 245, 258, 269, 278, 286, 294, 301, 307, 311, 315};
    double truth = 0;
    for (int row : rows) truth += row * 0.001 / 16;
    const auto groove = [&](int x, int y) { return fixed(rows[size_t(y)] * 0.001 + x * 1e-5); };
    const auto across = [&](int x, int y) { return groove(y, x); };
    truth += 7.5e-5;
    EXPECT_NEAR(double(sampled(lattice(0.004, true), groove, one_kind).radiance[0]) * 0x1p-54 / 256, truth, 0.004);
    EXPECT_NEAR(double(sampled(lattice(0.004, true), across, one_kind).radiance[0]) * 0x1p-54 / 256, truth, 0.004);
    // A texture's border between two quarters is no slope, nor is one of things.
    const auto border = [](double by) { return [by](int x, int) { return fixed(x < 8 ? 0.5 : 0.5 + by); }; };
    const auto side = [](int x, int) { return uint32_t(x < 8); };
    const auto taken = [&](double by, const auto& hash) {
        return sampled(lattice(0.004, true), border(by), hash).samples;
    };
    EXPECT_GT(taken(0.0155, one_kind), 16u);
    EXPECT_EQ(taken(0.0165, one_kind), 16u);
    EXPECT_EQ(taken(0.0155, side), 16u);
}

TEST(Lattice, WhereColorsSpanMuchNoLargeCellStands) {
    // A border at the left, and a highlight of 5 x 5 samples between corners that agree, anywhere beside it.
    const auto side = [](int x, int) { return x < 3; };
    const auto met = [&](int x, int y) { return uint32_t(side(x, y)); };
    const double light = 0.5, dark = light - WideColors::wide_range * 0.004 - 0.001;
    for (int left = 4; left <= 11; ++left)
        for (int top = 0; top <= 11; ++top) {
            const auto lit = [&](int x, int y) {
                return side(x, y) || (x >= left && x < left + 5 && y >= top && y < top + 5);
            };
            const PixelRecord record = sampled(
                lattice(0.004, true), [&](int x, int y) { return fixed(lit(x, y) ? light : dark); }, met,
                [](int, int) { return WideColors::some_rays; });
            const double truth = dark + (light - dark) * (3 * 16 + 25) / 256;
            EXPECT_NEAR(double(record.radiance[0]) * 0x1p-54 / 256, truth, 0.004) << left << ", " << top;
        }
    const auto plain = [&](int x, int y) { return fixed(side(x, y) ? light : dark); };
    const auto taken = [&](uint32_t rays) {
        return sampled(lattice(0.004, true), plain, met, [&](int, int) { return rays; }).samples;
    };
    EXPECT_GT(taken(WideColors::some_rays), taken(WideColors::some_rays - 1));
}

TEST(Lattice, TargetsOfFewUnitsOfTheBoundStillCount) {
    // A bound of 2^24: what a frame asks for is 2^-32 of it.
    const auto border = [](int x, int) { return x < 7 ? 0 : fixed(0x1p-30); };
    const auto side = [](int x, int) { return uint32_t(x < 7); };
    const PixelRecord record = sampled(lattice(0x1p-32, true), border, side);
    EXPECT_NEAR(double(record.radiance[0]) * 0x1p-54 / 256, 0x1p-30 * 9 / 16, 0x1p-32);
}

TEST(Lattice, SpendsWhatItMayInAllQuartersAlike) {
    for (int most : {16, 32, 64, 128}) {
        std::set<std::pair<int, int>> taken;
        sampled(
            lattice(0.001, true, most), [](int x, int y) { return (x ^ y) & 1 ? fixed(1) : 0; },
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
