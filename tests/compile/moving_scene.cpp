// Scenes that change from frame to frame: what their frames have in common, and that each is compiled as it is.
#include <gtest/gtest.h>

#include "base/error.h"
#include "render/scene.h"
#include "scene/compile/solids/placed_bodies.h"
#include "testing/support/read_text.h"
#include "testing/support/scene_dump.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using test::json_scene;

/// Objects with these keys, and a cube that stands still.
SceneDescription scene_of(const std::string& objects) {
    return json_scene(R"({"film": {"frames": 9}, "materials": {"m": {}}, "objects": [
        {"solid": "cube", "material": "m"}, )" +
                      objects + "]}");
}

const SceneNormalization& frame_of(const SceneSource& source) {
    return source.bodies->normalization;
}

TEST(MovingScene, HasOneFrameOfReferenceForAllFrames) {
    const std::string mesh = (source_root() / "scenes/knot.ply").string();
    for (const std::string& moving :
         {std::string(R"({"solid": "octahedron", "material": "m",
                 "center": {"keys": [[2, [0, 0, 0]], [4, [40, 0, 0]], [8, [0, 1, 0]]], "interpolation": "smooth"}})"),
          std::string(R"({"quad": [[0, 0, 0], [1, 0, 0], [1, 1, 0], {"keys": [[1, [0, 1, 0]], [5, [-20, 21, 0]],
                 [6, [0, 1, 0]]]}], "material": "m"})"),
          R"({"mesh": ")" + mesh + R"(", "material": "m", "scale": {"keys": [[0, 1], [4, 9], [8, 1]]},
                 "rotate": {"keys": [[0, [0, 0, 0]], [8, [360, 20, 0]]]}, "center": [5, 1, 0]})"}) {
        const SceneDescription scene = scene_of(moving);
        const SceneNormalization first = frame_of(gather_scene(scene));
        for (int frame = 0; frame < 10; ++frame) {
            const SceneNormalization own = frame_of(gather_scene(at_frame(scene, frame)));
            EXPECT_EQ(own.center, first.center) << moving << frame;
            EXPECT_EQ(own.scale, first.scale);
            EXPECT_EQ(own.extent, first.extent);
            SceneDescription alone = at_frame(scene, frame);
            alone.motion = nullptr;
            const SceneSource source = gather_scene(alone);
            Box all = world_box(source);
            for (const glm::dvec3& corner : all.corners())
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_LE(std::abs(first.point(corner)[axis]), first.extent) << moving << frame;
        }
    }
}

TEST(MovingScene, FramesAreCompiledAsTheyAre) {
    const Scene scene(scene_of(R"({"solid": "octahedron", "material": "m", "center": [3, 0, 0],
        "rotate": {"keys": [[0, [0, 0, 0]], [8, [0, 0, 360]]]}})"));
    EXPECT_TRUE(scene.moves());
    EXPECT_FALSE(scene.at(3).moves());
    EXPECT_EQ(scene.at(3).shown(), 3);
    const FrameHashes hashes = scene.hashes();
    EXPECT_EQ(hashes.of(0), hashes.of(8)) << "a turn is none, bit by bit";
    EXPECT_EQ(hashes.of(8), hashes.of(9));
    EXPECT_NE(hashes.of(0), hashes.of(3));
    EXPECT_EQ(hashes.of(3), scene.at(3).hashes().of(3));
    const auto slabs = [&](int frame) {
        std::vector<float> numbers;
        scene.at(frame).visit([&](const auto& compiled) {
            for (const auto& slab : compiled->slabs)
                for (int axis = 0; axis < 3; ++axis) numbers.push_back(static_cast<float>(slab.normal[axis]));
        });
        return numbers;
    };
    EXPECT_EQ(slabs(0), slabs(8));
    EXPECT_NE(slabs(0), slabs(1));
}

TEST(MovingScene, PrecisionIsThatOfTheSmallestPartAtKeys) {
    const SceneDescription scene = scene_of(R"({"solid": "octahedron", "material": "m", "center": [3, 0, 0],
        "radius": {"keys": [[0, 1], [4, 1e-6], [8, 1]]}})");
    for (const int frame : {0, 3, 8}) {
        const SceneSource source = gather_scene(at_frame(scene, frame));
        const SmallestPart part = smallest_part(source);
        EXPECT_LT(part.share, 1e-6);
        EXPECT_EQ(part.what, "/objects/1: its inradius at frame 4");
    }
    EXPECT_EQ(Scene(scene).precision(), Precision::double_);
    EXPECT_EQ(Scene(scene).at(0).precision(), Precision::double_);
    EXPECT_EQ(Scene(scene, Precision::single_).at(0).precision(), Precision::single_);
}

TEST(MovingScene, FilesAreReadOnce) {
    const ScratchDirectory scratch;
    const std::string path = scratch.file("a.ply");
    put_bytes(path, bytes_of((source_root() / "scenes/knot.ply").string()));
    const Scene scene(scene_of(R"({"mesh": ")" + path + R"(", "material": "m", "rotate": {"keys": [[0, [0, 0, 0]],
        [8, [0, 0, 90]]]}})"));
    std::filesystem::remove(path);
    EXPECT_NO_THROW(scene.at(5));
}

TEST(MovingScene, FaultsNameTheirFrame) {
    const SceneDescription scene = scene_of(R"({"quad": [[0, 0, 0], [1, 0, 0], [1, 1, 0],
        [0, 1, {"keys": [[0, 0], [8, 1]]}]], "material": "m"})");
    try {
        gather_scene(scene);
        FAIL() << "a corner leaves the plane";
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("frame 1: a.json: /objects/1/quad: ")) << error.what();
    }
}

}  // namespace
}  // namespace cistula
