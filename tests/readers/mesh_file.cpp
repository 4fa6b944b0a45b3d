#include "scene/readers/meshes/mesh_file.h"

#include <numeric>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cistula/model/effects.h"
#include "scene/compile/compiled_scene.h"
#include "scene/compile/meshes/mesh_pieces.h"
#include "scene/readers/meshes/polygon.h"
#include "testing/support/read_text.h"
#include "testing/support/scene_samples.h"
#include "testing/support/scratch_directory.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

using glm::dvec3;
using samples::expect_error;
using test::read_whole_mesh;

/// An OBJ of a cube from 0 to 1 by quads, its faces in two groups of three.
const std::string cube_obj =
    "mtllib cube.mtl\n"
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "usemtl red\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\n"
    "usemtl glass\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

const std::string cube_mtl =
    "newmtl red\nKd 0.5 0.25 0.125\nKs 0.25 0.5 0\nNs 40\nillum 2\n"
    "newmtl glass\nKd 0.75 1 0.5\nKs 0.25 0.25 0.25\nNs 100\nNi 1.5\nd 0.25\nillum 7\n";

const std::string tetrahedron_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n2 0 0\n0 2 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

MeshObject mesh_of(const std::string& file) {
    MeshObject object;
    object.file = file;
    return object;
}

TEST(MeshFile, PlyTrianglesArePlaced) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("t.ply"), tetrahedron_ply);
    MeshObject object = mesh_of(scratch.file("t.ply"));
    object.scale = 2;
    object.rotation = {0, 0, 90};
    object.center = {10, 20, 30};
    const auto parts = read_whole_mesh(object);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_FALSE(parts[0].material);
    EXPECT_EQ(parts[0].mesh.vertices.size(), 4u);
    EXPECT_EQ(parts[0].mesh.triangles.size(), 4u);
    EXPECT_TRUE(parts[0].mesh.uvs.empty());
    bool found = false;
    for (const dvec3& p : parts[0].mesh.vertices) found |= p == dvec3(10, 24, 30);  // (2, 0, 0)
    EXPECT_TRUE(found);
    EXPECT_TRUE(find_pieces(parts[0].mesh).closed);
}

TEST(MeshFile, BinaryPlyToo) {
    const ScratchDirectory scratch;
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const float positions[9] = {0, 0, 0, 1.5f, 0, 0, 0, 2.5f, 0};
    const int32_t indices[3] = {0, 1, 2};
    bytes.append(reinterpret_cast<const char*>(positions), sizeof(positions));
    bytes.push_back(3);
    bytes.append(reinterpret_cast<const char*>(indices), sizeof(indices));
    put_bytes(scratch.file("t.ply"), bytes);
    const auto parts = read_whole_mesh(mesh_of(scratch.file("t.ply")));
    ASSERT_EQ(parts.size(), 1u);
    ASSERT_EQ(parts[0].mesh.triangles.size(), 1u);
    EXPECT_EQ(parts[0].mesh.vertices[parts[0].mesh.triangles[0][1]], dvec3(1.5, 0, 0));
}

/// However small a mesh is, only vertices at one position are one.
TEST(MeshFile, VerticesThatAreNearStayApart) {
    const ScratchDirectory scratch;
    const TrianglesObject ring = torus(2e-6, 0.9e-6, 48, 24);
    std::string ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(ring.vertices.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(ring.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    std::string obj;
    for (const dvec3& p : ring.vertices) {
        const std::string line = fmt::format("{:.9e} {:.9e} {:.9e}\n", p.x, p.y, p.z);
        ply += line;
        obj += "v " + line;
    }
    for (const auto& t : ring.triangles) {
        ply += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
        obj += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    put_bytes(scratch.file("t.ply"), ply);
    put_bytes(scratch.file("t.obj"), obj);
    for (const char* name : {"t.ply", "t.obj"}) {
        const auto parts = read_whole_mesh(mesh_of(scratch.file(name)));
        ASSERT_EQ(parts.size(), 1u);
        const MeshPieces pieces = find_pieces(parts[0].mesh);
        EXPECT_TRUE(pieces.closed) << name;
        EXPECT_EQ(pieces.source.size(), ring.triangles.size()) << name;
    }
}

TEST(MeshFile, ObjGroupsBringTheirMaterials) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("cube.obj"), cube_obj);
    put_bytes(scratch.file("cube.mtl"), cube_mtl);
    const auto parts = read_whole_mesh(mesh_of(scratch.file("cube.obj")));
    ASSERT_EQ(parts.size(), 2u);
    for (const auto& part : parts) EXPECT_EQ(part.mesh.triangles.size(), 6u);
    const auto& red = parts[0].material->name == "red" ? *parts[0].material : *parts[1].material;
    const auto& glass = parts[0].material->name == "red" ? *parts[1].material : *parts[0].material;
    EXPECT_EQ(red.name, "red");
    EXPECT_EQ(red.color, dvec3(0.5, 0.25, 0.125));
    EXPECT_EQ(red.specular, 0.5);
    EXPECT_EQ(red.specular_color, dvec3(0.5, 1, 0));
    EXPECT_EQ(red.exponent, 40);
    EXPECT_EQ(red.transmission, 0);
    EXPECT_EQ(red.reflection, 0);
    EXPECT_EQ(red.index, 1);
    EXPECT_FALSE(red.fresnel);
    EXPECT_EQ(glass.name, "glass");
    EXPECT_EQ(glass.transmission, 0.75);
    EXPECT_EQ(glass.reflection, 0.25);
    EXPECT_EQ(glass.tint, dvec3(0.75, 1, 0.5));
    EXPECT_EQ(glass.index, 1.5);
    EXPECT_EQ(glass.exponent, 100);
    EXPECT_TRUE(glass.fresnel);
}

TEST(MeshFile, WhatIsNoMeshIsToldByItsStart) {
    const ScratchDirectory scratch;
    const auto refused = [&](const std::string& name, const std::string& text) {
        expect_error([&] { read_whole_mesh(mesh_of(scratch.file(name))); }, ExitCode::file,
                     "mesh " + scratch.file(text));
    };
    for (const char* name : {"zeros.obj", "zeros.ply", "zeros.mtl"}) {
        put_bytes(scratch.file(name), "");
        std::filesystem::resize_file(scratch.file(name), uint64_t{1} << 42);  // more than memory
    }
    const std::string no_text = ": is no text, as OBJ and MTL files are: a zero byte is among its first";
    refused("zeros.ply", "zeros.ply:1: is not PLY: its first line must be \"ply\"");
    refused("zeros.obj", "zeros.obj" + no_text);
    put_bytes(scratch.file("a.obj"), "mtllib zeros.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    refused("a.obj", "zeros.mtl" + no_text);
}

TEST(MeshFile, TrIsTransmission) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("cube.obj"), cube_obj);
    put_bytes(scratch.file("cube.mtl"), "newmtl red\nTr 0.25\nillum 1\nKs 1 1 1\nnewmtl glass\nKd 1 1 1\nillum 0\n");
    for (const auto& part : read_whole_mesh(mesh_of(scratch.file("cube.obj")))) {
        const bool red = part.material->name == "red";
        EXPECT_EQ(part.material->transmission, red ? 0.25 : 0);
        EXPECT_EQ(part.material->specular, 0);
        EXPECT_EQ(part.material->diffuse, red ? 1 : 0);
    }
}

double area(const std::vector<dvec3>& vertices, const std::vector<std::array<uint32_t, 3>>& triangles) {
    double sum = 0;
    for (const auto& t : triangles) {
        const dvec3 normal = cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]);
        EXPECT_GE(normal.z, 0);
        sum += normal.z / 2;
    }
    return sum;
}

TEST(Polygon, ConvexOnesBecomeAFan) {
    const std::vector<dvec3> vertices = {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}};
    std::vector<std::array<uint32_t, 3>> triangles;
    append_polygon(vertices, std::vector<uint32_t>{0, 1, 2, 3, 4}, triangles);
    const std::vector<std::array<uint32_t, 3>> fan = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    EXPECT_EQ(triangles, fan);
}

TEST(Polygon, EarsOfAnyPolygonFillItsArea) {
    // A comb, and a spiral of right angles; their areas by the shoelace formula.
    const std::vector<dvec3> comb = {{0, 0, 0}, {7, 0, 0}, {7, 3, 0}, {6, 3, 0}, {6, 1, 0}, {4, 1, 0},
                                     {4, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
    const std::vector<dvec3> spiral = {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {1, 5, 0}, {1, 2, 0}, {3, 2, 0},
                                       {3, 3, 0}, {2, 3, 0}, {2, 4, 0}, {4, 4, 0}, {4, 1, 0}, {0, 1, 0}};
    for (const auto& outline : {comb, spiral}) {
        double shoelace = 0;
        for (size_t i = 0; i < outline.size(); ++i) {
            const dvec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
            shoelace += (a.x * b.y - a.y * b.x) / 2;
        }
        for (uint32_t turn = 0; turn < outline.size(); ++turn) {
            std::vector<uint32_t> corners;
            for (uint32_t i = 0; i < outline.size(); ++i) corners.push_back((i + turn) % outline.size());
            std::vector<std::array<uint32_t, 3>> triangles;
            append_polygon(outline, corners, triangles);
            EXPECT_EQ(triangles.size(), outline.size() - 2);
            EXPECT_NEAR(area(outline, triangles), shoelace, 1e-12);
        }
    }
}

TEST(Polygon, OthersEndToo) {
    const std::vector<dvec3> bow = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
    std::vector<std::array<uint32_t, 3>> triangles;
    append_polygon(bow, std::vector<uint32_t>{0, 1, 2, 3, 4}, triangles);
    EXPECT_EQ(triangles.size(), 3u);
    append_polygon(bow, std::vector<uint32_t>{0, 1}, triangles);
    EXPECT_EQ(triangles.size(), 3u);
}

/// Outlines of about `count` corners: a circle, a star of needles, a comb, and a line that crosses itself everywhere.
std::vector<std::vector<dvec3>> large_outlines(uint32_t count) {
    std::vector<std::vector<dvec3>> outlines(4);
    outlines[2] = {{0, 0, 0}, {count + 1.0, 0, 0}};
    uint64_t random = 1;
    const auto draw = [&random] {
        return double((random = random * 6364136223846793005 + 1442695040888963407) >> 11) * 0x1p-53;
    };
    for (uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * i / count, radius = 0.2 + draw();
        const dvec3 direction{std::cos(angle), std::sin(angle), 0};
        outlines[0].push_back(direction);
        outlines[1].push_back(radius * direction);
        outlines[2].push_back({count - i + 0.5, i % 2 ? 1.0 : 1000.0, 0});
        outlines[3].push_back({draw(), draw(), 0});
    }
    return outlines;
}

TEST(Polygon, LargeOnesKeepTheirArea) {
    for (const uint32_t count : {65u, 1000u, 20000u}) {
        const auto outlines = large_outlines(count);
        for (size_t shape = 0; shape < outlines.size(); ++shape) {
            std::vector<uint32_t> corners(outlines[shape].size());
            std::iota(corners.begin(), corners.end(), 0);
            std::vector<std::array<uint32_t, 3>> triangles;
            append_polygon(outlines[shape], corners, triangles);
            ASSERT_EQ(triangles.size(), corners.size() - 2);
            // Each edge of the outline is one of a triangle, and all others are of two: what was closed stays closed.
            std::set<std::pair<uint32_t, uint32_t>> edges;
            for (const auto& t : triangles)
                for (int k = 0; k < 3; ++k)
                    if (!edges.erase({t[(k + 1) % 3], t[k]})) edges.insert({t[k], t[(k + 1) % 3]});
            EXPECT_EQ(edges.size(), corners.size());
            if (shape == 3) continue;
            double shoelace = 0;
            for (size_t i = 0; i < corners.size(); ++i) {
                const dvec3 &a = outlines[shape][i], &b = outlines[shape][(i + 1) % corners.size()];
                shoelace += (a.x * b.y - a.y * b.x) / 2;
            }
            // n triangles, each with a rounding of a few ulps of the box.
            EXPECT_NEAR(area(outlines[shape], triangles), shoelace, 1e-12 * count * shoelace);
        }
    }
}

SceneDescription scene_with(const std::string& file, int material) {
    SceneDescription scene = samples::empty_scene();
    samples::add_object(scene, mesh_of(file), material);
    return scene;
}

TEST(MeshFile, GroupsBecomeSolidsOfTheirOwnUnlessAMaterialJoinsThem) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("cube.obj"), cube_obj);
    put_bytes(scratch.file("cube.mtl"), cube_mtl);
    const auto own = compile_scene<float>(scene_with(scratch.file("cube.obj"), -1));
    ASSERT_EQ(own->solids.size(), 2u);
    EXPECT_EQ(own->solids[0].kind, SolidKind::sheet);
    EXPECT_NE(own->solids[0].material, own->solids[1].material);
    EXPECT_EQ(own->materials.size(), 3u);
    EXPECT_NE(own->solid_names[0], own->solid_names[1]);
    EXPECT_TRUE(own->effects & effect_fresnel);
    const auto joined = compile_scene<float>(scene_with(scratch.file("cube.obj"), 0));
    ASSERT_EQ(joined->solids.size(), 1u);
    EXPECT_EQ(joined->solids[0].kind, SolidKind::convex);
    EXPECT_EQ(joined->solids[0].material, 0u);
    EXPECT_FALSE(joined->effects & effect_fresnel);
}

TEST(MeshFile, TextureCoordinatesCountFromTheTop) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0.25\nvt 0.5 1\nf 1/1 2/2 3/3\n");
    SceneDescription scene = scene_with(scratch.file("t.obj"), 0);
    scene.textures.resize(1);
    scene.materials[0].texture = 0;
    const auto compiled = compile_scene<double>(scene);
    ASSERT_EQ(compiled->uvs.size(), 3u);
    EXPECT_EQ(compiled->uvs[1], Vec2<double>(1, 0.75));
    put_bytes(scratch.file("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_error(
        [&] { compile_scene<double>(scene); }, ExitCode::usage,
        "test.json: /objects/0: the material plain has a texture, but the triangles have no texture coordinates");
}

TEST(MeshFile, ErrorsNameThePlaceAndTheFile) {
    const ScratchDirectory scratch;
    const auto refused = [&](const std::string& name, const std::string& bytes, const std::string& text) {
        if (!bytes.empty()) put_bytes(scratch.file(name), bytes);
        expect_error([&] { compile_scene<float>(scene_with(scratch.file(name), 0)); }, ExitCode::file, text);
        expect_error([&] { compile_scene<float>(scene_with(scratch.file(name), 0)); }, ExitCode::file,
                     "test.json: /objects/0: mesh " + scratch.file(name));
    };
    refused("missing.ply", "", "there is no such file");
    refused("t.stl", "solid", "must be a .ply or an .obj file");
    refused("broken.ply", "ply\nformat ascii 1.0\nnonsense\n",
            "broken.ply:3: 'nonsense' is not PLY; a header has format");
    refused("other.ply", "solid\n", "other.ply:1: is not PLY");
    refused("short.ply", "ply\nformat ascii 1.0\nelement vertex 3\n",
            "short.ply:3: the file ends in its header, before an end_header line");
    refused("cut.ply", tetrahedron_ply.substr(0, tetrahedron_ply.find("end_header") + 15),
            "cut.ply:3: 4 of these take at least 6 bytes each");
    refused("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "has no faces");
    refused("lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n", "has no faces");
    refused(
        "points.ply",
        tetrahedron_ply.substr(0, tetrahedron_ply.find("element face")) + "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n",
        "has no faces");
    put_bytes(scratch.file("t.ply"), tetrahedron_ply);
    expect_error([&] { compile_scene<float>(scene_with(scratch.file("t.ply"), -1)); }, ExitCode::usage,
                 "/objects/0: the mesh brings no material of its own");
}

}  // namespace
}  // namespace cistula
