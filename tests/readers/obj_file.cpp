#include "scene/readers/meshes/mesh_formats.h"

#include <map>

#include <gtest/gtest.h>

#include "base/shown_text.h"
#include "scene/compile/compiled_scene.h"
#include "scene/readers/meshes/mesh_file.h"
#include "scene/readers/meshes/mesh_text.h"
#include "testing/support/read_text.h"
#include "testing/support/scene_samples.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using glm::dvec2;
using glm::dvec3;
using samples::expect_error;
using test::read_whole_mesh;

const std::string square = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n";

/// An OBJ among other files.
struct ObjFolder {
    std::map<std::string, std::string> files;
    std::vector<std::string> warnings;

    std::vector<PolygonMesh> read(const std::string& obj) {
        ObjSurroundings around;
        around.has = [this](const std::string& name) { return files.count(name) > 0; };
        around.bytes = [this](const std::string& name) { return files.at(name); };
        around.label = [](const std::string& name) { return name; };
        around.default_library = "a.mtl";
        warnings.clear();
        return read_obj(obj, "a.obj", around, warnings);
    }
    /// The material of the first face, from this library.
    MaterialDescription material(const std::string& mtl) {
        files["m.mtl"] = mtl;
        return read("mtllib m.mtl\n" + square + "usemtl a\nf 1 2 3\n").at(0).material.value();
    }
};

std::vector<PolygonMesh> read_quietly(const std::string& obj) {
    ObjFolder folder;
    auto meshes = folder.read(obj);
    EXPECT_EQ(folder.warnings, std::vector<std::string>()) << obj;
    return meshes;
}

void expect_obj_refused(const std::string& obj, const std::string& text) {
    SCOPED_TRACE(obj);
    expect_error([&] { ObjFolder().read(obj); }, ExitCode::file, text);
}

/// Positions of the corners of all faces.
std::vector<dvec3> corner_positions(const std::vector<PolygonMesh>& meshes) {
    std::vector<dvec3> all;
    for (const PolygonMesh& mesh : meshes)
        for (const uint32_t corner : mesh.corners) all.push_back(mesh.vertices[corner]);
    return all;
}

const std::vector<dvec3> whole_square = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};

TEST(ObjFile, NumbersAreTheNearestDoubles) {
    const auto meshes =
        read_quietly("v .5 5. 1e3\nv +.25 -2.E-1 0.1\nv 9007199254740993 5e-324 1.7976931348623157e308\nf 1 2 3\n");
    EXPECT_EQ(
        corner_positions(meshes),
        (std::vector<dvec3>{{0.5, 5, 1000}, {0.25, -0.2, 0.1}, {9007199254740992.0, 5e-324, 1.7976931348623157e308}}));
    EXPECT_TRUE(std::isnan(corner_positions(read_quietly("v nan 0 0\nf 1 1 1\n"))[0].x));
    EXPECT_EQ(corner_positions(read_quietly("v 1e-310 3e-324 2e-324\nv 1e-400 -1e-400 0.001e-99999999999999999999\n"
                                            "v 0.00000000001e-320 1000e-330 1E-9999\nf 1 2 3\n")),
              (std::vector<dvec3>{{1e-310, 5e-324, 0}, {0, 0, 0}, {0, 0, 0}}));
    for (const char* large : {"1e309", "-1e309", "0.00001e+400", "1000000e307", "1e99999999999999999999"})
        expect_obj_refused(std::string("v 0 0 ") + large + "\n", "a.obj:1: expected a number, found");
    expect_obj_refused("v 1,5 0 0\n", "a.obj:1: expected a number, found '1,5'");
    expect_obj_refused(square + "v 1 0\n", "a.obj:5: v needs more numbers than 2");
    expect_obj_refused("v 1e400 0 0\n", "a.obj:1: expected a number, found '1e400'");
}

TEST(ObjFile, WeightsAndColorsOfVerticesAreNoPositions) {
    EXPECT_EQ(corner_positions(read_quietly("v 0 0 0 2\nv 2 0 0 0.5\nv 2 2 0 1 0 0\nv 0 2 0 1 1 0 0\nf 1 2 3 4\n")),
              whole_square);
    expect_obj_refused("v 0 0 0 x\n", "a.obj:1: expected a number, found 'x'");
}

TEST(ObjFile, EncodingsLineEndsIndentationAndContinuation) {
    const std::string text =
        "# caf\xc3\xa9 \\\n" + square + "g \xf0\x9f\x94\xba\xc3\xa9\n  \tf 1 2 \\\n  3 4 # the square \\\n";
    std::string little = "\xff\xfe", big = "\xfe\xff";
    for (const char16_t c : std::u16string(u"# caf\u00e9 \\\nv 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\ng \U0001f53a\u00e9\n  "
                                           u"\tf 1 2 \\\n  3 4 # the square \\\n")) {
        const char low = static_cast<char>(c & 0xff), high = static_cast<char>(c >> 8);
        little += {low, high};
        big += {high, low};
    }
    std::string returns = text, both;
    for (char& c : returns) c = c == '\n' ? '\r' : c;
    for (const char c : text) both += c == '\n' ? "\r\n" : std::string(1, c);
    for (const std::string& bytes :
         {text, "\xef\xbb\xbf" + text, little, big, little.substr(2), big.substr(2), returns, both}) {
        // As read_mesh does.
        const ScratchDirectory scratch;
        put_bytes(scratch.file("t.obj"), bytes);
        MeshObject object;
        object.file = scratch.file("t.obj");
        const auto parts = read_whole_mesh(object);
        ASSERT_EQ(parts.size(), 1u);
        EXPECT_EQ(parts[0].name, "\xf0\x9f\x94\xba\xc3\xa9");
        EXPECT_EQ(parts[0].mesh.triangles.size(), 2u);
    }
}

TEST(ObjFile, IndicesCountForwardAndBackward) {
    EXPECT_EQ(corner_positions(read_quietly(square + "f -4 -3 -2 -1\nv 9 9 9\n")), whole_square);
    EXPECT_EQ(corner_positions(read_quietly("f 1 2 3 4\n" + square)), whole_square) << "faces may come first";
    EXPECT_EQ(corner_positions(read_quietly(square + "vn 0 0 1\nf 1//1 2//-1 3//1 4//1\n")), whole_square);
    expect_obj_refused(square + "f 1 2 5\n", "a.obj:5: a face names vertex 5, but there are 4");
    expect_obj_refused(square + "f 1 2 99999999999\n", "a.obj:5: a face names vertex 99999999999, but there are 4");
    expect_obj_refused(square + "f 1 2 4294967297\n", "a.obj:5: a face names vertex 4294967297, but there are 4");
    expect_obj_refused(square + "f 1 2 -5\n", "a.obj:5: a face names vertex -5, but only 4 came before");
    expect_obj_refused(square + "f 1 2 0\n",
                       "a.obj:5: expected the number of a vertex, from 1 or from -1 backward, found '0'");
    expect_obj_refused(square + "f 1 2 3.0\n", "a.obj:5: expected the number of a vertex");
    expect_obj_refused(square + "f 1/1 2/1 3/1\n", "a.obj:5: a face names texture coordinate 1, but there are 0");
    expect_obj_refused(square + "f 1//x 2 3\n",
                       "a.obj:5: expected the number of a normal, from 1 or from -1 backward, found 'x'");
    expect_obj_refused(square + "f 1//1 2//1 3//1\n", "a.obj:5: a face names normal 1, but there are 0");
    expect_obj_refused(square + "f 1 2\n", "a.obj:5: a face needs at least 3 corners, found 2");
}

TEST(ObjFile, TextureCoordinatesBelongToCorners) {
    const auto meshes = read_quietly(square + "vt 0.5\nvt 1 0.25\nvt 0 1 0\nvn 0 0 1\nf 1/1 2/2/1 3/-1\nf 1 3 4\n");
    EXPECT_EQ(meshes.at(0).uvs, (std::vector<dvec2>{{0.5, 0}, {1, 0.25}, {0, 1}, {0, 0}, {0, 0}, {0, 0}}));
    EXPECT_TRUE(read_quietly(square + "vt 0 0\nf 1 2 3\n").at(0).uvs.empty());
}

TEST(ObjFile, WhatNoFaceUsesMayBeUnusable) {
    const std::string rows =
        square + "vt nan 0\nvt 0 0\nvt x\nvt\nvt 0 inf\nvn 1.#IND 0 0\nvn 0 0 1\nvn 0 1\nvn 1e400 0 0\n";
    const auto meshes = read_quietly(rows + "f 1/2/2 2/2/2 3/2/2\n");
    EXPECT_EQ(meshes.at(0).uvs, std::vector<dvec2>(3));
    EXPECT_EQ(meshes.at(0).normals, std::vector<dvec3>(3, dvec3(0, 0, 1)));
    for (const char* first : {"1/1", "1/-5"})
        expect_obj_refused(rows + "f " + first + " 2/2 3/2\n", "a.obj:5: a texture coordinate is not finite");
    expect_obj_refused("f 1/5 2/2 3/2\n" + rows, "a.obj:10: a texture coordinate is not finite");
    for (const char* number : {"3", "4"})
        expect_obj_refused(rows + "f 1/2 2/2 3/" + number + "\n",
                           std::string("a.obj:") + (*number == '3' ? "7" : "8") + ": expected one number or more");
    expect_obj_refused(rows + "f 1//1 2//2 3//2\n", "a.obj:10: expected three numbers, of a normal that a face uses");
    expect_obj_refused(rows + "f 1//2 2//2 3//3\n", "a.obj:12: expected three numbers");
    expect_obj_refused(rows + "f 1//2 2//2 3//4\n", "a.obj:13: expected three numbers");
}

TEST(ObjFile, ObjectsGroupsAndMaterialsBeginParts) {
    ObjFolder folder;
    folder.files["m.mtl"] = "newmtl red\nKd 1 0 0\nnewmtl deep blue\nKd 0 0 1\n";
    const auto meshes = folder.read("mtllib m.mtl\n" + square +
                                    "f 1 2 3\no box\ng left side\nusemtl red\nf 1 2 3\nf 1 3 4\ng left side\n" +
                                    "usemtl deep blue\nf 1 2 4\ng top\nf 2 3 4\nusemtl red\nf 1 2 4\n");
    std::vector<std::string> found;
    for (const PolygonMesh& mesh : meshes)
        found.push_back(mesh.name + ":" + (mesh.material ? mesh.material->name : "-") + ":" +
                        std::to_string(mesh.ends.size()));
    EXPECT_EQ(found, (std::vector<std::string>{":-:1", "left side:red:2", "left side:deep blue:1", "top:deep blue:1",
                                               "red:red:1"}));
    EXPECT_EQ(folder.warnings, std::vector<std::string>());
}

TEST(ObjFile, NormalsBelongToCorners) {
    const auto meshes =
        read_quietly(square + "vn 0 0 1\nvn 0 nan 2\nvt 0 0\ns 1\nf 1//1 2/1/-1 3//2\nf 1/1/1 2 4\no flat\nf 1 2 3\n");
    const std::vector<dvec3>& normals = meshes.at(0).normals;
    ASSERT_EQ(normals.size(), 6u);
    for (const size_t corner : {0, 3}) EXPECT_EQ(normals[corner], dvec3(0, 0, 1));
    for (const size_t corner : {1, 2}) EXPECT_EQ(normals[corner].z, 2);
    for (const size_t corner : {4, 5}) EXPECT_EQ(normals[corner], dvec3(0)) << "the face has none there";
    EXPECT_TRUE(meshes.at(1).normals.empty());
}

TEST(ObjFile, SmoothingGroupsAreNamedWhereThereAreNoNormals) {
    ObjFolder folder;
    folder.read(square + "vn 0 0 1\ns 1\nf 1 2 3\ns off\nf 1 2 4\ns 2\n");
    EXPECT_EQ(folder.warnings, (std::vector<std::string>{"a.obj: ignored what has no meaning here: 's'"}));
    read_quietly(square + "s off\nf 1 2 3\ns 0\nf 1 2 4\n");
}

TEST(ObjFile, WhatHasNoMeaningHereIsListedOnce) {
    ObjFolder folder;
    folder.files["m.mtl"] =
        "newmtl a\nKa 1 1 1\nKe 0 0 0\nTf 1 1 1\nPr 0.4\nPm 0\naniso 0\nPr 1\nKd spectral x.rfl\nd -halo 0.5\nmap_Kd "
        "-s 2 2 2 -clamp on -new 7 w.png\n";
    folder.files["w.png"];
    const auto meshes = folder.read("mtllib m.mtl\ncstype bezier\nvp 1\np 1\nl 1 2\ns off\n" + square +
                                    "usemtl a\nf 1 2 3\n\x01\x02 1\n");
    EXPECT_EQ(folder.warnings,
              (std::vector<std::string>{"a.obj: ignored what has no meaning here: 'cstype', '\\x01\\x02', 'Pr', 'Pm', "
                                        "'aniso', 'Kd spectral', '-halo', 'map_Kd', '-s', '-clamp', '-new'"}));
    EXPECT_EQ(meshes[0].material->transmission, 0.5);
    std::string keys;
    for (int i = 0; i < 1000; ++i) keys += "key" + std::to_string(i) + std::string(1000, 'x') + "\n";
    folder.read(keys + square + "f 1 2 3\n");
    ASSERT_EQ(folder.warnings.size(), 1u);
    EXPECT_LT(folder.warnings[0].size(), 1500u);
}

TEST(ObjFile, MissingFilesAndMaterialsAreNamed) {
    ObjFolder folder;
    const std::string faces = square + "usemtl a\nf 1 2 3\n";
    auto meshes = folder.read("mtllib x.mtl my own.mtl\n" + faces);
    EXPECT_EQ(folder.warnings,
              (std::vector<std::string>{"a.obj: there are no such material libraries: 'x.mtl', 'my', 'own.mtl'",
                                        "a.obj: no library has these materials: 'a'"}));
    EXPECT_EQ(meshes.at(0).material.value().color, dvec3(0.6));
    folder.files["a.mtl"] = "newmtl a\nKd .5 .5 .5\n";
    meshes = folder.read("mtllib x.mtl\n" + faces);
    EXPECT_EQ(folder.warnings, (std::vector<std::string>{"a.obj: there are no such material libraries: 'x.mtl'"}));
    EXPECT_EQ(meshes.at(0).material.value().color, dvec3(0.5)) << "from the library of the file's own name";
    folder.files["my own.mtl"] =
        "newmtl a\nmap_Kd no such.png\nmap_bump -bm 0.5 no such.png\nmap_d -o 1 2 here.png\nmap_aat on\n";
    folder.files["here.png"];
    folder.read("mtllib my own.mtl\n" + faces);
    ASSERT_EQ(folder.warnings.size(), 2u);
    EXPECT_EQ(folder.warnings[1], "a.obj: there are no files of these maps: 'no such.png'");
    folder.files["sub/b.mtl"] = "newmtl a\nmap_Kd here.png\n";
    folder.read("mtllib sub/b.mtl\n" + faces);
    EXPECT_EQ(folder.warnings.back(), "a.obj: there are no files of these maps: 'here.png'")
        << "maps lie beside the library";
}

TEST(ObjFile, MaterialsOfLibraries) {
    ObjFolder folder;
    for (const char* mtl : {"newmtl a\nd 0.25\nTr 0.25\n", "newmtl a\nTr 0.25\nd 0.25\n"})
        EXPECT_EQ(folder.material(mtl).transmission, 0.75) << "d counts";
    EXPECT_EQ(folder.material("\xef\xbb\xbf  newmtl a\n\tKd .3 \\\n .5 1e-1").color, dvec3(0.3, 0.5, 0.1));
    EXPECT_EQ(folder.material("newmtl a\nKd 0.5\n").color, dvec3(0.5));
    EXPECT_EQ(folder.material("newmtl a\nKd 1 1e-400 1e-310\n").color, dvec3(1, 0, 1e-310));
    EXPECT_EQ(folder.material("newmtl a\nKd 1 0 0\nnewmtl b\nNs 5\nnewmtl a\nNs 7\n").color, dvec3(1, 0, 0));
    EXPECT_EQ(folder.material("newmtl a\nNs 7\nKs 1 1 1\n").specular, 0) << "without illum there is no highlight";
    const auto refused = [&](const std::string& mtl, const std::string& text) {
        expect_error([&] { folder.material(mtl); }, ExitCode::file, text);
    };
    refused("map_Kd x.png\n", "m.mtl:1: 'map_Kd' before the first newmtl");
    refused("# nothing\nKd 1 1 1\nnewmtl a\n", "m.mtl:2: 'Kd' before the first newmtl");
    refused("newmtl a\nKd 1 1\n", "m.mtl:2: Kd needs a number from 0 to 1e30");
    refused("newmtl a\nKd 1 -1 1\n", "m.mtl:2: Kd: expected a number from 0 to 1e30, found '-1'");
    refused("newmtl a\nNs nan\n", "m.mtl:2: Ns: expected a number from 0 to 1000000, found 'nan'");
    refused("newmtl a\n\nKd 1 1e31 1\n", "m.mtl:3: Kd: expected a number from 0 to 1e30, found '1e31'");
    refused("newmtl a\nKs 1e300\n", "m.mtl:2: Ks: expected a number from 0 to 1e30, found '1e300'");
    refused("newmtl a\nNs 1e300\n", "m.mtl:2: Ns: expected a number from 0 to 1000000, found '1e300'");
    refused("newmtl a\nNi inf\n", "m.mtl:2: Ni: expected a number from 0 to 100, found 'inf'");
    refused("newmtl a\nd 1.5\n", "m.mtl:2: d: expected a number from 0 to 1, found '1.5'");
    refused("newmtl a\nillum\n", "m.mtl:2: illum needs a number");
}

TEST(ObjFile, AMaterialMayHaveNoName) {
    ObjFolder folder;
    EXPECT_EQ(folder.material("newmtl\nKd 0 0 1\nnewmtl a\nKd 1 0 0\n").color, dvec3(1, 0, 0));
    folder.files["m.mtl"] = "newmtl unnamed\nnewmtl  \nKd 0 0 1\n";
    const auto meshes = folder.read("mtllib m.mtl\n" + square + "usemtl unnamed\nf 1 2 3\nusemtl\nf 1 3 4\n");
    EXPECT_EQ(meshes.at(1).material.value().color, dvec3(0, 0, 1));
    EXPECT_EQ(meshes.at(1).material.value().name, "unnamed_") << "mattes tell it from the other";
    EXPECT_EQ(folder.warnings, std::vector<std::string>());
}

TEST(ObjFile, LightThatPassesIsTintedByTfOrKd) {
    ObjFolder folder;
    const auto expect = [&](const std::string& mtl, double transmission, const dvec3& tint) {
        SCOPED_TRACE(mtl);
        const MaterialDescription material = folder.material("newmtl a\n" + mtl);
        EXPECT_EQ(material.transmission, transmission);
        EXPECT_EQ(material.tint, tint);
        EXPECT_EQ(folder.warnings, std::vector<std::string>());
    };
    const dvec3 white{1}, kd{.5, .25, 0};
    expect("Kd 0 0 0\nKs 0 0 0\nTf 1 1 1\nd 0.5\nillum 4\n", 0.5, white);
    expect("Kd 0 0 0\nd 0.25\n", 0.75, white);
    expect("Kd 0 0 0\nTf 2 1 3\nd 0.25\n", 0.75, white);
    expect("Kd 0 0 0\nTf 0 0 0\nd 0.25\n", 0.75, dvec3{0});
    expect("Kd .5 .25 0\nd 0.25\n", 0.75, kd);
    expect("Kd .5 .25 0\nTf 1 1 1\nTr 0.75\n", 0.75, kd);
    expect("Tf 0 0 0\nd 0.25\nKd .5 .25 0\n", 0.75, kd);
    expect("Kd .5 .25 0\nTf .1 .2 3\nd 0\n", 1, {.1, .2, 1});
    expect("Kd 0 0 0\nTf 1 0 0\nd 0\n", 1, {1, 0, 0});
    expect("Kd 0 0 0\nTf 0.25\nd 0\n", 1, dvec3{.25});
    expect("Kd 2 0.5 0\nd 0\n", 1, {1, 0.5, 0});
    // Opaque ones: Blender, 3ds Max, Maya.
    expect("Ns 250\nKa 1 1 1\nKd .8 .8 .8\nKs .5 .5 .5\nKe 0 0 0\nNi 1.45\nd 1\nillum 2\n", 0, white);
    expect("Ns 10\nNi 1.5\nd 1\nTr 0\nTf 1 1 1\nillum 2\nKa .6 .6 .6\nKd .6 .6 .6\n", 0, white);
    expect("illum 4\nKd .5 .5 .5\nKa 0 0 0\nTf 1 1 1\nNi 1\n", 0, white);
    expect("Kd .8 .8 .8\nTf 0 0 0\nd 1\n", 0, white);
    folder.material("newmtl a\nTf .5 .5 .5\nTf spectral x.rfl\n");
    EXPECT_EQ(folder.warnings,
              (std::vector<std::string>{"a.obj: ignored what has no meaning here: 'Tf spectral', 'Tf'"}))
        << "nothing passes";
    folder.material("newmtl a\nTf .5 .5 .5\nnewmtl b\nnewmtl a\nd 0.5\nTf xyz 1 1 1\n");
    EXPECT_EQ(folder.warnings, (std::vector<std::string>{"a.obj: ignored what has no meaning here: 'Tf xyz'"}));
    expect_error([&] { folder.material("newmtl a\nTf 1 1\n"); }, ExitCode::file,
                 "m.mtl:2: Tf needs a number from 0 to 1e30");
}

TEST(ObjFile, NamesThatAreNotUtf8StayDifferent) {
    ObjFolder folder;
    folder.files["caf\xe9.mtl"] =
        "newmtl caf\xe9\nKd 1 0 0\nmap_Kd \xe8.png\nnewmtl caf\xe8\nKd 0 1 0\nnewmtl caf%E9\nKd 0 0 1\n";
    folder.files["\xe8.png"];
    const auto meshes = folder.read("mtllib caf\xe9.mtl\n" + square +
                                    "o \x94\xa0\nusemtl caf\xe9\nf 1 2 3\ng \x8b\x85\nusemtl caf\xe8\nf 1 2 3\n"
                                    "o x\nusemtl caf%E9\nf 1 2 3\nusemtl \xe9\nf 1 2 3\n");
    std::vector<std::string> found;
    for (const PolygonMesh& mesh : meshes) found.push_back(mesh.name + ":" + mesh.material->name);
    EXPECT_EQ(found, (std::vector<std::string>{"%94%A0:caf%E9", "%8B%85:caf%E8", "x:caf%25E9", "%E9:%E9"}));
    EXPECT_EQ(meshes[1].material->color, dvec3(0, 1, 0));
    EXPECT_EQ(folder.warnings, (std::vector<std::string>{"a.obj: ignored what has no meaning here: 'map_Kd'",
                                                         "a.obj: no library has these materials: '%E9'"}));
    // Halves of UTF-16's pairs, each alone.
    const std::string halves = utf8_of(std::string("\xff\xfeg\0 \0\0\xd8\n\0g\0 \0\1\xd8\n\0", 18));
    EXPECT_EQ(utf8_name(halves), "g %ED%A0%80\ng %ED%A0%81\n");
}

TEST(ObjFile, CharactersThatEndWithABackslashJoinNoLinesAndAreInNamesOfFiles) {
    const ScratchDirectory scratch;
    const std::string table = "\x95\\";  // in Shift-JIS
    put_bytes(scratch.file(table + ".mtl"), "newmtl " + table + "\nKd 1 0 0\nnewmtl \x83\\\nKd 0 1 0\n");
    put_bytes(scratch.file("a.obj"),
              "mtllib " + table + ".mtl\n" + square + "usemtl " + table + "\nf 1 2 3\nusemtl \x83\\\nf 1 2 4\n");
    MeshObject object;
    object.file = scratch.file("a.obj");
    const auto parts = read_whole_mesh(object);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].material->name, "%95\\");
    EXPECT_EQ(parts[0].material->color, dvec3(1, 0, 0));
    EXPECT_EQ(parts[1].material->color, dvec3(0, 1, 0));
    EXPECT_EQ(read_quietly("g caf\xc3\xa9\\\n x\n" + square + "f 1 2 3\n").at(0).name, "caf\xc3\xa9  x")
        << "in UTF-8 it joins";
}

TEST(ObjFile, WarningsReachTheScene) {
    const ScratchDirectory scratch;
    put_bytes(scratch.file("a.obj"), "mtllib b.mtl\n" + square + "f 1 2 3 4\nfoo\n");
    SceneDescription scene = samples::empty_scene();
    MeshObject object;
    object.file = scratch.file("a.obj");
    samples::add_object(scene, object);
    const std::string start = "test.json: /objects/0: mesh " + scratch.file("a.obj") + ": ";
    EXPECT_EQ(compile_scene<float>(scene)->warnings,
              (std::vector<std::string>{start + "ignored what has no meaning here: 'foo'",
                                        start + "there are no such material libraries: 'b.mtl'"}));
}

}  // namespace
}  // namespace cistula
