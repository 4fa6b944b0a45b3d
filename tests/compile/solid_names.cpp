// Names by which mattes tell solids and materials apart: those of the scene file as they are, and never one for two.
#include <fmt/format.h>

#include "scene/compile/scene_source.h"
#include "scene/readers/read_scene.h"
#include "testing/support/expect_error.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

class SolidNames : public testing::Test {
  protected:
    SolidNames() {
        put_bytes(file("m.mtl"), "newmtl left\nnewmtl right\n");
        put_bytes(file("m.obj"),
                  "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 0 0\nusemtl left\nf 1 2 3\nusemtl right\nf 2 4 3\n");
    }
    std::string file(const std::string& name) const { return folder_.file(name); }

    SceneDescription scene(const std::string& objects) const {
        return read_scene_text(R"({"materials": {"left": {}, "/World/red": {}}, "objects": [)" + objects + "]}",
                               "a.json", folder_.file(""));
    }
    std::string names(const std::string& objects) const {
        const SceneDescription description = scene(objects);
        std::string text;
        for (const SourceSolid& solid : gather_scene(description).solids) text += name_of(solid) + ' ';
        return text;
    }
    std::string materials(const std::string& objects) const {
        const SceneDescription description = scene(objects);
        std::string text;
        for (const MaterialDescription& material : gather_scene(description).materials) text += material.name + ' ';
        return text;
    }
    static std::string cube(const std::string& name) {
        return R"({"solid": "cube", "material": "left")" + (name.empty() ? "" : R"(, "name": ")" + name + '"') + "}";
    }
    static std::string mesh(const std::string& name) {
        return R"({"mesh": "m.obj")" + (name.empty() ? "" : R"(, "name": ")" + name + '"') + "}";
    }

    const ScratchDirectory folder_;
};

TEST_F(SolidNames, AreThoseOfTheFile) {
    EXPECT_EQ(names(cube("/World/Cube") + "," + cube("/") + "," + cube("") + "," + cube("a b")),
              "/World/Cube / object2 a b ");
    EXPECT_EQ(names(mesh("m") + "," + mesh("")), "m/left m/right object1/left object1/right ");
}

TEST_F(SolidNames, OfEqualPartsAreNumbered) {
    const auto put = [&](const std::string& faces) {
        put_bytes(file("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 0 0\nv 9 9 0\nv 9 9 9\n" + faces);
    };
    put("usemtl left\nf 1 2 3\nusemtl right\nf 2 4 3\nusemtl left\nf 4 5 3\nusemtl right\nf 3 5 6\nusemtl left\nf 1 2 "
        "6\n");
    EXPECT_EQ(names(mesh("m")), "m/left m/right m/left.2 m/right.2 m/left.3 ");
    EXPECT_EQ(materials(mesh("m")), "left /World/red m/left right m/left right m/left ");
    put("usemtl left\nf 1 2 3\nusemtl left.2\nf 2 4 3\nusemtl left\nf 4 5 3\n");
    EXPECT_EQ(names(mesh("m")), "m/left m/left.2 m/left.3 ") << "another part has that name";
    put("g a\nusemtl left\nf 1 2 3\ng b\nf 2 4 3\ng a\nf 4 5 3\n");
    EXPECT_EQ(names(mesh("m")), "m/a m/b m/a.2 ");
    put("usemtl left\nf 1 3 2\nusemtl right\nf 4 5 6\nusemtl left\nf 1 2 6\nf 2 3 6\nf 3 1 6\n");
    EXPECT_EQ(names(mesh("m")), "m/left m/right ") << "parts that close one another are one";
}

TEST_F(SolidNames, AreOfOneSolidEach) {
    EXPECT_ERROR(
        gather_scene(scene(cube("object1") + "," + cube(""))), ExitCode::usage,
        "a.json: /objects/1: 'object1' is the name of /objects/0 too: an object without a name is called object "
        "and its number, a part of a mesh by the object's name, / and its own; give each another");
    EXPECT_THROW(gather_scene(scene(mesh("m") + "," + cube("m/right"))), Error);
}

/// Fronts and backs in groups of their own: with one material they are faces that are there twice.
TEST_F(SolidNames, FacesOfAnEarlierPartAreLeftOut) {
    put_bytes(file("two.obj"),
              "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\no front\nf 1 2 3 4\no back\nf 4 3 2 1\no more\nf 3 2 1\nf "
              "2 5 3\n");
    const SceneDescription description = scene(R"({"mesh": "two.obj", "name": "m", "material": "left"})");
    const SceneSource source = gather_scene(description);
    ASSERT_EQ(source.solids.size(), 2u);
    EXPECT_EQ(source.solids[0].name, "m/front");
    EXPECT_EQ(source.solids[0].mesh.triangles.size(), 2u);
    EXPECT_EQ(source.solids[0].mesh.doubled_polygons, 2u);
    EXPECT_EQ(source.solids[1].name, "m/more");
    EXPECT_EQ(source.solids[1].mesh.triangles.size(), 1u);
    EXPECT_EQ(source.solids[1].mesh.doubled_polygons, 1u);
}

/// An OBJ group: a cube about the origin.
std::string cube_group(const std::string& name, double half, int first, bool inward) {
    std::string text = "o " + name + '\n';
    for (int i = 0; i < 8; ++i)
        text += fmt::format("v {} {} {}\n", i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
    for (auto q : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        if (inward) std::swap(q[1], q[3]);
        text += fmt::format("f {} {} {} {}\n", q[0] + first, q[1] + first, q[2] + first, q[3] + first);
    }
    return text;
}

/// Whoever names the material, groups that are closed are bodies, and one that is wound inward a hole in another.
TEST_F(SolidNames, ClosedGroupsStayBodies) {
    const std::string header = "mtllib m.mtl\nusemtl left\n";
    for (const std::string material : {"", R"(, "material": "left")"}) {
        const std::string object = R"({"mesh": "g.obj", "name": "m")" + material + "}";
        put_bytes(file("g.obj"), header + cube_group("a", 2, 1, false) + cube_group("b", 1, 9, false));
        EXPECT_EQ(names(object), "m/a m/b ");
        put_bytes(file("g.obj"), header + cube_group("b", 1, 1, true) + cube_group("a", 2, 9, false));
        const SceneDescription description = scene(object);
        const SceneSource source = gather_scene(description);
        ASSERT_EQ(source.solids.size(), 1u);
        EXPECT_EQ(source.solids[0].name, "m");
        EXPECT_NEAR(source.solids[0].thickness, (64 - 8) / (96 + 24.0), 1e-15);
        put_bytes(file("g.obj"), header + cube_group("b", 1, 1, true) + cube_group("a", 2, 9, true));
        EXPECT_EQ(names(object), "m/b m/a ") << "both are turned";
    }
    put_bytes(file("g.obj"), header + cube_group("b", 1, 1, true) + "usemtl right\n" + cube_group("a", 2, 9, false));
    EXPECT_EQ(names(R"({"mesh": "g.obj", "name": "m"})"), "m/b m/a ") << "of other materials";
}

TEST_F(SolidNames, MaterialsOfMeshesAreNotTheScenes) {
    EXPECT_EQ(materials(mesh("m") + "," + mesh("n")), "left /World/red m/left right n/left right ");
    std::filesystem::copy_file(file("m.obj"), file("n.obj"));
    EXPECT_EQ(materials(mesh("m") + R"(, {"mesh": "n.obj", "name": "n"})"),
              "left /World/red m/left right n/left n/right ");
}

}  // namespace
}  // namespace cistula
