// Cameras on faces, edges, corners and contacts: each ray starts on the side to which it goes, inside the bodies that
// are there.
#include <gtest/gtest.h>

#include <functional>

#include "render/frame/frame_view.h"
#include "scene/description/camera_path.h"
#include "testing/support/contacts/ideal_contact.h"
#include "testing/support/intersectors.h"

namespace cistula {
namespace {

using test::Basis;
using test::BodyKind;
using test::ContactCounts;
using test::ContactScene;
using test::dvec3;
using test::Random;

struct Place {
    const char* name;
    dvec3 at;  // in the arrangement's coordinates
    int planes;
};
/// A cube of side 1 with a corner at (0, 0, 0), on a floor at z = 0, with a smaller one at x > 1 beside it.
const Place places[] = {
    {"on the floor", {-1, -1, 0}, 1},
    {"on the floor below the cube", {0.3, 0.6, 0}, 1},
    {"on a face", {0.4, 0, 0.3}, 1},
    {"on an edge", {0, 0, 0.4}, 2},
    {"on an edge on the floor", {0.4, 0, 0}, 2},
    {"on a corner on the floor", {0, 0, 0}, 3},
    {"on an upper corner", {0, 1, 1}, 3},
    {"between two bodies", {1, 0.5, 0.2}, 1},
    {"nowhere", {0.4, 0.5, 0.3}, 0},
};

template <class Real>
class CamerasAtContacts : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(CamerasAtContacts, Reals);

TYPED_TEST(CamerasAtContacts, RaysStartWhereTheyGo) {
    using Real = TypeParam;
    Random random(3);
    for (const Place& place : places)
        for (const BodyKind kind : {BodyKind::planes, BodyKind::mesh}) {
            size_t wrong = 0, on_floor = 0, rays = 0;
            for (int turn = 0; turn < 30; ++turn) {
                ContactScene contact(turn == 0 ? Basis() : Basis::random(random), random.in_cube(1));
                test::add_material(contact.scene, 0, 0.5);
                contact.quad({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 0);
                contact.cube(0.5, 0.5, 0, 1, 0, 0, kind);
                contact.cube(1.3, 0.5, 0, 0.6, 0, 0, kind);
                contact.scene.camera.position = contact.place(place.at);
                contact.scene.camera.target = contact.scene.camera.position + random.direction();
                const auto compiled = compile_scene<Real>(contact.scene);
                const SceneView<Real> view = compiled->view();
                const test::Brute<Real> brute{view};
                FrameSettings settings;
                settings.set_size(64, 64);
                FrameView frame = frame_view(*compiled, camera_at(contact.scene.camera, 0), settings);
                EXPECT_EQ(frame.camera_planes, place.planes) << place.name;
                ASSERT_TRUE(find_camera_solids(view, brute, frame));
                ContactCounts counts;
                const test::CheckedIntersector<Real, test::Brute<Real>> checked(*compiled, contact.bodies, brute,
                                                                                counts);
                for (int i = 0; i < 200; ++i, ++rays) {
                    Ray<Real> ray;
                    double start;
                    ASSERT_TRUE(primary_ray(view, frame, random.direction(), ray, start));
                    const Hit<Real> hit = checked.template closest<Effects<all_effects>>(ray);
                    on_floor += place.at.z == 0 && hit.found() && key_solid(hit.key) == 0;
                }
                wrong += counts.media + counts.passed + counts.false_sheet;
            }
            EXPECT_EQ(wrong, 0u) << place.name << (kind == BodyKind::mesh ? ", meshes" : ", planes");
            EXPECT_EQ(on_floor, 0u) << place.name;
            EXPECT_EQ(rays, 6000u);
        }
}

/// Wherever a camera is that double sees beside planes, its rays start clearly on the same side of each.
TYPED_TEST(CamerasAtContacts, StayOnTheirSideOfPlanes) {
    using Real = TypeParam;
    Random random(9);
    FrameSettings settings;
    settings.set_size(16, 16);
    size_t moved = 0;
    for (int turn = 0; turn < 500; ++turn) {
        SceneDescription scene;
        test::add_material(scene);
        SphereObject ball;
        test::add_object(scene, ball, 0);
        const dvec3 normal = turn % 5 == 0 ? dvec3(0, 0, 1) : random.direction();
        const double offset = random.between(-2, 2);
        test::add_object(scene, DiskObject::plane(normal, offset), 0);
        const double aside = std::pow(10, random.between(-1, 9));
        const double height = std::pow(10, random.between(-7, 1)) * (random.below(2) == 0 ? 1 : -1);
        scene.camera.position = (offset + height) * normal + aside * normalized(cross(normal, random.direction()));
        const auto compiled = compile_scene<Real>(scene);
        const double exact = dot(normal, scene.camera.position) - offset;
        const double size = length(scene.camera.position), unit = double(RealTraits<Real>::unit);
        if (std::abs(exact) < 64 * 0x1p-53 * size) continue;  // it may lie on it
        const FrameView frame = frame_view(*compiled, camera_at(scene.camera, 0), settings);
        ASSERT_EQ(frame.camera_planes, 0) << height << " " << aside;
        const Vec3<double>& start = frame.camera_sides[0].start;
        const double seen = double(distance_from(compiled->shared_planes[compiled->disks[0].plane], Vec3<Real>(start)));
        EXPECT_GE((exact > 0 ? 1 : -1) * seen, 4 * unit * length(start)) << height << " " << aside;
        const double way = length(start - frame.camera.position);
        EXPECT_LE(way, 32 * unit * length(frame.camera.position));
        moved += way > 0;
    }
    EXPECT_GE(moved, sizeof(Real) == sizeof(float) ? 100u : 0u);
}

}  // namespace
}  // namespace cistula
