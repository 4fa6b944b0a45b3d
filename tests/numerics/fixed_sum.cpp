// Integer sums of radiance: exact conversions, no order, one rounding, and the inequality that the ledger rests on.
#include <gtest/gtest.h>
#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cistula/numerics/fixed_sum.h"

namespace cistula {
namespace {

using Quad = __float128;

template <class Real>
class FixedSum : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(FixedSum, Reals);

/// In [0, 1), with exponents down to 2^-lowest.
template <class Real>
Real share(std::mt19937_64& engine, int lowest) {
    const double m = static_cast<double>(engine() >> 11) * 0x1p-53;
    return static_cast<Real>(std::ldexp(m * (1 - 0x1p-20), -static_cast<int>(engine() % (lowest + 1))));
}

TEST(FixedShift, IsTheLeastThatHolds) {
    EXPECT_EQ(fixed_shift(1), 62);
    EXPECT_EQ(fixed_shift(2), 61);
    EXPECT_EQ(fixed_shift(3), 60);
    EXPECT_EQ(fixed_shift(4), 60);
    EXPECT_EQ(fixed_shift(5), 59);
    EXPECT_EQ(fixed_shift(256), 54);
    EXPECT_EQ(fixed_shift(257), 53);
    EXPECT_EQ(fixed_shift(0x80000000u), 31);
    EXPECT_EQ(fixed_shift(0xffffffffu), 30);
    for (uint32_t samples = 1; samples < 5000; ++samples) {
        const Quad sum = Quad(samples) * Quad(fixed_scale(fixed_shift(samples)));
        EXPECT_LE(sum, Quad(0x1p62));
        EXPECT_GT(sum * 2, Quad(0x1p62));
    }
}

TYPED_TEST(FixedSum, ConversionsAreExactFloorAndCeil) {
    using Real = TypeParam;
    std::mt19937_64 engine(1);
    for (int i = 0; i < 300'000; ++i) {
        const int shift = fixed_shift(1 + static_cast<uint32_t>(engine() % 1000));
        const Real x = share<Real>(engine, i % 2 ? 12 : 140);
        const Quad exact = ldexpq(x, shift);
        int64_t down = -1, up = -1;
        ASSERT_TRUE(to_fixed(x, fixed_scale(shift), down));
        ASSERT_TRUE(to_fixed_up(x, fixed_scale(shift), up));
        ASSERT_EQ(Quad(down), floorq(exact)) << x << " " << shift;
        ASSERT_EQ(Quad(up), ceilq(exact)) << x << " " << shift;
    }
}

TYPED_TEST(FixedSum, OnlySharesOfTheBoundAreTaken) {
    using Real = TypeParam;
    const Real infinity = RealTraits<Real>::infinity, smallest = std::numeric_limits<Real>::denorm_min();
    for (int shift : {30, 54, 62}) {
        const double scale = fixed_scale(shift);
        for (Real bad : {std::numeric_limits<Real>::quiet_NaN(), infinity, -infinity, Real(-1), -smallest,
                         std::nextafter(Real(1), Real(2)), Real(2), RealTraits<Real>::largest}) {
            int64_t out = 77;
            EXPECT_FALSE(to_fixed(bad, scale, out)) << bad;
            EXPECT_FALSE(to_fixed_up(bad, scale, out)) << bad;
            EXPECT_EQ(out, 77);
        }
        int64_t out = 77;
        EXPECT_TRUE(to_fixed(Real(-0.0), scale, out));
        EXPECT_EQ(out, 0);
        EXPECT_TRUE(to_fixed_up(Real(0), scale, out));
        EXPECT_EQ(out, 0);
        EXPECT_TRUE(to_fixed(smallest, scale, out));
        EXPECT_EQ(out, 0);
        EXPECT_TRUE(to_fixed_up(smallest, scale, out));
        EXPECT_EQ(out, 1);
        EXPECT_TRUE(to_fixed(Real(1), scale, out));
        EXPECT_EQ(out, int64_t{1} << shift);
        EXPECT_TRUE(to_fixed_up(Real(1), scale, out));
        EXPECT_EQ(out, int64_t{1} << shift);
    }
}

TYPED_TEST(FixedSum, AnyOrderGivesTheSame) {
    using Real = TypeParam;
    std::mt19937_64 engine(2);
    std::vector<Real> parts(4096);
    for (Real& part : parts) part = share<Real>(engine, 60);
    const int shift = fixed_shift(4096);
    const auto total = [&] {
        int64_t sum = 0;
        for (const Real part : parts) {
            int64_t fixed = 0;
            EXPECT_TRUE(to_fixed(part, fixed_scale(shift), fixed));
            sum += fixed;
        }
        return sum;
    };
    const int64_t first = total();
    Real plain = 0;
    bool plain_differs = false;
    for (const Real part : parts) plain += part;
    for (int round = 0; round < 20; ++round) {
        std::shuffle(parts.begin(), parts.end(), engine);
        EXPECT_EQ(total(), first);
        Real again = 0;
        for (const Real part : parts) again += part;
        plain_differs |= again != plain;
    }
    EXPECT_TRUE(plain_differs);  // or the parts are too tame to show anything
}

/// Parts of weight w_i under a branch of weight w and bound B, sum(w_i) <= w: what is cut never exceeds what is
/// charged, and no rounding of parts may exceed it either, down to weights that are far below one unit.
TYPED_TEST(FixedSum, PartsNeverExceedTheirBranch) {
    using Real = TypeParam;
    std::mt19937_64 engine(3);
    int below_one_unit = 0;
    for (int round = 0; round < 20'000; ++round) {
        const double scale = fixed_scale(fixed_shift(1 + static_cast<uint32_t>(engine() % 300)));
        std::vector<Real> parts(1 + engine() % 40);
        Quad exact = 0;
        int64_t sum = 0;
        const int depth = static_cast<int>(engine() % 70);
        for (Real& part : parts) {
            part = static_cast<Real>(std::ldexp(share<Real>(engine, 8), -6 - depth));
            exact += part;
            int64_t fixed = 0;
            ASSERT_TRUE(to_fixed(part, scale, fixed));
            sum += fixed;
        }
        const Real branch = std::nextafter(static_cast<Real>(exact), Real(1));  // a bound in Real, as renderers have
        int64_t bound = 0, charged = 0;
        ASSERT_TRUE(to_fixed(branch, scale, bound));
        ASSERT_TRUE(to_fixed_up(branch, scale, charged));
        ASSERT_LE(sum, bound);
        ASSERT_LE(bound, charged);
        below_one_unit += bound == 0 && charged == 1;
    }
    EXPECT_GT(below_one_unit, 100);
}

TEST(Mean, HalvesGoToEven) {
    EXPECT_EQ(mean_of(0, 7), 0);
    EXPECT_EQ(mean_of(1, 2), 0);
    EXPECT_EQ(mean_of(3, 2), 2);
    EXPECT_EQ(mean_of(5, 2), 2);
    EXPECT_EQ(mean_of(7, 2), 4);
    EXPECT_EQ(mean_of(2, 4), 0);
    EXPECT_EQ(mean_of(6, 4), 2);
    EXPECT_EQ(mean_of(1, 3), 0);
    EXPECT_EQ(mean_of(2, 3), 1);
    EXPECT_EQ(mean_of(int64_t{1} << 62, 0x80000000u), int64_t{1} << 31);
    EXPECT_EQ(mean_of(int64_t{1} << 62, 1), int64_t{1} << 62);
    std::mt19937_64 engine(4);
    for (int i = 0; i < 200'000; ++i) {
        const int64_t sum = static_cast<int64_t>(engine() >> (2 + engine() % 60));
        const uint32_t samples = 1 + static_cast<uint32_t>(engine() >> (32 + engine() % 32));
        ASSERT_EQ(Quad(mean_of(sum, samples)), rintq(Quad(sum) / samples)) << sum << " " << samples;
    }
}

TYPED_TEST(FixedSum, ResolveRoundsOnce) {
    using Real = TypeParam;
    std::mt19937_64 engine(5);
    for (int i = 0; i < 300'000; ++i) {
        const uint32_t samples = 1 + static_cast<uint32_t>(engine() % (i % 2 ? 300 : 100'000));
        const int shift = fixed_shift(samples);
        const int64_t mean =
            static_cast<int64_t>(engine() >> 2) >> (62 - shift + engine() % 40) & ((int64_t{1} << shift) - 1);
        const int64_t sum = mean * samples;
        const int exponent = static_cast<int>(engine() % 120) - 20;
        // Quad to Real is one rounding: 113 bits hold the mean whole.
        const Real exact = static_cast<Real>(ldexpq(mean, exponent - shift));
        ASSERT_EQ(resolve<Real>(sum, shift, samples, exponent), exact) << mean << " " << shift << " " << exponent;
    }
}

TYPED_TEST(FixedSum, ResolveAtTheEnds) {
    using Real = TypeParam;
    constexpr int top = std::numeric_limits<Real>::max_exponent;
    const int64_t one = int64_t{1} << 62;
    EXPECT_EQ(resolve<Real>(0, 62, 1, 100), Real(0));
    EXPECT_EQ(resolve<Real>(one, 62, 1, 0), Real(1));
    EXPECT_EQ(resolve<Real>(one, 62, 1, top - 1), std::ldexp(Real(1), top - 1));
    EXPECT_EQ(resolve<Real>(one, 62, 1, top), RealTraits<Real>::infinity);
    EXPECT_EQ(resolve<Real>(one, 62, 1, 1900), RealTraits<Real>::infinity);
    EXPECT_EQ(resolve<Real>(one, 62, 1, -1900), Real(0));
    const int lowest = std::numeric_limits<Real>::min_exponent - std::numeric_limits<Real>::digits;
    EXPECT_EQ(resolve<Real>(one, 62, 1, lowest), std::numeric_limits<Real>::denorm_min());
}

/// One unit over a half in float: in double the unit is lost, and the tie would go down to even.
TEST(Resolve, FloatDoesNotGoThroughDouble) {
    const int64_t mean = (int64_t{1} << 61) + (int64_t{1} << 37) + 1;
    ASSERT_NE(static_cast<float>(static_cast<double>(mean)), static_cast<float>(mean));
    EXPECT_EQ(resolve<float>(mean, 62, 1, 1), 1 + 0x1p-23f);
}

}  // namespace
}  // namespace cistula
