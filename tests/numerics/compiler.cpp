// What the code takes for granted of its compiler and flags, where a compiler is known to break it.
#include <gtest/gtest.h>

#include "cistula/numerics/vec.h"

#ifdef __clang__
#define OPAQUE __attribute__((noinline))
#else
#define OPAQUE __attribute__((noipa))
#endif

namespace cistula {
namespace {

OPAQUE void round_pair(double* __restrict to, const double* __restrict from) {
    const float x = static_cast<float>(from[0]), y = static_cast<float>(from[1]);
    to[0] = x;
    to[1] = y;
}

OPAQUE Vec3<double> round_vector(const Vec3<double>& v) {
    return Vec3<double>(Vec3<float>(v));
}

// GCC 12 drops both conversions of double -> float -> double where its basic-block vectorizer takes them in pairs
// (from -O2 on). Shading rounds points and directions to float and goes on in double: -fno-tree-slp-vectorize.
TEST(CompilerTest, RoundingToFloatIsNotElided) {
    const double from[2] = {0.1, 0.7};
    double to[2];
    round_pair(to, from);
    EXPECT_EQ(to[0], 0x1.99999ap-4);
    EXPECT_EQ(to[1], 0x1.666666p-1);
    const Vec3<double> v = round_vector({0.1, 0.7, 0.2});
    EXPECT_EQ(v, (Vec3<double>(0x1.99999ap-4, 0x1.666666p-1, 0x1.99999ap-3)));
}

OPAQUE double product_difference(double a, double b, double c) {
    return a * b - c;
}

TEST(CompilerTest, NothingIsContracted) {
    const double a = 1 + 0x1p-30;
    EXPECT_EQ(product_difference(a, a, a * a), 0);
    EXPECT_EQ(fused(a, a, -(a * a)), 0x1p-60);
}

OPAQUE double halved(double a) {
    return a * 0.5;
}

TEST(CompilerTest, SubnormalsAreKept) {
    EXPECT_EQ(halved(0x1p-1022), 0x1p-1023);
    EXPECT_GT(halved(0x1p-1022), 0);
}

}  // namespace
}  // namespace cistula
