// Which meshes have an inside, and what is left out of them.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "pieces_of.h"
#include "scene/compile/compiled_scene.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using glm::dvec3;
using samples::solid;
using samples::square;

ptrdiff_t turned(const MeshPieces& pieces) {
    return std::count(pieces.turned.begin(), pieces.turned.end(), 1);
}

TEST(ClosedMeshes, SolidsAndSmoothMeshesAreClosed) {
    for (int kind = 0; kind < 5; ++kind)
        EXPECT_TRUE(pieces_of(triangulated_solid(solid(static_cast<PlatonicSolid>(kind)))).closed);
    for (const auto& object : {torus(1, 0.3, 20, 10), star(), bumpy_sphere(2000)}) {
        const MeshPieces pieces = pieces_of(object);
        EXPECT_TRUE(pieces.closed);
        EXPECT_EQ(turned(pieces), 0);
        EXPECT_EQ(pieces.faults.open_edges, 0u);
        EXPECT_EQ(pieces.source.size(), object.triangles.size());
    }
}

TEST(ClosedMeshes, VerticesAtOnePositionCountAsOne) {
    const TrianglesObject joined = torus(1, 0.3, 12, 8);
    TrianglesObject apart;
    for (const auto& t : joined.triangles) {
        const auto first = static_cast<uint32_t>(apart.vertices.size());
        for (const uint32_t corner : t) apart.vertices.push_back(joined.vertices[corner]);
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    EXPECT_TRUE(pieces_of(apart).closed);
    apart.vertices[0].x = std::nextafter(apart.vertices[0].x, 9);
    EXPECT_FALSE(pieces_of(apart).closed);
}

TEST(ClosedMeshes, MinusZeroIsZero) {
    TrianglesObject object = triangulated_solid(solid(PlatonicSolid::octahedron));
    for (auto& t : object.triangles) {
        for (auto& corner : t) {
            dvec3 p = object.vertices[corner];
            for (int axis = 0; axis < 3; ++axis)
                if (p[axis] == 0 && object.vertices.size() % 2) p[axis] = -0.0;
            object.vertices.push_back(p);
            corner = static_cast<uint32_t>(object.vertices.size() - 1);
        }
    }
    EXPECT_TRUE(pieces_of(object).closed);
}

TEST(ClosedMeshes, InsideOutMeshesAreTurned) {
    TrianglesObject object = star();
    for (auto& t : object.triangles) std::swap(t[0], t[2]);
    const MeshPieces pieces = pieces_of(object);
    EXPECT_TRUE(pieces.closed);
    EXPECT_EQ(turned(pieces), static_cast<ptrdiff_t>(object.triangles.size()));
    EXPECT_EQ(pieces.faults.turned, 0u);
}

TEST(ClosedMeshes, WhatIsWoundUnlikeItsNeighborsIsTurnedAndCounted) {
    TrianglesObject object = torus(1, 0.3, 12, 8);
    std::swap(object.triangles[5][0], object.triangles[5][1]);
    std::swap(object.triangles[9][0], object.triangles[9][2]);
    for (const bool inside_out : {false, true}) {
        const MeshPieces pieces = pieces_of(object);
        EXPECT_TRUE(pieces.closed);
        EXPECT_EQ(pieces.faults.turned, 2u);
        for (size_t t = 0; t < pieces.turned.size(); ++t)
            EXPECT_EQ(pieces.turned[t] != 0, (t == 5 || t == 9) != inside_out) << t;
        for (auto& t : object.triangles) std::swap(t[0], t[1]);
    }
    SceneDescription scene = samples::empty_scene();
    samples::add_object(scene, object);
    EXPECT_EQ(
        compile_scene<float>(scene)->warnings,
        std::vector<std::string>{"/objects/0: object 0: turned 2 triangles that were wound unlike the others of the "
                                 "surface"});
}

TEST(ClosedMeshes, BrokenMeshesAreSheets) {
    TrianglesObject hole = torus(1, 0.3, 12, 8);
    hole.triangles.pop_back();
    EXPECT_FALSE(pieces_of(hole).closed);
    EXPECT_EQ(pieces_of(hole).faults.open_edges, 3u);
    EXPECT_EQ(pieces_of(hole).faults.why_not_closed(), "3 open edges");
    TrianglesObject fin = triangulated_solid(solid(PlatonicSolid::cube));  // a third triangle on an edge
    fin.vertices.push_back({3, 3, 3});
    fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], 8});
    EXPECT_FALSE(pieces_of(fin).closed);
    EXPECT_EQ(pieces_of(fin).faults.why_not_closed(), "2 open edges and 1 edge of more than two faces");
    TrianglesObject flat = square();  // a triangle, and its other side in three around a point: without a volume
    flat.vertices[3] = (flat.vertices[0] + flat.vertices[1] + flat.vertices[2]) / 3.0;
    flat.triangles = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
    const MeshPieces pieces = pieces_of(flat);
    EXPECT_EQ(pieces.faults.open_edges, 0u);
    EXPECT_FALSE(pieces.closed);
    EXPECT_EQ(pieces.faults.why_not_closed(), "no volume");
}

TEST(ClosedMeshes, TwoSolidsInOneMeshMayTouchAtAVertex) {
    TrianglesObject two = triangulated_solid(solid(PlatonicSolid::octahedron));
    const TrianglesObject other = triangulated_solid(solid(PlatonicSolid::octahedron, {2, 0, 0}));
    for (const auto& t : other.triangles) two.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
    two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
    EXPECT_TRUE(pieces_of(two).closed);
}

TEST(ClosedMeshes, DegenerateTrianglesAreLeftOutAndCounted) {
    TrianglesObject object = torus(1, 0.3, 12, 8);
    const auto count = static_cast<uint32_t>(object.triangles.size());
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    const auto first = static_cast<uint32_t>(object.vertices.size());
    object.vertices.insert(object.vertices.end(), {{nan, 0, 0}, {0, inf, 0}, object.vertices[3]});
    object.triangles.insert(object.triangles.begin() + 7, {3, first, 5});
    object.triangles.insert(object.triangles.begin() + 9, {3, 4, first + 1});
    object.triangles.push_back({3, 3, 5});
    object.triangles.push_back({first + 2, 4, 3});
    MeshPieces pieces = pieces_of(object);
    EXPECT_TRUE(pieces.closed);
    EXPECT_EQ(pieces.source.size(), count);
    EXPECT_EQ(pieces.faults.not_finite, 2u);
    EXPECT_EQ(pieces.faults.repeated_vertex, 2u);
    EXPECT_EQ(pieces.source[6], 6u);
    EXPECT_EQ(pieces.source[7], 8u);
    EXPECT_EQ(pieces.faults.left_out(),
              "left out 2 triangles with a repeated vertex and 2 triangles with a vertex that is not finite");

    TrianglesObject sheet = square();
    sheet.vertices.push_back({5, 5, 0});
    sheet.triangles.push_back({0, 2, 4});  // on the diagonal's line
    pieces = pieces_of(sheet);
    EXPECT_EQ(pieces.faults.zero_area, 1u);
    EXPECT_EQ(pieces.source.size(), 2u);
    EXPECT_EQ(pieces.faults.left_out(), "left out 1 triangle of zero area");
}

TEST(ClosedMeshes, SliversThatSealAMeshStay) {
    // A vertex in the middle of one edge of a tetrahedron, known to one of its two triangles only; a sliver joins them.
    TrianglesObject object;
    object.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}};
    object.triangles = {{0, 2, 4}, {4, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 1}};
    const MeshPieces sealed = pieces_of(object);
    EXPECT_TRUE(sealed.closed);
    EXPECT_EQ(sealed.source.size(), 6u);
    EXPECT_EQ(sealed.faults.zero_area, 0u);
    object.triangles.pop_back();
    EXPECT_FALSE(pieces_of(object).closed);
}

TEST(ClosedMeshes, NothingLeftIsASheetOfNothing) {
    SceneDescription scene = samples::empty_scene();
    TrianglesObject object;
    object.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    object.triangles = {{0, 1, 2}, {0, 0, 1}};
    samples::add_object(scene, object);
    samples::add_object(scene, square());
    const auto compiled = compile_scene<float>(scene);
    EXPECT_EQ(compiled->solids[0].kind, SolidKind::sheet);
    EXPECT_EQ(compiled->clusters.size(), 1u);
    ASSERT_EQ(compiled->warnings.size(), 1u);
    EXPECT_EQ(compiled->warnings[0],
              "/objects/0: object 0: left out 1 triangle with a repeated vertex and 1 triangle of zero area");
}

}  // namespace
}  // namespace cistula
