// snell.h and double_double.h against libquadmath's 113 bits. Worst errors are measured here and bind the stated ones.
#include "cistula/shading/snell.h"

#include <gtest/gtest.h>
#include <quadmath.h>

#include <cmath>
#include <cstdio>

#include "testing/support/scene.h"

namespace cistula {
namespace {

using Quad = __float128;
using test::Random;

template <class Real>
struct Exact {
    Quad g2;
    Quad direction[3], reflectance;

    Exact(const Vec3<Real>& d, const Vec3<Real>& normal, double from, double to) {
        const Quad n = Quad(to) / Quad(from);
        Quad c = 0;
        for (int k = 0; k < 3; ++k) c -= Quad(d[k]) * Quad(normal[k]);
        if (!(c > 0)) c = 0;
        g2 = (n - 1) * (n + 1) + c * c;
        if (!(g2 > 0)) return;
        const Quad g = sqrtq(g2);
        Quad square = 0;
        for (int k = 0; k < 3; ++k) {
            direction[k] = (Quad(d[k]) + (c - g) * Quad(normal[k])) / n;
            square += direction[k] * direction[k];
        }
        for (Quad& x : direction) x /= sqrtq(square);
        // The textbook's form: perpendicular and parallel amplitudes.
        const Quad s = (c - g) / (c + g), p = (n * n * c - g) / (n * n * c + g);
        reflectance = (s * s + p * p) / 2;
    }
};

template <class Real>
Quad ulp_of(Quad exact) {
    int exponent = 0;
    frexpq(exact, &exponent);
    return ldexpq(1, exponent - std::numeric_limits<Real>::digits);
}

template <class Real>
class SnellTest : public testing::Test {
  public:
    /// A unit vector at the given cosine to -normal.
    static Vec3<Real> incoming(Random& random, const glm::dvec3& normal, double c) {
        const glm::dvec3 other = random.direction();
        const glm::dvec3 tangent = normalized(other - dot(other, normal) * normal);
        const double s = std::sqrt((1 - c) * (1 + c));
        return Vec3<Real>(s * tangent - c * normal);
    }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(SnellTest, Precisions);

constexpr double indices[][2] = {{1, 1.5},
                                 {1.5, 1},
                                 {1, 2.417},
                                 {2.417, 1},
                                 {1.33, 1.5},
                                 {1.5, 1.33},
                                 {1, 1.0000001},
                                 {1.0000001, 1},
                                 {1, 40},
                                 {40, 1},
                                 {1, 0x1.0000000000001p0}};

TYPED_TEST(SnellTest, DirectionAndReflectanceAreWithinTheStatedErrors) {
    using Real = TypeParam;
    Random random(1);
    double worst_direction = 0, worst_reflectance = 0, worst_length = 0;
    int decisions = 0, bent = 0;
    for (int i = 0; i < 200000; ++i) {
        const auto& index = indices[random.below(std::size(indices))];
        const glm::dvec3 n = random.direction();
        const Vec3<Real> normal(n);
        // All angles, with as many close to grazing, normal and (where there is one) critical incidence as between.
        double c = random.unit();
        const double near = std::ldexp(random.unit(), -static_cast<int>(random.below(24)));
        if (i % 4 == 1) c = near;
        if (i % 4 == 2) c = 1 - near;
        const double ratio = index[1] / index[0];
        if (i % 4 == 3 && ratio < 1) c = std::min(1.0, std::sqrt((1 - ratio) * (1 + ratio)) * (1 + near));
        const Vec3<Real> d = TestFixture::incoming(random, n, c);
        const Exact<Real> exact(d, normal, index[0], index[1]);
        const Refraction<Real> found = refracted(d, normal, index[0], index[1]);
        ASSERT_EQ(found.total, !(exact.g2 > 0)) << index[0] << " to " << index[1] << ", g^2 = " << double(exact.g2);
        ++decisions;
        if (found.total) {
            ASSERT_EQ(found.reflectance, Real(1));
            continue;
        }
        ++bent;
        Quad square = 0;
        for (int k = 0; k < 3; ++k) {
            const Quad error = fabsq(Quad(found.direction[k]) - exact.direction[k]);
            worst_direction = std::max(worst_direction, double(error / Quad(RealTraits<Real>::unit)));
            square += Quad(found.direction[k]) * Quad(found.direction[k]);
        }
        worst_length = std::max(worst_length, double(fabsq(sqrtq(square) - 1) / Quad(RealTraits<Real>::unit)));
        ASSERT_TRUE(found.reflectance >= 0 && found.reflectance <= 1);
        // Where n or g^2 has lost more than a third of its bits to cancellation, the error is that of what is left.
        if (std::abs(ratio - 1) > 1e-3 && exact.g2 > Quad(0x1p-20))
            worst_reflectance = std::max(worst_reflectance, double(fabsq(Quad(found.reflectance) - exact.reflectance) /
                                                                   ulp_of<Real>(exact.reflectance)));
    }
    std::printf("%s: %d decisions, %d bent; direction %.3f u, length %.3f u, reflectance %.4f ulp\n",
                RealTraits<Real>::name, decisions, bent, worst_direction, worst_length, worst_reflectance);
    EXPECT_LE(worst_direction, 3.5);
    EXPECT_LE(worst_length, 3);
    EXPECT_LE(worst_reflectance, 0.51);
}

// sin = n (1 + k 2^-22): the decision is that of the angle itself, not of its rounding; in double, in steps of 2^-50
// too.
TYPED_TEST(SnellTest, CriticalAngleIsDecidedInFineSteps) {
    using Real = TypeParam;
    Random random(2);
    const double finest = sizeof(Real) == 4 ? 0x1p-22 : 0x1p-50;
    for (const double step : {0x1p-22, finest})
        for (const auto& index : {std::array{1.5, 1.0}, {1.5, 1.33}, {1.33, 1.0}, {2.0, 1.0}})
            for (int k = -200; k <= 200; ++k) {
                if (k == 0) continue;
                const Quad s = Quad(index[1]) / Quad(index[0]) * (1 + Quad(k) * Quad(step));
                const Vec3<Real> normal(Real(0), Real(0), Real(1));
                const Vec3<Real> d(Real(double(s)), Real(0), Real(double(-sqrtq((1 - s) * (1 + s)))));
                ASSERT_EQ(refracted(d, normal, index[0], index[1]).total, k > 0) << index[0] << " " << k;
                // The critical angle about other normals: the formula decides as its exact value does.
                const glm::dvec3 n = random.direction();
                const Vec3<Real> about(n), turned = TestFixture::incoming(random, n, double(sqrtq((1 - s) * (1 + s))));
                const Exact<Real> exact(turned, about, index[0], index[1]);
                ASSERT_EQ(refracted(turned, about, index[0], index[1]).total, !(exact.g2 > 0));
            }
}

TYPED_TEST(SnellTest, NormalIncidenceGoesStraightOn) {
    using Real = TypeParam;
    for (int axis = 0; axis < 3; ++axis)
        for (const auto& index : indices) {
            Vec3<Real> normal(Real(0));
            normal[axis] = 1;
            const Refraction<Real> found = refracted(-normal, normal, index[0], index[1]);
            ASSERT_FALSE(found.total);
            EXPECT_EQ(found.direction, -normal);
            const Quad n = Quad(index[1]) / Quad(index[0]), a = (n - 1) / (n + 1);
            if (std::abs(double(a)) > 1e-9) {
                EXPECT_LE(double(fabsq(Quad(found.reflectance) - a * a) / ulp_of<Real>(a * a)), 0.51);
            }
        }
}

TYPED_TEST(SnellTest, BrewsterReflectsNoParallelLight) {
    using Real = TypeParam;
    for (const double n : {1.33, 1.5, 2.417}) {
        const double c = 1 / std::sqrt(1 + n * n), s = n * c;
        const Refraction<Real> found =
            refracted(Vec3<Real>(Real(s), Real(0), Real(-c)), Vec3<Real>(Real(0), Real(0), Real(1)), 1.0, n);
        const double amplitude = (n * n - 1) / (n * n + 1);
        EXPECT_NEAR(double(found.reflectance), amplitude * amplitude / 2, 8 * double(RealTraits<Real>::unit));
        // Brewster's law: the refracted ray is at right angles to the reflected one.
        const Vec3<Real> mirror =
            reflected(Vec3<Real>(Real(s), Real(0), Real(-c)), Vec3<Real>(Real(0), Real(0), Real(1)));
        EXPECT_NEAR(double(dot(mirror, found.direction)), 0, 8 * double(RealTraits<Real>::unit));
    }
}

TYPED_TEST(SnellTest, GrazingReflectsEverything) {
    using Real = TypeParam;
    const Vec3<Real> normal(Real(0), Real(0), Real(1));
    // A cosine of 0, or below by rounding, is 0: all of the light is reflected on the way into the denser medium.
    for (const Real c : {Real(0), RealTraits<Real>::unit}) {
        const Refraction<Real> in = refracted(Vec3<Real>(Real(1), Real(0), c), normal, 1.0, 1.5);
        ASSERT_FALSE(in.total);
        EXPECT_EQ(in.reflectance, Real(1));
        EXPECT_NEAR(double(in.direction.x), 1 / 1.5, 4 * double(RealTraits<Real>::unit));
        EXPECT_TRUE(refracted(Vec3<Real>(Real(1), Real(0), c), normal, 1.5, 1.0).total);
    }
}

// The ray tree never bends at equal indices; what would come back is the direction, renormalized, and no reflection.
TYPED_TEST(SnellTest, EqualIndicesReflectNothing) {
    using Real = TypeParam;
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
        const glm::dvec3 n = random.direction();
        const Vec3<Real> d = TestFixture::incoming(random, n, random.between(1e-6, 1));
        for (const double index : {1.0, 1.5, 2.417}) {
            const Refraction<Real> found = refracted(d, Vec3<Real>(n), index, index);
            ASSERT_FALSE(found.total);
            ASSERT_EQ(found.reflectance, Real(0));
            ASSERT_EQ(found.direction, renormalized(d));
        }
    }
}

TYPED_TEST(SnellTest, ReflectedIsTheMirrorDirection) {
    using Real = TypeParam;
    Random random(4);
    double worst = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3<Real> n(random.direction()), d(random.direction());
        const Vec3<Real> found = reflected(d, n);
        Quad dn = 0, exact[3], square = 0;
        for (int k = 0; k < 3; ++k) dn += Quad(d[k]) * Quad(n[k]);
        for (int k = 0; k < 3; ++k) exact[k] = Quad(d[k]) - 2 * dn * Quad(n[k]), square += exact[k] * exact[k];
        for (int k = 0; k < 3; ++k)
            worst = std::max(worst,
                             double(fabsq(Quad(found[k]) - exact[k] / sqrtq(square)) / Quad(RealTraits<Real>::unit)));
    }
    std::printf("%s: mirror direction %.3f u\n", RealTraits<Real>::name, worst);
    EXPECT_LE(worst, 5);
}

Quad quad(const DoubleDouble& a) {
    return Quad(a.high) + Quad(a.low);
}

// In units of 2^-106. Sums: relative error at most 3 + 13 * 2^-53; products 5; quotients and roots as measured.
TEST(DoubleDoubleTest, ArithmeticIsWithinTheStatedErrors) {
    Random random(5);
    double worst[5] = {};
    // At most 107 bits, which a Quad holds.
    const auto low_part = [&](int exponent) {
        return std::ldexp(floor_of(random.between(-0x1p52, 0x1p52)), exponent - 106);
    };
    const auto number = [&] {
        const int exponent = static_cast<int>(random.below(40)) - 20;
        const double high = std::ldexp(random.between(1, 2), exponent);
        return two_sum(random.below(2) ? high : -high, low_part(exponent));
    };
    const auto see = [&](int which, const DoubleDouble& found, Quad exact) {
        if (exact == 0) {
            ASSERT_EQ(quad(found), Quad(0));
            return;
        }
        worst[which] = std::max(worst[which], double(fabsq((quad(found) - exact) / exact) * Quad(0x1p106)));
        ASSERT_EQ(found.high, found.high + found.low);  // normalized
    };
    for (int i = 0; i < 500000; ++i) {
        const DoubleDouble a = number();
        DoubleDouble b = number();
        if (i % 3 == 0) b = two_sum(-a.high, low_part(std::ilogb(a.high)));  // cancellation
        see(0, a + b, quad(a) + quad(b));
        see(1, a - b, quad(a) - quad(b));
        see(2, a * b, quad(a) * quad(b));
        see(3, a / b, quad(a) / quad(b));
        const DoubleDouble positive = a.high > 0 ? a : -a;
        see(4, up_sqrt(positive), sqrtq(quad(positive)));
        ASSERT_EQ(a > b, quad(a) > quad(b));
        const double x = a.high, y = b.high;
        ASSERT_EQ(quad(two_sum(x, y)), Quad(x) + Quad(y));
        ASSERT_EQ(quad(two_product(x, y)), Quad(x) * Quad(y));
    }
    std::printf("double-double, in 2^-106: + %.2f, - %.2f, * %.2f, / %.2f, sqrt %.2f\n", worst[0], worst[1], worst[2],
                worst[3], worst[4]);
    EXPECT_LE(worst[0], 3.1);
    EXPECT_LE(worst[1], 3.1);
    EXPECT_LE(worst[2], 5);
    EXPECT_LE(worst[3], 10);
    EXPECT_LE(worst[4], 4);
    EXPECT_EQ(up_sqrt(DoubleDouble(0)).high, 0);
    EXPECT_EQ(quad(up_sqrt(DoubleDouble(4))), Quad(2));
}

}  // namespace
}  // namespace cistula
