// Where a sheet mirrors a solid, the solid's outline in that mirror holds the pixel; and it holds little else.
#include <gtest/gtest.h>

#include <algorithm>

#include "cistula/bvh.h"
#include "scene/frame_view.h"
#include "scene/mirrored_cover.h"
#include "scene/read_scene.h"
#include "scene/without_effect.h"
#include "support_camera.h"
#include "support_scene.h"

using namespace cistula;

namespace {

const std::string source = CISTULA_SOURCE_DIR;

SceneDescription described(const std::string& name) {
    return read_scene(source + "/scenes/" + name + ".json");
}

template <class Real>
FrameCover cover_of(const SceneDescription& description) {
    const auto scene = compile_scene<Real>(description);
    FrameSettings settings;
    settings.set_size(40, 30);
    return mirrored_cover(*scene, frame_view(*scene, camera_at(description.camera, 0), settings), settings.crop);
}

bool holds(const FrameCover& cover, size_t hull, int x, int y) {
    return std::ranges::any_of(cover.outlines(), [&](const FrameCover::Outline& outline) {
        const PixelRun run = outline.run(y);
        return outline.hull == hull && x >= run.begin && x < run.end;
    });
}

/// Pixels of mirrors, those of them that show a convex solid, and those that an outline holds.
struct Counts {
    size_t mirrors = 0, solids = 0, held = 0;
};

/// By rays from the camera, and those that a sheet sends back.
template <class Real>
void expect_held(const SceneDescription& description, const CameraFrame& camera, Counts& counts) {
    const auto scene = compile_scene<Real>(description);
    build_primitive_tree(*scene);
    const SceneView<Real> view = scene->view();
    const BvhIntersector<Real> intersector{view};
    FrameSettings settings;
    settings.set_size(96, 54);
    settings.crop = {5, 3, 83, 47};
    FrameView frame = frame_view(*scene, camera, settings);
    camera_solids(view, intersector, frame.camera.position, frame.camera_media);
    const FrameCover cover = mirrored_cover(*scene, frame, settings.crop);
    const auto kind_of = [&](const Hit<Real>& hit) { return view.solids[key_solid(hit.key)].kind; };
    size_t missing = 0;
    for (int y = 0; y < settings.crop.height; ++y)
        for (int x = 0; x < settings.crop.width; ++x) {
            Ray<Real, MediaList> ray;
            Vec3<double> direction;
            double start;
            if (!primary_ray(view, frame, settings.crop.x + x + 0.5, settings.crop.y + y + 0.5, ray, direction, start))
                continue;
            const Hit<Real> hit = intersector.closest(ray);
            if (!hit.found() || kind_of(hit) != SolidKind::sheet) continue;
            const Surface<Real> surface = surface_at<Real, Effects<all_effects>>(view, ray, hit);
            if (!(view.materials[surface.material].reflection > Real(0))) continue;
            Ray<Real, MediaList> mirrored;
            spawn(mirrored, surface.viewer_side, reflected(ray.direction, surface.normal), hit, ray.media);
            const Hit<Real> seen = intersector.closest(mirrored);
            ++counts.mirrors;
            bool is_held = false;
            for (const uint32_t solid : scene->convex) is_held |= holds(cover, solid, x, y);
            counts.held += is_held;
            if (!seen.found() || kind_of(seen) != SolidKind::convex) continue;
            ++counts.solids;
            missing += !holds(cover, key_solid(seen.key), x, y);
        }
    EXPECT_EQ(missing, 0u);
}

template <class Real>
class MirroredCover : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(MirroredCover, Reals);

TYPED_TEST(MirroredCover, HoldsWhatASheetShowsOfSolids) {
    test::Random random(23);
    Counts counts;
    for (const char* name : {"benchmark", "platonic", "seed"}) {
        SCOPED_TRACE(name);
        const SceneDescription description = described(name);
        expect_held<TypeParam>(description, camera_at(description.camera, 0), counts);
        for (int i = 0; i < 12; ++i)
            expect_held<TypeParam>(description, camera_at(test::random_camera(random, description.camera), 0), counts);
    }
    EXPECT_GT(counts.solids, 1000u);
}

TYPED_TEST(MirroredCover, HoldsLittleElse) {
    const SceneDescription description = described("benchmark");
    Counts counts;
    expect_held<TypeParam>(description, camera_at(description.camera, 0), counts);
    EXPECT_GT(counts.solids, counts.mirrors / 10);
    EXPECT_LT(counts.held, 2 * counts.solids);
    EXPECT_LT(counts.held, counts.mirrors);
}

TYPED_TEST(MirroredCover, IsEmptyWhereNoSheetMirrors) {
    EXPECT_EQ(cover_of<TypeParam>(described("benchmark")).outlines().size(), 3u);
    EXPECT_TRUE(cover_of<TypeParam>(*without_effect(described("benchmark"), effect_reflection)).outlines().empty());
    EXPECT_TRUE(cover_of<TypeParam>(described("mesh")).outlines().empty());  // too large a scene
}

/// The dodecahedron, solid 1, stands clear above the floor: from below, the floor shows what reaches through it alone.
TYPED_TEST(MirroredCover, ShowsNothingThatIsBehindTheMirror) {
    SceneDescription description = described("benchmark");
    description.camera = CameraDescription();
    description.camera.position = {0, 0, -6};
    description.camera.target = {0.5, 0, 0};
    const FrameCover cover = cover_of<TypeParam>(description);
    EXPECT_FALSE(cover.outlines().empty());
    for (const FrameCover::Outline& outline : cover.outlines()) EXPECT_NE(outline.hull, 1u);
}

}  // namespace
