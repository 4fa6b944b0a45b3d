// pixel_sums.h: what is added, what is left out, and what counts as a fault.
#include <gtest/gtest.h>

#include "cistula/transport/pixel_sums.h"

namespace cistula {
namespace {

template <class Real>
struct Bounds {
    Vec3<Real> bound;
    Real largest_bound;
};

template <class Real>
class PixelSumsTest : public testing::Test {
  protected:
    /// A sample's of a pixel of one sample.
    PixelSums<Real> sums(int64_t budget = 0) {
        settings_.fixed_scale = 0x1p62f;
        settings_.fixed_unit = 0x1p-62f;
        settings_.budget = budget;
        return {settings_, bounds_, record_, flags_};
    }

    static constexpr int64_t one = int64_t(1) << 62;
    TreeSettings settings_;
    Bounds<Real> bounds_{Vec3<Real>(Real(1), Real(0.5), Real(0.25)), Real(1)};
    PixelRecord record_ = PixelRecord();
    uint32_t flags_ = 0;
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(PixelSumsTest, Reals);

TYPED_TEST(PixelSumsTest, AddsInUnits) {
    using Real = TypeParam;
    PixelSums<Real> sums = this->sums();
    sums.add(Vec3<Real>(Real(1), Real(0.75), Real(0)));
    sums.add(Vec3<Real>(Real(0), Real(0.125), Real(0x1p-62)));
    EXPECT_EQ(this->record_.radiance[0], this->one);
    EXPECT_EQ(this->record_.radiance[1], this->one / 8 * 7);
    EXPECT_EQ(this->record_.radiance[2], 1);
    EXPECT_EQ(this->flags_, 0u);
}

TYPED_TEST(PixelSumsTest, NegativeZeroIsZero) {
    using Real = TypeParam;
    this->sums().add(Vec3<Real>(-Real(0), Real(0.5), -Real(0)));
    EXPECT_EQ(this->record_.radiance[0], 0);
    EXPECT_EQ(this->record_.radiance[1], this->one / 2);
    EXPECT_EQ(this->flags_, 0u);
}

// Also the number right above 1, and the least below 0.
TYPED_TEST(PixelSumsTest, WhatIsNotInTheUnitIntervalIsFlaggedAndCountsAsNothing) {
    using Real = TypeParam;
    using Limits = std::numeric_limits<Real>;
    for (const Real fault : {Limits::quiet_NaN(), -Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(),
                             Limits::max(), Real(1) + Limits::epsilon(), -Limits::denorm_min(), Real(-1)})
        for (int c = 0; c < 3; ++c) {
            Vec3<Real> radiance(Real(0.5));
            radiance[c] = fault;
            this->record_ = PixelRecord();
            this->flags_ = 0;
            PixelSums<Real> sums = this->sums();
            sums.add(radiance);
            EXPECT_EQ(this->flags_, uint32_t(flag_not_finite)) << fault << " in channel " << c;
            for (int other = 0; other < 3; ++other)
                EXPECT_EQ(this->record_.radiance[other], other == c ? 0 : this->one / 2)
                    << fault << " in channel " << c;
            this->flags_ = 0;
            sums.cut(radiance);
            // A bound under 1 in that channel may bring it back.
            const Real bounded = radiance[c] * this->bounds_.bound[c];
            const bool is_fault = !(bounded >= Real(0) && bounded <= Real(1));
            EXPECT_EQ(this->flags_, is_fault ? uint32_t(flag_not_finite) : 0u) << fault << " in channel " << c;
            for (int other = 0; other < 3; ++other) {
                const int64_t half = this->one >> (other + 1);  // of the bound
                if (other != c || is_fault) {
                    EXPECT_EQ(this->record_.cut[other], other == c ? 0 : half) << fault << " in channel " << c;
                }
            }
        }
}

TYPED_TEST(PixelSumsTest, BoundsAreRoundedUp) {
    using Real = TypeParam;
    PixelSums<Real> sums = this->sums();
    sums.cut(Vec3<Real>(Real(0x1p-62), Real(0x1p-62), Real(0x1p-62)));
    EXPECT_EQ(this->record_.cut[0], 1);
    EXPECT_EQ(this->record_.cut[1], 1);
    EXPECT_EQ(this->record_.cut[2], 1);
    EXPECT_EQ(this->flags_, 0u);
}

// A tenth of what is left, and never more than the budget altogether.
TYPED_TEST(PixelSumsTest, ABudgetIsSpentByTenths) {
    using Real = TypeParam;
    constexpr int64_t budget = int64_t(1) << 40;
    PixelSums<Real> sums = this->sums(budget);
    EXPECT_TRUE(sums.afford(Real(0x1p-25)));   // 2^37 units of 2^40 are more than a tenth
    EXPECT_FALSE(sums.afford(Real(0x1p-26)));  // 2^36 are less
    EXPECT_EQ(this->record_.pruned[0], int64_t(1) << 36);
    EXPECT_EQ(this->record_.pruned[1], int64_t(1) << 35);
    int dropped = 1;
    while (dropped < 1000 && !sums.afford(Real(0x1p-26))) ++dropped;
    EXPECT_LT(this->record_.pruned[0], budget);
    EXPECT_LT(dropped, 16);
    EXPECT_FALSE(this->sums().afford(Real(0x1p-62)));  // at most one unit
    EXPECT_TRUE(this->sums().afford(Real(0x1p-61)));
}

}  // namespace
}  // namespace cistula
