// Meshes and textures are read once, and are the same whether they come from files or from arrays.
#include "scene/assets/assets.h"

#include <cstring>

#include <gtest/gtest.h>

#include "image/reader/picture_reader.h"
#include "scene/compile/compiled_scene.h"
#include "testing/support/scene_samples.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using samples::expect_error;

/// A pyramid without one side, as a PLY and as arrays.
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n"
    "property float t\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 0 0\n2 0 0 1 0\n2 2 0 1 1\n0 2 0 0 1\n1 1 3 0.5 0.25\n4 0 1 2 3\n3 0 1 4\n3 1 2 4\n3 2 3 4\n";

MeshData arrays() {
    PolygonMesh mesh;
    mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 3}};
    mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {0.5, 0.75}};  // from the top
    mesh.corners = {0, 1, 2, 3, 0, 1, 4, 1, 2, 4, 2, 3, 4};
    mesh.ends = {4, 7, 10, 13};
    return {{mesh}, {}, {}};
}

const std::vector<uint8_t> texels = {255, 0,   0,   255, 10, 200, 30, 255, 0, 0, 7, 255,
                                     128, 128, 128, 0,   1,  2,   3,  4,   5, 6, 7, 8};

TexelArray texel_array() {
    return {3, 2, 4, texels};
}

template <class T>
std::shared_ptr<const T> shared(T value) {
    return std::make_shared<const T>(std::move(value));
}

/// Two bodies of one mesh, with a texture on the second.
SceneDescription scene_of(const MeshObject& mesh, const TextureDescription& texture) {
    SceneDescription scene = samples::empty_scene();
    scene.textures = {texture};
    scene.materials.push_back(samples::material("painted"));
    scene.materials[1].texture = 0;
    for (int i = 0; i < 2; ++i) {
        MeshObject placed = mesh;
        placed.center.x = 5 * i;
        placed.scale = 1.5;
        placed.rotation = {10, 20, 30};
        samples::add_object(scene, placed, i);
    }
    samples::add_light(scene, {3, 0, 9});
    return scene;
}

class Assets : public testing::Test {
  protected:
    Assets() {
        put_bytes(scratch_.file("a.ply"), ply);
        const std::string head("\3\0\0\0\2\0\0\0", 8);
        put_bytes(scratch_.file("a.data"), head + std::string(texels.begin(), texels.end()));
        mesh_file.file = scratch_.file("a.ply");
        texture_file.file = scratch_.file("a.data");
        mesh_arrays.data = shared(arrays());
        texture_array.texels = shared(texel_array());
    }

    MeshObject mesh_file, mesh_arrays;
    TextureDescription texture_file, texture_array;

  private:
    ScratchDirectory scratch_;
};

TEST_F(Assets, ArraysGiveTheBitsOfFiles) {
    const auto from_files = compile_scene<double>(scene_of(mesh_file, texture_file));
    const auto from_arrays = compile_scene<double>(scene_of(mesh_arrays, texture_array));
    EXPECT_EQ(from_arrays->hashes.of(0), from_files->hashes.of(0));
    EXPECT_EQ(from_arrays->texels, from_files->texels);
    EXPECT_EQ(from_files->texels.size(), 6u);
    EXPECT_EQ(from_arrays->uvs, from_files->uvs);
    EXPECT_FALSE(from_files->uvs.empty());
    ASSERT_EQ(from_arrays->clusters.size(), from_files->clusters.size());
    for (size_t i = 0; i < from_files->clusters.size(); ++i)
        EXPECT_EQ(std::memcmp(&from_arrays->clusters[i], &from_files->clusters[i], sizeof from_files->clusters[i]), 0);
    EXPECT_EQ(from_arrays->warnings, from_files->warnings);
}

TEST_F(Assets, AFileIsReadOnceHoweverManyNameIt) {
    SceneDescription scene = scene_of(mesh_file, texture_file);
    scene.textures.push_back(texture_file);
    scene.textures[1].repeat = {2, 3};
    scene.materials[0].texture = 1;
    const SceneAssets assets = load_assets(scene);
    ASSERT_EQ(assets.meshes.size(), 2u);
    EXPECT_NE(assets.meshes[0], nullptr);
    EXPECT_EQ(assets.meshes[0], assets.meshes[1]);
    EXPECT_EQ(assets.pictures.at(0), assets.pictures.at(1));
    EXPECT_EQ(assets.files, (std::vector<std::string>{texture_file.file, texture_file.file, mesh_file.file}));
    const auto compiled = compile_scene<float>(scene);
    EXPECT_EQ(compiled->textures.size(), 2u);
    EXPECT_EQ(compiled->texels.size(), 6u) << "both textures have the same texels";
    scene.textures[1].texels = texture_array.texels;
    EXPECT_EQ(compile_scene<float>(scene)->hashes.of(0), compiled->hashes.of(0));
}

/// The texture coordinates of a square's triangles, moved by `away` before they are compiled.
std::vector<Vec2<double>> compiled_uvs(const TextureDescription& texture, const glm::dvec2& away, std::string& hash) {
    SceneDescription scene = samples::empty_scene();
    TrianglesObject square = samples::square();
    for (glm::dvec2& uv : square.uvs) uv = 0.75 * uv + glm::dvec2(0.125) + away;
    samples::add_object(scene, std::move(square));
    scene.textures = {texture};
    scene.materials[0].texture = 0;
    const auto compiled = compile_scene<double>(scene);
    hash = compiled->hashes.of(0);
    return compiled->uvs;
}

TEST_F(Assets, TextureCoordinatesFarFromZeroLoseWholeRepeats) {
    TextureDescription texture;
    texture.repeat = {3, 0.5};
    std::string hash, other;
    const std::vector<Vec2<double>> near = compiled_uvs(texture, {0, 0}, hash);
    EXPECT_EQ(near[0].x, 0.125) << "what is near stays what it is";
    for (const auto& [wrap, away] : {std::pair(TextureWrap::repeat, glm::dvec2(10000, -20000)),
                                     std::pair(TextureWrap::repeat, glm::dvec2(-1.0 / 3, 2)),
                                     std::pair(TextureWrap::mirror, glm::dvec2(-2.0 / 3, 4)),
                                     std::pair(TextureWrap::mirror, glm::dvec2(10000, 900000))}) {
        texture.wrap = {wrap, wrap};
        const std::vector<Vec2<double>> far = compiled_uvs(texture, away, other);
        ASSERT_EQ(far.size(), near.size());
        for (size_t i = 0; i < far.size(); ++i) {
            EXPECT_NEAR(far[i].x, near[i].x, 1e-9);
            EXPECT_NEAR(far[i].y, near[i].y, 1e-9);
        }
        EXPECT_NE(other, hash);
    }
    const std::vector<Vec2<double>> odd = compiled_uvs(texture, {1 + 1000, 2 - 1000}, other);
    EXPECT_NEAR(odd[0].x, 0.125 + 1.0 / 3, 1e-9) << "3003 repeats are odd, mirrored ones alternate";
    EXPECT_NEAR(odd[0].y, 2.125, 1e-9) << "as are -499";
    texture.wrap = {TextureWrap::clamp, TextureWrap::repeat};
    EXPECT_EQ(compiled_uvs(texture, {100, 0}, other)[0].x, 100.125) << "beyond its edges a clamped picture goes on";
    texture.wrap = {};
    texture.repeat = {1e6, 1};
    for (const Vec2<double>& uv : compiled_uvs(texture, {1e300, 5}, other)) EXPECT_EQ(uv.x, 1e300);
}

TEST_F(Assets, APlaneWithATextureHasNoCoordinatesToLose) {
    SceneDescription scene = samples::empty_scene();
    samples::add_object(scene, DiskObject::plane({0, 0, 1}, 0));
    scene.textures = {{}};
    scene.materials[0].texture = 0;
    EXPECT_TRUE(compile_scene<float>(scene)->uvs.empty());
}

TEST_F(Assets, ASkyIsTwiceAsWideAsHigh) {
    SceneDescription scene = samples::empty_scene();
    samples::add_object(scene, samples::square());
    scene.sky.emplace().texture = 0;
    for (const uint32_t width : {1u, 2u, 3u, 4u, 5u, 8u}) {
        scene.textures = {{}};
        scene.textures[0].texels = shared(TexelArray{width, 2, 1, std::vector<float>(2 * width, 1)});
        if (width == 4)
            EXPECT_EQ(compile_scene<float>(scene)->textures.size(), 1u);
        else
            expect_error([&] { compile_scene<float>(scene); }, ExitCode::file,
                         "test.json: /background: the texels: the sky is " + std::to_string(width) +
                             "x2; give a picture of all directions, twice as wide as high");
    }
}

TEST_F(Assets, WrongArraysNameThePlace) {
    const auto mesh_refused = [&](const auto& change, const std::string& text) {
        MeshData data = arrays();
        change(data.groups[0]);
        MeshObject mesh;
        mesh.data = shared(std::move(data));
        expect_error([&] { compile_scene<float>(scene_of(mesh, texture_file)); }, ExitCode::usage,
                     "test.json: /objects/0: " + text);
    };
    mesh_refused([](PolygonMesh& m) { m.corners[5] = 5; }, "a triangle names vertex 5, but there are only 5");
    mesh_refused([](PolygonMesh& m) { m.uvs.pop_back(); }, "there are 4 uvs for 5 vertices");
    mesh_refused([](PolygonMesh& m) { m.uvs[3].y = NAN; }, "a uv is not finite");
    mesh_refused([](PolygonMesh& m) { m.ends.back() = 12; }, "the mesh has corners beyond its last polygon");
    mesh_refused([](PolygonMesh& m) { m.ends[0] = 99; }, "the mesh has polygons that end before they begin");
    mesh_refused([](PolygonMesh& m) { m.ends.clear(); }, "the mesh has corners beyond its last polygon");
    mesh_refused([](PolygonMesh& m) { m.corners = {}, m.ends = {}; }, "there are no triangles; give at least one");

    const auto texture_refused = [&](TexelArray array, const std::string& text) {
        TextureDescription texture;
        texture.strict = true;
        texture.place = "/textures/a";
        texture.texels = shared(std::move(array));
        expect_error([&] { compile_scene<float>(scene_of(mesh_file, texture)); }, ExitCode::usage,
                     "test.json: /textures/a: the texels: " + text);
    };
    texture_refused({0, 2, 4, texels}, "its size is 0x2; width and height of a texture are 1 to 65536");
    texture_refused({3, 2, 3, texels}, "there are 24 numbers for 3x2 texels of 3 channels; give one for each");
    texture_refused({1, 2, 1, std::vector<float>{0, -1}}, "texel (0, 1) has R = -1, and so 3 of 6 values");
}

TEST_F(Assets, FloatsOfAnArrayAreLinearAndClamped) {
    TextureDescription texture;
    texture.texels = shared(TexelArray{2, 1, 1, std::vector<float>{0.25f, -1}});
    const auto compiled = compile_scene<float>(scene_of(mesh_arrays, texture));
    EXPECT_EQ(compiled->texels, (std::vector<Vec3<float>>{Vec3<float>(0.25f), Vec3<float>(0)}));
    ASSERT_EQ(compiled->warnings.size(), 1u);
    EXPECT_EQ(compiled->warnings[0].substr(0, 68),
              "test.json: /textures/0: values of its texels that are no radiance: 3");
}

}  // namespace
}  // namespace cistula
