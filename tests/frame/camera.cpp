#include "cistula/model/camera.h"

#include <gtest/gtest.h>

#include "cistula/transport/pixel.h"
#include "testing/support/scene.h"

namespace cistula {
namespace {

using glm::dvec3;
using test::Random;

Camera camera_looking(const dvec3& position, const dvec3& forward, double tan_half_width = 1) {
    const dvec3 right = normalized(cross(forward, dvec3(0.1, 0.2, 1))), up = cross(right, forward);
    return {position, forward, right, up, tan_half_width};
}

TEST(CameraTest, PointsOfThePictureAreWhereTheyShouldBe) {
    const Camera camera = {dvec3(0), {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 0.5};
    EXPECT_EQ(camera_direction(camera, 320, 240, 640, 480), (dvec3{0, 1, 0}));
    const auto slope = [&](double x, double y) {
        const dvec3 d = camera_direction(camera, x, y, 640, 480);
        EXPECT_NEAR(length(d), 1, 4e-16);
        return dvec3(d.x / d.y, d.z / d.y, 0);
    };
    // The width spans the field of view, pixels are square, row 0 is the top.
    EXPECT_NEAR(slope(640, 240).x, 0.5, 1e-15);
    EXPECT_NEAR(slope(0, 240).x, -0.5, 1e-15);
    EXPECT_NEAR(slope(320, 0).y, 0.375, 1e-15);
    EXPECT_NEAR(slope(320, 480).y, -0.375, 1e-15);
    EXPECT_NEAR(slope(0.5, 0.5).x, -0.5 * 639 / 640, 1e-15);
}

TEST(CameraTest, MirroredPointsHaveMirroredDirections) {
    const Camera camera = {dvec3(0), {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 0.7};
    Random random(1);
    for (int i = 0; i < 10000; ++i) {
        const double x = 0.5 * random.below(641), y = 0.5 * random.below(481);
        const dvec3 a = camera_direction(camera, x, y, 320, 240);
        const dvec3 b = camera_direction(camera, 320 - x, y, 320, 240),
                    c = camera_direction(camera, x, 240 - y, 320, 240);
        ASSERT_TRUE(a.x == -b.x && a.y == b.y && a.z == b.z);
        ASSERT_TRUE(a.x == c.x && a.y == c.y && a.z == -c.z);
    }
}

template <class Real>
class PrimaryRayTest : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(PrimaryRayTest, Precisions);

TYPED_TEST(PrimaryRayTest, StartsWhereItEntersTheSceneSphere) {
    using Real = TypeParam;
    SceneView<Real> scene{};
    scene.extent = Real(1.25);
    Random random(2);
    int entering = 0, past = 0;
    for (const double distance : {0.1, 2.4, 2.6, 10.0, 1e4, 1e9})
        for (int i = 0; i < 2000; ++i) {
            FrameView frame;
            const dvec3 forward = random.direction();
            frame.camera = camera_looking(forward * -distance, forward, max_or_second(4 / distance, 0.01));
            frame.camera_sides[0].start = frame.camera.position;
            frame.is_far = is_far(frame.camera.position, double(scene.extent));
            frame.width = frame.height = 100;
            frame.camera_sides[0].media.add(3, 1);
            Ray<Real> ray;
            dvec3 direction;
            double start;
            const double x = random.between(0, 100), y = random.between(0, 100);
            if (!primary_ray(scene, frame, x, y, ray, direction, start)) {
                ASSERT_GT(distance, 2.5);
                // It passes the sphere by, or so close that rounding decides.
                const dvec3 d = camera_direction(frame.camera, x, y, 100, 100), p = frame.camera.position;
                ASSERT_GT(length(p - dot(p, d) * d), 2.5 - 1e-12 - 4e-16 * distance);
                ++past;
                continue;
            }
            EXPECT_EQ(ray.direction, Vec3<Real>(direction));
            EXPECT_TRUE(ray.media.contains(3));
            if (distance < 2.5) {
                EXPECT_EQ(start, 0);
                EXPECT_EQ(ray.origin, Vec3<Real>(frame.camera.position));
                continue;
            }
            ++entering;
            ASSERT_NEAR(length(dvec3(ray.origin)), 2.5, 8 * double(RealTraits<Real>::unit) + 8 * 0x1p-53 * distance);
            // On the line, in front of the camera, where the line comes in.
            ASSERT_LT(length(frame.camera.position + start * direction - dvec3(ray.origin)),
                      8 * double(RealTraits<Real>::unit) + 8 * 0x1p-53 * distance);
            ASSERT_LE(dot(dvec3(ray.origin), direction), 1e-6);
        }
    EXPECT_GT(entering, 2000);
    EXPECT_GT(past, 500);
    // Looking away.
    FrameView frame;
    frame.camera = camera_looking({0, -10, 0}, {0, -1, 0});
    frame.camera_sides[0].start = frame.camera.position;
    frame.is_far = true;
    frame.width = frame.height = 10;
    Ray<Real> ray;
    dvec3 direction;
    double start;
    EXPECT_FALSE(primary_ray(scene, frame, 5, 5, ray, direction, start));
}

}  // namespace
}  // namespace cistula
