// elementary.h and trigonometry.h against libquadmath's 113 bits: worst errors are measured here and bind the stated
// ones.
#include <gtest/gtest.h>
#include <quadmath.h>

#include <algorithm>
#include <bit>
#include <random>
#include <vector>

#include "cistula/numerics/trigonometry.h"

namespace cistula {
namespace {

using Quad = __float128;
namespace e = elementary;

constexpr double inf = e::infinity, nan = e::not_a_number;
constexpr double tiny = 0x1p-1074, largest = 0x1.fffffffffffffp1023;

/// |value - exact| in units in the last place that a double of the size of `exact` has.
double ulps(double value, Quad exact) {
    int exponent = 0;
    frexpq(exact, &exponent);
    const Quad ulp = ldexpq(1, std::max(exponent - 53, -1074));
    return static_cast<double>(fabsq(Quad(value) - exact) / ulp);
}

struct Worst {
    double error = 0, x = 0, y = 0;

    void see(double value, Quad exact, double at_x, double at_y = 0) {
        const double found = ulps(value, exact);
        if (fabsq(exact) < Quad(0x1p-1022)) {
            EXPECT_LE(found, 0.85) << at_x << ", " << at_y;
            return;
        }
        if (!(found <= error)) error = found, x = at_x, y = at_y;
    }
    /// The statement holds, and is no looser than it has to be.
    void expect(const char* name, double stated) const {
        std::printf("%s: worst %.4f ulp at (%a, %a), stated %.2f\n", name, error, x, y, stated);
        EXPECT_LE(error, stated) << name << " at " << x << ", " << y;
        EXPECT_GE(error * 1.2, stated) << name << " is better than stated";
    }
};

class Random {
  public:
    explicit Random(uint64_t seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
    }
    /// +1 or -1 times a number of any exponent in [low, high].
    double any_size(int low, int high) {
        const double m = between(1, 2) * (engine_() & 1 ? 1 : -1);
        return std::ldexp(m, low + static_cast<int>(engine_() % static_cast<uint64_t>(high - low + 1)));
    }

  private:
    std::mt19937_64 engine_;
};

/// `steps` doubles on each side of x.
template <class F>
void around(double x, int steps, F&& f) {
    double below = x, above = std::nextafter(x, inf);
    for (int i = 0; i < steps; ++i) {
        f(below);
        f(above);
        below = std::nextafter(below, -inf);
        above = std::nextafter(above, inf);
    }
}

TEST(Elementary, Exp2WithinStatedError) {
    Worst worst;
    const auto see = [&](double x) { worst.see(e::exp2(x), exp2q(x), x); };
    Random random(1);
    for (int i = 0; i < 400'000; ++i) see(random.between(-1, 1));
    for (int i = 0; i < 200'000; ++i) see(random.between(-1076, 1024));
    for (int i = 0; i < 50'000; ++i) see(random.any_size(-80, 9));
    for (int i = -2048; i <= 2046; ++i) around(i * 0.5, 8, see);
    worst.expect("exp2", e::exp2_worst_ulp);
}

TEST(Elementary, Exp2ExactAndSpecialValues) {
    for (int k = -1074; k <= 1023; ++k) EXPECT_EQ(e::exp2(k), std::ldexp(1.0, k));
    EXPECT_EQ(e::exp2(1024), inf);
    EXPECT_EQ(e::exp2(inf), inf);
    EXPECT_EQ(e::exp2(largest), inf);
    EXPECT_EQ(e::exp2(std::nextafter(1024.0, 0.0)), static_cast<double>(exp2q(std::nextafter(1024.0, 0.0))));
    EXPECT_EQ(e::exp2(-1075), 0);
    EXPECT_EQ(e::exp2(std::nextafter(-1075.0, 0.0)), tiny);
    EXPECT_EQ(e::exp2(-inf), 0);
    EXPECT_EQ(e::exp2(-largest), 0);
    EXPECT_EQ(e::exp2(tiny), 1);
    EXPECT_EQ(e::exp2(-0.0), 1);
    EXPECT_TRUE(std::isnan(e::exp2(nan)));
}

TEST(Elementary, Log2WithinStatedError) {
    Worst worst;
    double worst_pair = 0;
    const auto see = [&](double x) {
        const Quad exact = log2q(x);
        worst.see(e::log2(x), exact, x);
        const DoubleDouble pair = e::log2_pair(x);
        if (exact != 0)
            worst_pair = std::max(worst_pair, static_cast<double>(fabsq((Quad(pair.high) + pair.low - exact) / exact)));
    };
    Random random(2);
    for (int i = 0; i < 300'000; ++i) see(random.between(0.5, 2));
    for (int i = 0; i < 200'000; ++i) see(std::fabs(random.any_size(-1074, 1023)));
    for (int i = 0; i < 50'000; ++i) see(1 + random.any_size(-53, -1));
    for (int k = -1074; k <= 1023; ++k)
        around(std::ldexp(1.0, k), k == -1074 ? 1 : 8, [&](double x) {
            if (x > 0) see(x);
        });
    around(std::sqrt(2.0), 2'000, see);
    around(std::sqrt(0.5), 2'000, see);
    around(1.0, 20'000, see);
    worst.expect("log2", e::log2_worst_ulp);
    std::printf("log2_pair: worst 2^%.2f relative\n", std::log2(worst_pair));
    EXPECT_LE(worst_pair, 0x1p-67);
}

TEST(Elementary, Log2ExactAndSpecialValues) {
    for (int k = -1074; k <= 1023; ++k) {
        EXPECT_EQ(e::log2(std::ldexp(1.0, k)), k);
        EXPECT_EQ(e::log2_pair(std::ldexp(1.0, k)).low, 0);
    }
    EXPECT_EQ(e::log2(0), -inf);
    EXPECT_EQ(e::log2(-0.0), -inf);
    EXPECT_EQ(e::log2(inf), inf);
    EXPECT_TRUE(std::isnan(e::log2(-tiny)));
    EXPECT_TRUE(std::isnan(e::log2(-inf)));
    EXPECT_TRUE(std::isnan(e::log2(nan)));
}

TEST(Elementary, PowWithinStatedError) {
    Worst worst;
    const auto see = [&](double x, double y) {
        const Quad exact = powq(x, y);
        if (exact >= Quad(largest) || exact < Quad(tiny) / 2) return;
        worst.see(e::pow(x, y), exact, x, y);
    };
    Random random(3);
    for (int i = 0; i < 150'000; ++i) see(random.between(0, 1), random.between(0, 200));  // highlights
    for (int i = 0; i < 150'000; ++i) see(random.between(0, 2), random.between(-2, 3));   // color curves
    for (int i = 0; i < 150'000; ++i) see(random.between(0.7, 1.42), random.between(-2000, 2000));
    for (int i = 0; i < 150'000; ++i) {  // results of every size from bases of every size
        const double x = std::fabs(random.any_size(-1074, 1023));
        see(x, random.between(-1074, 1024) / std::log2(x));
    }
    for (int i = 0; i < 50'000; ++i) {
        const double x = 1 + random.any_size(-50, -2);
        see(x, random.between(-1074, 1024) / std::log2(x));
    }
    worst.expect("pow", e::pow_worst_ulp);
}

TEST(Elementary, PowExactAndSpecialValues) {
    Random random(4);
    for (int i = 0; i < 50'000; ++i) {
        const double x = std::fabs(random.any_size(-1074, 1023)), y = random.any_size(-1074, 1023);
        EXPECT_EQ(e::pow(x, 1), x);
        EXPECT_EQ(e::pow(x, 0), 1);
        EXPECT_EQ(e::pow(1, y), 1);
        const double small = std::floor(random.between(0, 0x1p26));
        EXPECT_EQ(e::pow(small, 2), small * small);
        EXPECT_EQ(e::pow(small * small, 0.5), small);
    }
    for (int k = -1074; k <= 1023; ++k) EXPECT_EQ(e::pow(2, k), std::ldexp(1.0, k));
    for (double y : {tiny, 0.5, 1.0, 50.0, largest, inf}) {
        EXPECT_EQ(e::pow(0, y), 0);
        EXPECT_EQ(e::pow(-0.0, y), 0);
        EXPECT_EQ(e::pow(0, -y), inf);
        EXPECT_EQ(e::pow(inf, y), inf);
        EXPECT_EQ(e::pow(inf, -y), 0);
    }
    for (double y : {largest, inf}) {
        EXPECT_EQ(e::pow(std::nextafter(1.0, 0.0), y), 0);
        EXPECT_EQ(e::pow(std::nextafter(1.0, 0.0), -y), inf);
        EXPECT_EQ(e::pow(std::nextafter(1.0, 2.0), y), inf);
        EXPECT_EQ(e::pow(std::nextafter(1.0, 2.0), -y), 0);
    }
    EXPECT_EQ(e::pow(tiny, tiny), 1);
    EXPECT_EQ(e::pow(nan, 0), 1);
    EXPECT_EQ(e::pow(1, nan), 1);
    EXPECT_TRUE(std::isnan(e::pow(nan, 2)));
    EXPECT_TRUE(std::isnan(e::pow(2, nan)));
    EXPECT_TRUE(std::isnan(e::pow(0, nan)));
    EXPECT_TRUE(std::isnan(e::pow(-1, 2)));
}

/// Every binary exponent, the doubles nearest to multiples of a quarter turn, and the ranges that cameras use.
template <class F>
void angles(uint64_t seed, F&& see) {
    const Quad eighth_turn = atanq(1);
    Random random(seed);
    for (int i = 0; i < 150'000; ++i) see(random.between(-4, 4));
    for (int i = 0; i < 100'000; ++i) see(random.between(-1e6, 1e6));
    for (int i = 0; i < 50'000; ++i) see(random.any_size(-60, 20));
    for (int i = 0; i < 50'000; ++i) see(random.any_size(20, 40));
    for (int i = 0; i < 100'000; ++i) see(random.any_size(-1074, 1023));
    for (int n = -2'000; n <= 2'000; ++n) around(static_cast<double>(n * eighth_turn), 4, see);
    for (int i = 0; i < 20'000; ++i) see(static_cast<double>(floorq(random.between(-0x1p33, 0x1p33)) * eighth_turn));
    around(0x1p30, 2'000, see);
    // The double that comes nearest of all to a multiple of pi / 2 (Muller, Elementary Functions, table 11.1).
    around(0x1.6ac5b262ca1ffp+849, 1'000, see);
    see(largest);
}

TEST(Elementary, SinWithinStatedError) {
    Worst worst;
    angles(5, [&](double x) { worst.see(e::sin(x), sinq(x), x); });
    worst.expect("sin", e::sin_worst_ulp);
}

TEST(Elementary, CosWithinStatedError) {
    Worst worst;
    angles(6, [&](double x) { worst.see(e::cos(x), cosq(x), x); });
    worst.expect("cos", e::cos_worst_ulp);
}

TEST(Elementary, TanWithinStatedError) {
    Worst worst;
    angles(7, [&](double x) { worst.see(e::tan(x), tanq(x), x); });
    worst.expect("tan", e::tan_worst_ulp);
}

TEST(Elementary, Atan2WithinStatedError) {
    Worst worst;
    Random random(9);
    for (int i = 0; i < 400'000; ++i) {
        double x = double(random.between(-1, 1));
        double y = double(random.between(-1, 1));
        if (i % 4 == 1) y *= std::ldexp(1.0, -(i % 60));
        if (i % 4 == 2) x *= std::ldexp(1.0, -(i % 60));
        if (i % 4 == 3) y = x * (i % 33 / 16.0 - 1) * (1 + y * std::ldexp(1.0, -(i % 53)));  // near k / 16
        if (y == 0) continue;
        worst.see(e::atan2(y, x), atan2q(y, x), y);
        ASSERT_EQ(e::atan2(-y, x), -e::atan2(y, x));
    }
    worst.expect("atan2", e::atan2_worst_ulp);
    EXPECT_EQ(e::atan2(0, 0), 0);
    EXPECT_EQ(e::atan2(0, 1), 0);
    EXPECT_EQ(e::atan2(0, -1), 0x1.921fb54442d18p+1);
    EXPECT_EQ(e::atan2(1, 0), 0x1.921fb54442d18p+0);
    EXPECT_EQ(e::atan2(1, 1), 0x1.921fb54442d18p-1);
}

TEST(Elementary, AngleSymmetriesAndSpecialValues) {
    angles(8, [](double x) {
        ASSERT_EQ(e::sin(-x), -e::sin(x)) << x;
        ASSERT_EQ(e::cos(-x), e::cos(x)) << x;
        ASSERT_EQ(e::tan(-x), -e::tan(x)) << x;
        ASSERT_LE(std::fabs(e::sin(x)), 1) << x;
        ASSERT_LE(std::fabs(e::cos(x)), 1) << x;
    });
    EXPECT_EQ(e::cos(0), 1);
    for (double zero : {0.0, -0.0}) {
        EXPECT_EQ(std::bit_cast<uint64_t>(e::sin(zero)), std::bit_cast<uint64_t>(zero));
        EXPECT_EQ(std::bit_cast<uint64_t>(e::tan(zero)), std::bit_cast<uint64_t>(zero));
    }
    for (double x : {inf, -inf, nan}) {
        EXPECT_TRUE(std::isnan(e::sin(x)));
        EXPECT_TRUE(std::isnan(e::cos(x)));
        EXPECT_TRUE(std::isnan(e::tan(x)));
    }
}

TEST(Elementary, PowerBySquaring) {
    for (int n = 0; n <= 1024; ++n) {
        EXPECT_EQ(e::power_by_squaring(1.0f, n), 1.0f);
        EXPECT_EQ(e::power_by_squaring(-1.0, n), n % 2 ? -1.0 : 1.0);
        if (n <= 126) {
            EXPECT_EQ(e::power_by_squaring(0.5f, n), std::ldexp(1.0f, -n));
        }
        if (n <= 1022) {
            EXPECT_EQ(e::power_by_squaring(0.5, n), std::ldexp(1.0, -n));
        }
        EXPECT_EQ(e::power_by_squaring(0.0, n), n == 0 ? 1.0 : 0.0);
    }
    // Least bit first: x^7 = (x * x^2) * x^4.
    const float x = 0.7f, square = x * x;
    EXPECT_EQ(e::power_by_squaring(x, 7), (x * square) * (square * square));
    Random random(9);
    for (int i = 0; i < 20'000; ++i) {
        const double base = random.between(0.5, 1);
        const int n = static_cast<int>(random.between(0, 1025));
        const Quad exact = powq(base, n);
        if (exact > 0x1p-1000) {
            EXPECT_LE(ulps(e::power_by_squaring(base, n), exact), 2.0 * n + 1);
        }
    }
}

TEST(Elementary, Srgb) {
    const auto curve = [](Quad c) {
        return c * 100000 <= 4045 ? c * 100 / 1292 : powq((c * 1000 + 55) / 1055, Quad(12) / 5);
    };
    double before = -1;
    for (int i = 0; i <= 255; ++i) {
        const double linear = e::srgb_to_linear(i / 255.0);
        const double exact = static_cast<double>(curve(Quad(i) / 255));
        EXPECT_NEAR(linear, exact, 12 * 0x1p-53 * exact);  // 4 roundings of the base, times 2.4, and pow's own
        EXPECT_GT(linear, before);
        EXPECT_NEAR(e::linear_to_srgb(linear) * 255, i, 1e-5);  // the standard's two lines meet to seven digits
        before = linear;
    }
    EXPECT_EQ(e::srgb_to_linear(0), 0);
    EXPECT_EQ(e::srgb_to_linear(1), 1);
    EXPECT_EQ(e::linear_to_srgb(0), 0);
    EXPECT_NEAR(e::linear_to_srgb(1), 1, 0x1p-52);
    EXPECT_EQ(e::srgb_to_linear(-0.1), -0.1 / 12.92);
    EXPECT_TRUE(std::isnan(e::srgb_to_linear(nan)));
    EXPECT_TRUE(std::isnan(e::linear_to_srgb(nan)));
}

/// A hash of results that must never change, on any processor or compiler.
TEST(Elementary, BitsArePinned) {
    uint64_t hash = 1469598103934665603u;
    const auto take = [&](double value) { hash = (hash ^ std::bit_cast<uint64_t>(value)) * 1099511628211u; };
    Random random(10);
    for (int i = 0; i < 20'000; ++i) {
        const double x = random.any_size(-30, 40), y = random.between(-20, 20);
        take(e::exp2(y));
        take(e::log2(std::fabs(x)));
        take(e::pow(std::fabs(x), y));
        take(e::sin(x));
        take(e::cos(x));
        take(e::tan(x));
    }
    EXPECT_EQ(hash, 6298300954676170707u);
}

}  // namespace
}  // namespace cistula
