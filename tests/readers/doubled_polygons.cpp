// Polygons of a mesh file that are there several times are read once, before they are cut into triangles.
#include <algorithm>

#include <gtest/gtest.h>

#include "scene/compile/compiled_scene.h"
#include "scene/readers/meshes/mesh_file.h"
#include "scene/readers/meshes/polygon.h"
#include "testing/support/read_text.h"
#include "testing/support/scene_samples.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using test::read_whole_mesh;

using Polygons = std::vector<std::vector<uint32_t>>;

std::vector<bool> doubled(const std::vector<glm::dvec3>& vertices, const Polygons& polygons) {
    PolygonMesh mesh;
    for (const std::vector<uint32_t>& polygon : polygons) {
        mesh.corners.insert(mesh.corners.end(), polygon.begin(), polygon.end());
        mesh.ends.push_back(mesh.corners.size());
    }
    return doubled_polygons(vertices, mesh);
}

const std::vector<glm::dvec3> corners = {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}, {2, -0.0, 0}};

TEST(DoubledPolygons, RotationDirectionAndVertexNumbersDoNotMatter) {
    for (size_t turn = 0; turn < 5; ++turn) {
        std::vector<uint32_t> copy = {0, 5, 2, 3, 4};
        std::rotate(copy.begin(), copy.begin() + static_cast<ptrdiff_t>(turn), copy.end());
        const std::vector<uint32_t> back(copy.rbegin(), copy.rend());
        EXPECT_EQ(doubled(corners, {{0, 1, 2, 3, 4}, copy, back}), (std::vector<bool>{false, true, true}));
        EXPECT_EQ(doubled(corners, {{0, 1, 3, 4}, back, copy}), (std::vector<bool>{false, false, true}));
    }
}

TEST(DoubledPolygons, AnotherOrderIsAnotherPolygon) {
    EXPECT_EQ(doubled(corners, {{0, 1, 3, 4}, {0, 3, 1, 4}, {0, 1, 4, 3}, {1, 0, 3, 4}}),
              (std::vector<bool>{false, false, false, true}))
        << "the last one is the third, backward from its second corner";
    EXPECT_EQ(doubled(corners, {{0, 1, 2, 3}, {0, 1, 2, 3, 4}, {0, 1, 2, 4}}), std::vector<bool>(3, false));
}

TEST(DoubledPolygons, CornersMayRepeat) {
    // A square with a slit to a triangle's corner: one vertex comes twice.
    EXPECT_EQ(doubled(corners, {{0, 1, 2, 0, 3, 4}, {4, 3, 0, 2, 1, 0}, {0, 3, 4, 0, 1, 2}, {0, 2, 1, 0, 3, 4}}),
              (std::vector<bool>{false, true, true, false}));
}

TEST(DoubledPolygons, TrianglesAndWhatIsNotFiniteAreLeftToFindTopology) {
    const std::vector<glm::dvec3> broken = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, NAN, 0}};
    EXPECT_EQ(doubled(broken, {{0, 1, 2}, {0, 1, 2}, {0, 1, 2, 3}, {0, 1, 2, 3}}), std::vector<bool>(4, false));
}

/// A box of quads; the copies come all at the end and begin at other corners, so that they would be cut along other
/// diagonals.
std::string box_obj(bool front_twice, bool back) {
    std::string obj =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    if (front_twice) obj += "f 4 3 2 1\nf 6 7 8 5\nf 2 6 5 1\nf 3 7 6 2\nf 4 8 7 3\nf 1 5 8 4\n";
    if (back) obj += "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n";
    return obj;
}

TEST(DoubledPolygons, ATwoSidedBoxIsABoxAgain) {
    const ScratchDirectory scratch;
    SceneDescription scene = samples::empty_scene();
    scene.materials[0].index = 1.5;
    MeshObject object;
    object.file = scratch.file("box.obj");
    samples::add_object(scene, object);
    put_bytes(object.file, box_obj(false, false));
    const auto once = read_whole_mesh(object);
    EXPECT_EQ(once[0].mesh.doubled_polygons, 0u);
    for (const bool front : {false, true})
        for (const bool back : {false, true}) {
            put_bytes(object.file, box_obj(front, back));
            const auto parts = read_whole_mesh(object);
            const uint32_t copies = 6u * front + 6u * back;
            ASSERT_EQ(parts.size(), 1u);
            EXPECT_EQ(parts[0].mesh.doubled_polygons, copies);
            EXPECT_EQ(parts[0].mesh.owned_triangles, once[0].mesh.owned_triangles);
            const auto compiled = compile_scene<float>(scene);
            EXPECT_NE(compiled->solids[0].kind, SolidKind::sheet);
            if (copies == 0) {
                EXPECT_TRUE(compiled->warnings.empty());
            } else {
                EXPECT_EQ(compiled->warnings,
                          std::vector<std::string>{"/objects/0: object 0: merged " + std::to_string(copies) +
                                                   " faces with the corners of an earlier one"});
            }
        }
}

TEST(DoubledPolygons, PartsThatOneMaterialJoinsAddTheirs) {
    const ScratchDirectory scratch;
    std::string obj = box_obj(true, false);  // its copy of the first face moves to the part of that face
    obj.erase(obj.find("f 4 3 2 1\n"), 10);
    obj.insert(obj.find("f 5 6 7 8"), "f 4 3 2 1\ng other\n");
    SceneDescription scene = samples::empty_scene();
    MeshObject object;
    object.file = scratch.file("box.obj");
    put_bytes(object.file, obj);
    samples::add_object(scene, object);
    ASSERT_EQ(read_whole_mesh(object).size(), 2u);
    const auto compiled = compile_scene<float>(scene);
    ASSERT_EQ(compiled->solids.size(), 1u);
    EXPECT_NE(compiled->solids[0].kind, SolidKind::sheet);
    EXPECT_EQ(compiled->warnings,
              std::vector<std::string>{"/objects/0: object 0: merged 6 faces with the corners of an earlier one"});
}

}  // namespace
}  // namespace cistula
