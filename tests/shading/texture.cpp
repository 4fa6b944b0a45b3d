#include "cistula/model/texture.h"

#include <gtest/gtest.h>

#include <vector>

namespace cistula {
namespace {

/// 3 x 2 texels: red tells the column, green the row; row 0 is at v = 0.
const std::vector<Vec3<float>> texels = {{9, 9, 9},  // another texture's
                                         {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 1, 1}};

template <class Real>
class TextureTest : public testing::Test {
  public:
    static Vec3<Real> at(TextureFilter filter, double u, double v, double repeat_u = 1, double repeat_v = 1,
                         TextureWrap wrap_u = TextureWrap::repeat, TextureWrap wrap_v = TextureWrap::repeat) {
        SceneView<Real> scene{};
        scene.texels = {texels.data(), uint32_t(texels.size())};
        return texture_at(scene, Texture{3, 2, 1, filter, {wrap_u, wrap_v}, {repeat_u, repeat_v}},
                          Vec2<Real>(Real(u), Real(v)));
    }
    static Vec3<Real> rgb(double r, double g) { return {Real(r), Real(g), Real(1)}; }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(TextureTest, Precisions);

TYPED_TEST(TextureTest, NearestTakesTheTexelUnderThePoint) {
    using T = TestFixture;
    const auto nearest = TextureFilter::nearest;
    for (int turn = -3; turn <= 3; ++turn)
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x)
                for (const double inset : {0.01, 0.5, 0.99})
                    EXPECT_EQ(T::at(nearest, (x + inset) / 3 + turn, (y + inset) / 2 - turn), T::rgb(x, y));
    EXPECT_EQ(T::at(nearest, 0, 0), T::rgb(0, 0));  // a texel holds its lower bounds
    EXPECT_EQ(T::at(nearest, 0, 0.5), T::rgb(0, 1));
    EXPECT_EQ(T::at(nearest, 1, 1), T::rgb(0, 0));
    EXPECT_EQ(T::at(nearest, -1e-6, -1e-6), T::rgb(2, 1));
}

TYPED_TEST(TextureTest, RepeatScalesTheCoordinates) {
    using T = TestFixture;
    EXPECT_EQ(T::at(TextureFilter::nearest, 0.25, 0.25, 2, 4), T::rgb(1, 0));  // at 0.5, 1
    EXPECT_EQ(T::at(TextureFilter::nearest, 0.7, 0.2, 0.5, 3), T::rgb(1, 1));  // at 0.35, 0.6
    EXPECT_EQ(T::at(TextureFilter::bilinear, 0.25, 0.0625, 2, 4), T::rgb(1, 0));
}

TYPED_TEST(TextureTest, BilinearIsExactAtCentersAndLinearBetween) {
    using T = TestFixture;
    using Real = TypeParam;
    const auto bilinear = TextureFilter::bilinear;
    const double u = double(RealTraits<Real>::unit);
    const auto near = [&](const Vec3<Real>& found, double r, double g) {
        EXPECT_NEAR(double(found.x), r, 64 * u);
        EXPECT_NEAR(double(found.y), g, 64 * u);
        EXPECT_NEAR(double(found.z), 1, 4 * u);
    };
    for (int turn = -2; turn <= 2; ++turn) {
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x) near(T::at(bilinear, (x + 0.5) / 3 + turn, (y + 0.5) / 2 + turn), x, y);
        near(T::at(bilinear, 1.0 / 3 + turn, 0.25), 0.5, 0);
        near(T::at(bilinear, 1.0 / 3 + turn, 0.5), 0.5, 0.5);
        near(T::at(bilinear, 0.25 + 0.5 / 3 + turn, 0.375), 0.75, 0.25);
        near(T::at(bilinear, 1.0 + turn, 0.25), 1, 0);       // across the seam: columns 2 and 0
        near(T::at(bilinear, 0.5 / 3, 1.0 + turn), 0, 0.5);  // rows 1 and 0
    }
    EXPECT_EQ(T::at(bilinear, 0.5, 0.25), T::rgb(1, 0));
}

TYPED_TEST(TextureTest, ClampAndMirrorContinueEachAxisInTheirWay) {
    using T = TestFixture;
    const auto nearest = TextureFilter::nearest, bilinear = TextureFilter::bilinear;
    const auto clamp = TextureWrap::clamp, mirror = TextureWrap::mirror, repeat = TextureWrap::repeat;
    for (const double u : {-7.5, -1e-6, 0.1}) EXPECT_EQ(T::at(nearest, u, 0.75, 1, 1, clamp), T::rgb(0, 1)) << u;
    for (const double u : {0.9, 1.0, 1.3, 1e20}) EXPECT_EQ(T::at(nearest, u, 0.75, 1, 1, clamp), T::rgb(2, 1)) << u;
    // Columns of u = -1 to 3, in thirds: 2 1 0 | 0 1 2 | 2 1 0 | 0 1 2.
    const int mirrored[] = {2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1, 2};
    for (int i = 0; i < 12; ++i)
        EXPECT_EQ(T::at(nearest, (i - 3 + 0.5) / 3, 0.25, 1, 1, mirror), T::rgb(mirrored[i], 0)) << i;
    EXPECT_EQ(T::at(nearest, 1.1, 1.1, 1, 1, repeat, clamp), T::rgb(0, 1));
    EXPECT_EQ(T::at(nearest, 1.1, 1.1, 1, 1, clamp, repeat), T::rgb(2, 0));
    EXPECT_EQ(T::at(nearest, 0.9, 0.25, 2, 1, clamp), T::rgb(2, 0));  // after `repeat`
    // Half a texel from an edge inward nothing of the other edge is blended in.
    for (const TextureWrap wrap : {clamp, mirror}) {
        EXPECT_EQ(T::at(bilinear, 0, 0, 1, 1, wrap, wrap), T::rgb(0, 0));
        EXPECT_EQ(T::at(bilinear, 1, 1, 1, 1, wrap, wrap), T::rgb(2, 1));
        EXPECT_EQ(T::at(bilinear, 0.05, 0.97, 1, 1, wrap, wrap), T::rgb(0, 1));
    }
}

TYPED_TEST(TextureTest, AnyNumberStaysInsideThePicture) {
    using T = TestFixture;
    using Real = TypeParam;
    const double inf = RealTraits<double>::infinity, nan = std::numeric_limits<double>::quiet_NaN();
    for (const double x : {1e6, -1e6, 1e30, -1e30, inf, -inf, nan})
        for (const double y : {0.0, 1e30, -inf, nan}) {
            const Vec3<Real> found = T::at(TextureFilter::nearest, x, y);
            EXPECT_EQ(found.z, Real(1)) << x << " " << y;
            T::at(TextureFilter::bilinear, x, y);
            for (const TextureWrap wrap : {TextureWrap::clamp, TextureWrap::mirror})
                EXPECT_EQ(T::at(TextureFilter::nearest, x, y, 1, 1, wrap, wrap).z, Real(1)) << x << " " << y;
        }
    for (uint32_t n : {1u, 2u, 3u, 7u, 640u})
        for (int i = -2000; i <= 2000; ++i)
            ASSERT_EQ(repeated(Real(i), n), uint32_t(((i % int(n)) + int(n)) % int(n))) << i << " " << n;
    // Up to where float numbers are far apart.
    for (const int64_t n : {3, 4187, 65535})
        for (int64_t far = 1 << 20; far < int64_t{1} << 40; far += far / 7) {
            const Real i = -Real(far);
            ASSERT_EQ(repeated(i, uint32_t(n)), uint32_t((int64_t(i) % n + n) % n)) << int64_t(i) << " " << n;
        }
}

}  // namespace
}  // namespace cistula
