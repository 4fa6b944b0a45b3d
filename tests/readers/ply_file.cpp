#include "scene/readers/meshes/mesh_formats.h"

#include <atomic>
#include <bit>
#include <cstring>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using glm::dvec3;
using samples::expect_error;

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string indices = "property list uchar int vertex_indices\n";
const std::string triangle = "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz + "element face 1\n" + indices +
                             "end_header\n0 0 0\n2 0 0\n0 2 0\n3 0 1 2\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

PolygonMesh ply_mesh(const std::string& bytes) {
    std::vector<std::string> warnings;
    PolygonMesh mesh = read_ply(bytes, "a.ply", warnings);
    EXPECT_EQ(warnings, std::vector<std::string>()) << bytes.substr(0, 300);
    return mesh;
}

void expect_ply_refused(const std::string& bytes, const std::string& text) {
    SCOPED_TRACE(bytes.substr(0, 300));
    expect_error([&] { ply_mesh(bytes); }, ExitCode::file, text);
}

void expect_triangle(const PolygonMesh& mesh) {
    EXPECT_EQ(mesh.vertices, (std::vector<dvec3>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}));
    EXPECT_EQ(mesh.corners, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_EQ(mesh.ends, (std::vector<size_t>{3}));
}

/// A value as a type has it, in a file's order of bytes.
template <class T>
std::string binary(T value, bool big_endian) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    return big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

TEST(PlyFile, TextWithLineEndsOfAllKinds) {
    for (const char* end : {"\n", "\r\n", "\r"}) expect_triangle(ply_mesh(replaced(triangle, "\n", end)));
    expect_triangle(ply_mesh(triangle.substr(0, triangle.size() - 1)));
    expect_triangle(ply_mesh(replaced(triangle, "\n2 0 0", "\n\n  2\t0 0 \n\n")));
    expect_triangle(
        ply_mesh(replaced(triangle, "element vertex", "comment by hand\nobj_info n = 3\n\nelement vertex")));
}

TEST(PlyFile, BinaryDataMayBeginWithALineEnd) {
    // The first vertex is a char of 10 or 13, which stands right behind the line end of the header.
    for (const std::string end : {"\n", "\r\n", "\r"})
        for (const char first : {'\n', '\r'}) {
            std::string bytes = replaced("ply\nformat binary_little_endian 1.0\nelement vertex 1\n" +
                                             replaced(xyz, "float", "char") + "end_header\n",
                                         "\n", end);
            bytes += first;
            bytes += "\x01\x02";
            EXPECT_EQ(ply_mesh(bytes).vertices, (std::vector<dvec3>{{first, 1, 2}}));
        }
}

template <class Coordinate, class Size, class Index>
void check_types(const std::string& coordinate, const std::string& size, const std::string& index) {
    for (const bool big : {false, true}) {
        SCOPED_TRACE(coordinate + " " + size + " " + index);
        std::string bytes = fmt::format(
            "ply\nformat binary_{}_endian 1.0\nelement extra 2\nproperty {} a\nproperty list {} {} b\nelement vertex "
            "3\n"
            "property uchar red\nproperty {} x\nproperty {} y\nproperty list uchar double w\nproperty {} z\nelement "
            "face 1\n"
            "property short flag\nproperty list {} {} vertex_index\nproperty float quality\nelement edge 1\nproperty "
            "int v\nend_header\n",
            big ? "big" : "little", coordinate, size, index, coordinate, coordinate, coordinate, size, index);
        for (int i = 0; i < 2; ++i)
            bytes += binary<Coordinate>(5, big) + binary<Size>(1, big) + binary<Index>(100, big);
        for (const int p : {0, 2, 4}) {
            bytes += 'r';
            bytes += binary(Coordinate(p), big) + binary(Coordinate(1), big);
            bytes += '\x01' + binary(0.5, big) + binary(Coordinate(p + 1), big);
        }
        bytes += binary(int16_t(-1), big) + binary<Size>(3, big);
        for (const int i : {2, 0, 1}) bytes += binary(Index(i), big);
        bytes += binary(1.5f, big) + binary(int32_t(9), big);
        const PolygonMesh mesh = ply_mesh(bytes);
        EXPECT_EQ(mesh.vertices, (std::vector<dvec3>{{0, 1, 1}, {2, 1, 3}, {4, 1, 5}}));
        EXPECT_EQ(mesh.corners, (std::vector<uint32_t>{2, 0, 1}));
        // However much of the data is missing, it is missed.
        const size_t data = bytes.find("end_header\n") + 11;
        for (size_t length = data; length < bytes.size(); ++length)
            expect_ply_refused(bytes.substr(0, length), "cut short");
    }
}

TEST(PlyFile, AllTypesInBothOrdersOfBytesAmongWhatIsNotRead) {
    check_types<int8_t, uint8_t, int8_t>("char", "uchar", "char");
    check_types<int8_t, uint8_t, int8_t>("int8", "uint8", "int8");
    check_types<uint8_t, int8_t, uint8_t>("uchar", "char", "uchar");
    check_types<int16_t, uint16_t, int16_t>("short", "ushort", "short");
    check_types<uint16_t, int16_t, uint16_t>("uint16", "int16", "uint16");
    check_types<int32_t, uint32_t, int32_t>("int", "uint", "int");
    check_types<uint32_t, int32_t, uint32_t>("uint32", "int32", "uint32");
    check_types<float, uint8_t, int32_t>("float", "uint8", "int32");
    check_types<double, uint8_t, uint32_t>("double", "uchar", "uint");
    check_types<float, int32_t, uint16_t>("float32", "int", "ushort");
    check_types<double, uint16_t, int16_t>("float64", "ushort", "short");
}

TEST(PlyFile, NumbersAreRoundedOnceToTheirType) {
    const auto first = [](const std::string& type, const std::string& number) {
        return ply_mesh(replaced(replaced(triangle, "float", type), "\n2 0 0", "\n" + number + " 0 0")).vertices[1].x;
    };
    EXPECT_EQ(first("double", "0.1"), 0.1);
    EXPECT_EQ(first("double", "+.5"), 0.5);
    EXPECT_EQ(first("double", "-5.e-1"), -0.5);
    EXPECT_EQ(first("double", "9007199254740993"), 9007199254740992.0);
    EXPECT_EQ(first("double", "4.9e-324"), 4.9e-324);
    EXPECT_EQ(first("float", "0.1"), static_cast<double>(0.1f));
    // Between two floats, a hair above their middle: by way of a double it would become the lower one.
    EXPECT_EQ(first("float", "1.000000059604644775390625000001"), 1 + 0x1p-23);
    EXPECT_EQ(first("float", "1e-46"), 0);
    EXPECT_EQ(first("float", "1e-400"), 0);
    EXPECT_EQ(first("float", "1e-40"), static_cast<double>(1e-40f));
    EXPECT_EQ(first("double", "1e-400"), 0);
    EXPECT_TRUE(std::isnan(first("float", "nan")));
    EXPECT_EQ(first("float", "-inf"), -INFINITY);
    EXPECT_EQ(first("uchar", "2e2"), 200);
    expect_ply_refused(replaced(triangle, "\n2 0 0", "\n1e39 0 0"), "a.ply:11: '1e39' is more than a float holds");
    expect_ply_refused(replaced(triangle, "\n2 0 0", "\n1e400 0 0"), "a.ply:11: expected a number, found '1e400'");
    expect_ply_refused(replaced(triangle, "\n2 0 0", "\n0x2 0 0"), "a.ply:11: expected a number, found '0x2'");
    expect_ply_refused(replaced(triangle, "3 0 1 2", "3 0 1 1.5"),
                       "a.ply:13: expected a whole number from -2147483648 to 2147483647, found '1.5'");
    expect_ply_refused(replaced(triangle, "3 0 1 2", "nan 0 1 2"), "a.ply:13: expected a whole number from 0 to 255");
}

TEST(PlyFile, StripsBeginAgainBehindMinusOne) {
    const PolygonMesh mesh = ply_mesh(
        "ply\nformat ascii 1.0\nelement tristrips 2\nproperty list int int vertex_indices\nelement vertex 7\n" + xyz +
        "end_header\n10 0 1 2 3 -1 4 -1 6 5 4\n5 0 1 1 2 3\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n4 0 0\n5 0 0\n6 0 0\n");
    // The second strip is stitched: triangles that repeat a vertex turn the winding, and are no triangles.
    EXPECT_EQ(mesh.corners, (std::vector<uint32_t>{0, 1, 2, 2, 1, 3, 6, 5, 4, 1, 2, 3}));
    EXPECT_EQ(mesh.ends, (std::vector<size_t>{3, 6, 9, 12}));
}

TEST(PlyFile, TextureCoordinatesOfVerticesAndOfCorners) {
    for (const auto& [u, v] : {std::pair{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}}) {
        std::string text = replaced(triangle, xyz, xyz + "property float " + u + "\nproperty double " + v + "\n");
        text = replaced(replaced(replaced(text, "\n0 0 0", "\n0 0 0 0 1"), "\n2 0 0", "\n2 0 0 .5 .25"), "\n0 2 0",
                        "\n0 2 0 1 0");
        EXPECT_EQ(ply_mesh(text).uvs, (std::vector<glm::dvec2>{{0, 1}, {0.5, 0.25}, {1, 0}}));
        expect_ply_refused(replaced(text, ".25", "inf"), "a.ply:13: a texture coordinate is not finite");
    }
    std::string text = replaced(triangle, indices, indices + "property list uchar float texcoord\n");
    EXPECT_EQ(ply_mesh(replaced(text, "3 0 1 2", "3 0 1 2 6 0 0 1 0 0 1")).corner_uvs,
              (std::vector<glm::dvec2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_TRUE(ply_mesh(replaced(text, "3 0 1 2", "3 0 1 2 0")).corner_uvs.empty());
    expect_ply_refused(replaced(text, "3 0 1 2", "3 0 1 2 4 0 0 1 0"), "a.ply:14: 4 values of texcoord for 3 corners");
}

TEST(PlyFile, NormalsOfVertices) {
    std::vector<std::string> warnings;
    const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
    std::string text = replaced(triangle, xyz, xyz + normals);
    for (const char* vertex : {"\n0 0 0", "\n2 0 0", "\n0 2 0"})
        text = replaced(text, vertex, vertex + std::string(" 0 0 1"));
    text = replaced(text, "0 2 0 0 0 1", "0 2 0 0 nan 3");
    const PolygonMesh mesh = read_ply(text, "a.ply", warnings);
    expect_triangle(mesh);
    ASSERT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.normals[1], glm::dvec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[2].z, 3);
    EXPECT_TRUE(warnings.empty());
    text = replaced(text, "property float ny\n", "property float my\n");
    EXPECT_TRUE(read_ply(text, "a.ply", warnings).normals.empty());
    EXPECT_EQ(warnings, (std::vector<std::string>{"a.ply: ignored what has no meaning here: 'nx', 'nz'"}));
}

TEST(PlyFile, ReadingIsStopped) {
    std::vector<std::string> warnings;
    const std::atomic<bool> given = true;
    EXPECT_THROW(read_ply(triangle, "a.ply", warnings, given), Error);
    EXPECT_THROW(read_obj("v 0 0 0\n", "a.obj", {}, warnings, given), Error);
}

TEST(PlyFile, WrongHeadersAreNamedByLine) {
    const auto refused = [](const std::string& from, const std::string& to, const std::string& text) {
        ASSERT_NE(triangle.find(from), std::string::npos) << from;
        expect_ply_refused(replaced(triangle, from, to), text);
    };
    expect_ply_refused("", "a.ply:0: is not PLY");
    expect_ply_refused("solid\n", "a.ply:1: is not PLY");
    refused("ascii 1.0", "ascii 2.0", "a.ply:2: expected one line");
    refused("ascii", "text", "a.ply:2: expected ascii, binary_little_endian or binary_big_endian, found 'text'");
    refused("format ascii 1.0\n", "", "a.ply:8: the header has no format line");
    refused("format ascii 1.0\n", "format ascii 1.0\nformat ascii 1.0\n", "a.ply:3: expected one line");
    refused("element vertex 3", "element vertex -3", "a.ply:3: expected \"element\", a name and how many");
    refused("element vertex 3", "element vertex 99999999999999999999", "a.ply:3: expected \"element\"");
    refused("element vertex 3\n", "", "a.ply:3: a property before the first element");
    refused("element face", "element vertex", "a.ply:7: a second element 'vertex'");
    refused("float y", "float x", "a.ply:5: a second property 'x'");
    refused("float y", "real y", "a.ply:5: 'real' is not a type; types are char");
    refused("float y", "float", "a.ply:5: expected \"property\", a type and a name");
    refused("uchar int", "float int", "a.ply:8: the size of a list must have an integer type");
    refused("property float z\n", "", "a.ply:3: element vertex lacks one of the properties x, y and z");
    refused("property float z\n", "property list uchar float z\n", "a.ply:3: element vertex lacks");
    refused("vertex_indices", "corners", "a.ply:7: element face has no list vertex_indices");
    refused("uchar int", "uchar float", "a.ply:7: element face has no list vertex_indices of an integer type");
    refused("list uchar int", "int", "a.ply:7: element face has no list vertex_indices");
    refused("end_header\n", "ende\n", "a.ply:9: 'ende' is not PLY; a header has format, comment");
    expect_ply_refused(triangle.substr(0, triangle.find("end_header") + 5), "a.ply:9: the file ends in its header");
}

TEST(PlyFile, WrongRowsAreNamedByLine) {
    const auto refused = [](const std::string& from, const std::string& to, const std::string& text) {
        expect_ply_refused(replaced(triangle, from, to), text);
    };
    refused("\n2 0 0", "\n2 0", "a.ply:11: element 'vertex' needs more than the 2 values of its line");
    refused("\n2 0 0", "\n2 0 0 7", "a.ply:11: found 4 values; expected 3");
    refused("3 0 1 2", "4 0 1 2",
            "a.ply:13: the list 'vertex_indices' says that it has 4 values, but 3 are left on its line");
    refused("3 0 1 2", "3 0 1 3", "a.ply:13: names vertex 3, but there are 3, numbered from 0");
    refused("3 0 1 2", "3 0 1 -1", "a.ply:13: names vertex -1");
    expect_ply_refused(replaced(replaced(triangle, "list uchar", "list char"), "3 0 1 2", "-1 0 1 2"),
                       "says that it has -1 values");
    refused("element vertex 3", "element vertex 4", "a.ply:13: found 4 values; expected 3");
    refused("element face 1", "element face 2", "a.ply:13: the file ends before the element does: it is cut short");
    refused("3 0 1 2\n", "", "a.ply:7: 1 of these take at least 2 bytes each, but");
}

TEST(PlyFile, SizesThatTheFileCannotHoldAreRefusedAtOnce) {
    for (const char* format : {"ascii", "binary_little_endian"})
        for (const std::string element : {"element vertex ", "element face "})
            for (const std::string count : {"4000000000", "18446744073709551615"}) {
                const std::string text = replaced(replaced(triangle, "ascii", format), "float", "char");
                const size_t at = text.find(element) + element.size();
                expect_ply_refused(text.substr(0, at) + count + text.substr(at + 1),
                                   count + " of these take at least ");
            }
    std::string bytes = "ply\nformat binary_big_endian 1.0\nelement vertex 0\n" + xyz +
                        "element face 1\nproperty list uint char vertex_indices\nend_header\n\xff\xff\xff\xff\x01";
    expect_ply_refused(
        bytes,
        "a.ply: byte 166: the list 'vertex_indices' says that it has 4294967295 values, but 1 are left in the file");
    // Rows of nothing take no time.
    EXPECT_TRUE(ply_mesh(replaced(triangle, "element face", "element nothing 18446744073709551615\nelement face"))
                    .ends.size() == 1);
}

}  // namespace
}  // namespace cistula
