// Losses of light as integers: exact where shares are powers of two, to nearest elsewhere, and free of any order.
#include <gtest/gtest.h>
#include <quadmath.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cistula/numerics/transmittance.h"

namespace cistula {
namespace {

using Quad = __float128;
constexpr uint64_t one = uint64_t{1} << 52;

double unit(std::mt19937_64& engine) {
    return static_cast<double>((engine() >> 11) + 1) * 0x1p-53;  // (0, 1]
}

/// |loss - exact|, in units of 2^-52; the exact loss is given in powers of two.
double distance(uint64_t loss, Quad exact) {
    return static_cast<double>(fabsq(Quad(loss) - ldexpq(exact, 52)));
}

TEST(Loss, ExactAtPowersOfTwo) {
    EXPECT_EQ(loss_of(1), 0u);
    for (uint64_t k = 0; k <= 1074; ++k) EXPECT_EQ(loss_of(std::ldexp(1.0, -static_cast<int>(k))), k * one);
}

TEST(Loss, ToNearest) {
    std::mt19937_64 engine(1);
    double worst = 0;
    for (int i = 0; i < 300'000; ++i) {
        double share = unit(engine);
        if (i % 3 == 1) share = std::ldexp(share, -static_cast<int>(engine() % 1070));
        if (i % 3 == 2) share = 1 - std::ldexp(share, -1 - static_cast<int>(engine() % 53));
        if (!(share > 0)) continue;
        worst = std::max(worst, distance(loss_of(share), -log2q(share)));
    }
    EXPECT_LE(worst, 0.5 + 1e-4);
    EXPECT_GE(worst, 0.49);
    EXPECT_EQ(loss_of(std::nextafter(1.0, 0.0)), 1u);  // 2^-53 / ln 2 is 0.72 units
}

TEST(Loss, TransmittancesComeBack) {
    std::mt19937_64 engine(2);
    for (int i = 0; i < 200'000; ++i) {
        // A float share, as materials hold them, comes back to the bit.
        const float share = static_cast<float>(std::ldexp(unit(engine), -static_cast<int>(engine() % 100)));
        ASSERT_EQ(transmittance_of<float>(loss_of(share)), share);
        const double fine = unit(engine);
        ASSERT_NEAR(transmittance_of<double>(loss_of(fine)), fine, 2 * 0x1p-53);
    }
}

template <class Real>
class TransmittanceOfLoss : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(TransmittanceOfLoss, Reals);

TYPED_TEST(TransmittanceOfLoss, ExactAtWholeLosses) {
    using Real = TypeParam;
    const int lowest = 1 - std::numeric_limits<Real>::min_exponent;
    ASSERT_EQ(std::ldexp(Real(1), -lowest), std::numeric_limits<Real>::min());
    for (int k = 0; k <= lowest; ++k)
        ASSERT_EQ(transmittance_of<Real>(static_cast<uint64_t>(k) * one), std::ldexp(Real(1), -k));
    EXPECT_EQ(transmittance_of<Real>(static_cast<uint64_t>(lowest) * one + 1), Real(0));
    EXPECT_EQ(transmittance_of<Real>(static_cast<uint64_t>(lowest + 1) * one), Real(0));
    EXPECT_EQ(transmittance_of<Real>(2047 * one), Real(0));
    EXPECT_EQ(transmittance_of<Real>(largest_loss), Real(0));
}

TYPED_TEST(TransmittanceOfLoss, WithinStatedError) {
    using Real = TypeParam;
    std::mt19937_64 engine(3);
    double worst = 0;
    for (int i = 0; i < 300'000; ++i) {
        const uint64_t loss = engine() % (i % 2 ? one : 126 * one);
        const Quad exact = exp2q(-ldexpq(loss, -52));
        int exponent = 0;
        frexpq(exact, &exponent);
        const Quad ulp = ldexpq(1, exponent - std::numeric_limits<Real>::digits);
        worst = std::max(worst, static_cast<double>(fabsq(Quad(transmittance_of<Real>(loss)) - exact) / ulp));
    }
    EXPECT_LE(worst, sizeof(Real) == 4 ? 0.5 + 1e-6 : elementary::exp2_worst_ulp);
}

TYPED_TEST(TransmittanceOfLoss, NeverGrowsWithTheLoss) {
    using Real = TypeParam;
    std::mt19937_64 engine(4);
    const auto run = [](uint64_t first) {
        Real before = transmittance_of<Real>(first);
        for (uint64_t loss = first + 1; loss < first + 400; ++loss) {
            const Real share = transmittance_of<Real>(loss);
            ASSERT_LE(share, before) << loss;
            before = share;
        }
    };
    for (int i = 0; i < 2'000; ++i) run(engine() % (1024 * one));
    for (uint64_t k = 1; k < 1024; ++k) run(k * one - 200);            // whole losses
    for (uint64_t k = 0; k < 1024; ++k) run(k * one + one / 2 - 200);  // where the reduction changes sides
}

TEST(Loss, AnyOrderOfCrossingsGivesTheSame) {
    std::mt19937_64 engine(5);
    std::vector<double> shares(100);
    for (double& share : shares) share = unit(engine);
    const auto transmittance_through = [&] {
        uint64_t loss = 0;
        for (const double share : shares) loss = saturating_add(loss, loss_of(share));
        return transmittance_of<double>(loss);
    };
    const auto product = [&] {
        double all = 1;
        for (const double share : shares) all *= share;
        return all;
    };
    const double first = transmittance_through(), plain = product();
    EXPECT_NEAR(first / plain, 1, 200 * 0x1p-53);
    bool plain_differs = false;
    for (int round = 0; round < 50; ++round) {
        std::shuffle(shares.begin(), shares.end(), engine);
        EXPECT_EQ(transmittance_through(), first);
        plain_differs |= product() != plain;
    }
    EXPECT_TRUE(plain_differs);
}

TEST(Loss, SaturatesInAnyOrder) {
    EXPECT_EQ(saturating_add(largest_loss, 0), largest_loss);
    EXPECT_EQ(saturating_add(largest_loss, 1), largest_loss);
    EXPECT_EQ(saturating_add(largest_loss, largest_loss), largest_loss);
    EXPECT_EQ(saturating_add(largest_loss - 5, 5), largest_loss);
    EXPECT_EQ(saturating_add(largest_loss - 5, 4), largest_loss - 1);
    std::vector<uint64_t> losses(9, 500 * one);
    losses.push_back(3);
    std::sort(losses.begin(), losses.end());
    do {
        uint64_t sum = 0;
        for (const uint64_t loss : losses) sum = saturating_add(sum, loss);
        EXPECT_EQ(sum, largest_loss);
    } while (std::next_permutation(losses.begin(), losses.end()));
    uint64_t many = 0;
    for (int i = 0; i < 1'000'000; ++i) many = saturating_add(many, loss_of(0x1p-1074));
    EXPECT_EQ(many, largest_loss);
}

TEST(Absorption, LossToNearest) {
    std::mt19937_64 engine(6);
    double worst = 0;
    const Quad log2_e = 1 / logq(2);
    for (int i = 0; i < 300'000; ++i) {
        const double absorbed = std::ldexp(unit(engine), 11 - static_cast<int>(engine() % 64));
        worst = std::max(worst, distance(absorption_loss(absorbed), absorbed * log2_e));
    }
    EXPECT_LE(worst, 0.5 + 1e-4);
    EXPECT_EQ(absorption_loss(0), 0u);
    EXPECT_EQ(absorption_loss(-0.0), 0u);
    EXPECT_EQ(absorption_loss(-1), 0u);
    EXPECT_EQ(absorption_loss(0x1p-1074), 0u);
    EXPECT_EQ(absorption_loss(0x1p-52), 1u);
    EXPECT_LT(absorption_loss(2839), largest_loss);
    EXPECT_EQ(absorption_loss(2840), largest_loss);
    EXPECT_EQ(absorption_loss(elementary::infinity), largest_loss);
    EXPECT_EQ(absorption_loss(elementary::not_a_number), largest_loss);
    EXPECT_EQ(transmittance_of<double>(absorption_loss(1)), std::exp(-1.0));
}

TEST(Absorption, LossIsMonotone) {
    for (double start : {0x1p-40, 0.1, 0.7, 1.0, 100.0, 2839.0, 4096 / 1.4426950408889634}) {
        double at = start;
        for (int i = 0; i < 1000; ++i) at = std::nextafter(at, 0.0);
        uint64_t before = absorption_loss(at);
        for (int i = 0; i < 2000; ++i) {
            at = std::nextafter(at, elementary::infinity);
            const uint64_t loss = absorption_loss(at);
            ASSERT_GE(loss, before) << at;
            before = loss;
        }
    }
    EXPECT_EQ(absorption_loss(4096 / 1.4426950408889634 * (1 + 0x1p-50)), largest_loss);
}

TEST(Absorption, FixedPoint) {
    EXPECT_EQ(absorption_fixed(0), 0);
    EXPECT_EQ(absorption_fixed(1), int64_t{1} << 32);
    EXPECT_EQ(absorption_fixed(-1), -(int64_t{1} << 32));
    EXPECT_EQ(absorption_fixed(0x1p-33), 1);
    EXPECT_EQ(absorption_fixed(0x1.fp-34), 0);
    EXPECT_EQ(absorption_fixed(-0x1p-33), 0);
    EXPECT_EQ(absorption_fixed(0x1p22), int64_t{1} << 54);
    for (const double what : {elementary::infinity, -elementary::infinity, elementary::not_a_number})
        EXPECT_EQ(absorption_fixed(what), std::numeric_limits<int64_t>::min());
}

/// Terms of any size wrap around, so that what is left of two is what lies between them.
TEST(Absorption, DifferencesOfLargeTermsAreExact) {
    const auto between = [](double near, double far) {
        return static_cast<int64_t>(static_cast<uint64_t>(absorption_fixed(far)) -
                                    static_cast<uint64_t>(absorption_fixed(near)));
    };
    for (const double far : {0x1p29, 0x1p30, 0x1p31, 0x1p32, 3 * 0x1p31, 0x1p40, 0x1p50})
        for (const double apart : {0.25, 1.0, 1000.0, 0x1p20})
            EXPECT_EQ(between(far - apart, far), absorption_fixed(apart)) << far << ' ' << apart;
}

TEST(Absorption, PathsThroughMeshesInAnyOrder) {
    std::mt19937_64 engine(7);
    constexpr double farthest = 4 * 1.5;
    for (int round = 0; round < 2'000; ++round) {
        struct Crossing {
            int sign;
            double t;
        };
        const double sigma = std::ldexp(unit(engine), 20 - static_cast<int>(engine() % 40));
        std::vector<double> at(2 * (1 + engine() % 30));
        for (double& t : at) t = farthest * unit(engine);
        std::sort(at.begin(), at.end());
        std::vector<Crossing> crossings;
        Quad inside = 0;
        for (size_t i = 0; i < at.size(); ++i) {
            crossings.push_back({i % 2 ? 1 : -1, at[i]});
            inside += i % 2 ? Quad(at[i]) : -Quad(at[i]);
        }
        const auto path = [&] {
            PathSum sum;
            for (const Crossing& c : crossings) sum.add(c.sign, sigma, c.t, farthest);
            return sum;
        };
        const PathSum first = path();
        std::shuffle(crossings.begin(), crossings.end(), engine);
        ASSERT_EQ(path().sum, first.sum);
        ASSERT_EQ(path().loss(), first.loss());
        // Each term is rounded by half a unit of 2^-32, and its product by half an ulp.
        const double absorbed = static_cast<double>(static_cast<int64_t>(first.sum)) * 0x1p-32;
        const double slack = static_cast<double>(at.size()) * (0x1p-33 + sigma * farthest * 0x1p-53);
        ASSERT_NEAR(absorbed, static_cast<double>(sigma * inside), slack);
    }
}

TEST(Absorption, PathsThatStartOrEndInside) {
    PathSum starts;  // leaves at 2
    starts.add(1, 0.5, 2, 8);
    EXPECT_EQ(starts.loss(), absorption_loss(1));
    PathSum ends;  // enters at 1, ends at 3
    ends.add(-1, 0.5, 1, 8);
    ends.add(1, 0.5, 3, 8);
    EXPECT_EQ(ends.loss(), absorption_loss(1));
    PathSum through;
    through.add(-1, 0.3, 0.7, 8);
    through.add(1, 0.3, 0.7, 8);
    EXPECT_EQ(through.loss(), 0u);
}

TEST(Absorption, WrappingAndClampedSums) {
    PathSum sum;  // a partial sum far below the range comes back
    for (int i = 0; i < 3000; ++i) sum.add(-1, 0x1p20, 4, 4);
    for (int i = 0; i < 3000; ++i) sum.add(1, 0x1p20, 4, 4);
    sum.add(1, 1, 3, 4);
    EXPECT_EQ(sum.loss(), absorption_loss(3));
    PathSum clamped;
    clamped.add(1, 2, elementary::infinity, 4);
    EXPECT_EQ(clamped.sum, uint64_t{8} << 32);
    clamped.add(-1, 2, -5, 4);
    clamped.add(1, 2, elementary::not_a_number, 4);
    EXPECT_EQ(clamped.sum, uint64_t{8} << 32);
    PathSum below;  // what rounding can leave
    below.add(-1, 1, 0x1p-32, 4);
    EXPECT_EQ(below.sum, ~uint64_t{0});
    EXPECT_EQ(below.loss(), 0u);
    PathSum dark;
    dark.add(1, 0x1p20, 4, 4);
    EXPECT_EQ(dark.loss(), largest_loss);
}

}  // namespace
}  // namespace cistula
