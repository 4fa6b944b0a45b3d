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
    PixelSums<Real> sums() {
        settings_.fixed_scale = 0x1p62f;
        settings_.fixed_unit = 0x1p-62f;
        return {settings_, bounds_, record_, flags_};
    }
    PixelSums<Real, true> limited_sums(float threshold, int64_t budget = endless_budget) {
        sums();
        return {settings_, bounds_, record_, flags_, TreeLimit<Real, true>(threshold, budget)};
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

TYPED_TEST(PixelSumsTest, BranchesUpToTheThresholdAreDropped) {
    using Real = TypeParam;
    PixelSums<Real, true> sums = this->limited_sums(0x1p-22f);
    EXPECT_TRUE(sums.afford(Real(0x1.000002p-22)));
    EXPECT_EQ(this->record_.pruned[0], 0);
    for (int drops = 1; drops <= 3; ++drops) {
        EXPECT_FALSE(sums.afford(Real(0x1p-22)));
        EXPECT_EQ(this->record_.pruned[0], drops * (int64_t(1) << 40));
        EXPECT_EQ(this->record_.pruned[1], drops * (int64_t(1) << 39));
    }
    EXPECT_EQ(sums.left(), endless_budget);
    EXPECT_FALSE(this->sums().afford(Real(0x1p-62)));  // at most one unit
    EXPECT_TRUE(this->sums().afford(Real(0x1p-61)));
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    EXPECT_TRUE(sums.afford(Vec3<Real>(nan, Real(0.5), Real(0))));
    EXPECT_FALSE(sums.afford(Vec3<Real>(nan, Real(0x1p-30), Real(0))));
    EXPECT_NE(this->flags_ & flag_not_finite, 0u);
}

TYPED_TEST(PixelSumsTest, ATreeThatLosesMoreThanItsBudgetIsOver) {
    using Real = TypeParam;
    PixelSums<Real, true> sums = this->limited_sums(0x1p-22f, int64_t(3) << 40);
    for (int drops = 1; drops <= 3; ++drops) {
        EXPECT_FALSE(sums.afford(Vec3<Real>(Real(0x1p-24), Real(0x1p-21), Real(0))));  // its greatest channel counts
        EXPECT_EQ(sums.left(), int64_t(3 - drops) << 40);
    }
    EXPECT_FALSE(sums.afford(Real(0x1p-62)));
    EXPECT_EQ(sums.left(), -1);
}

TEST(TreeThreshold, BeginsWithAPowerOfTwoOfAnEighthOfTheBudget) {
    constexpr float unit = 0x1p-62f;
    EXPECT_EQ(TreeThreshold::first(0, unit), unit);
    EXPECT_EQ(TreeThreshold::first(15, unit), unit);
    EXPECT_EQ(TreeThreshold::first(16, unit), 2 * unit);
    EXPECT_EQ(TreeThreshold::first(31, unit), 2 * unit);
    EXPECT_EQ(TreeThreshold::first(int64_t(1) << 62, unit), 0.125f);
}

TEST(TreeThreshold, LimitsWhatATreeLosesUntilItHasGrownOrIsOneUnit) {
    TreeSettings settings;
    settings.fixed_unit = 0x1p-62f;
    settings.budget = 1000;
    TreeThreshold threshold{0x1p-58f};
    EXPECT_EQ(threshold.left(settings), 1000);
    threshold.shrink();
    EXPECT_EQ(threshold.of_branches(settings), 0x1p-61f);
    EXPECT_EQ(threshold.left(settings), 1000);
    threshold.shrink();
    EXPECT_EQ(threshold.of_branches(settings), 0x1p-62f);
    EXPECT_EQ(threshold.left(settings), endless_budget);
    threshold.grow();
    EXPECT_EQ(threshold.of_branches(settings), 0x1p-61f);
    EXPECT_EQ(threshold.left(settings), endless_budget);
    threshold.grow();
    EXPECT_EQ(threshold.of_branches(settings), 0x1p-58f);
}

}  // namespace
}  // namespace cistula
