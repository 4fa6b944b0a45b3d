#include "scene/compile/meshes/mesh_apex.h"

#include <cmath>

#include <gtest/gtest.h>

#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using glm::dvec3;
using samples::solid;
using samples::square;

TrianglesObject platonic(int kind) {
    return triangulated_solid(solid(static_cast<PlatonicSolid>(kind)));
}

/// Heights of a mesh before and after the check.
struct Apexes {
    explicit Apexes(const TrianglesObject& object, bool single_precision = false)
        : scene(scene_of(object)),
          source(gather_scene(scene)),
          mesh(source.solids[0].mesh, normalization, unmoved, single_precision),
          edges(link_edges(source.solids[0].mesh)),
          first(apex_heights(mesh, edges)),
          checked(first) {
        const Groups groups = group_triangles(mesh);
        const ApexFaults faults = check_apexes(mesh, groups, group_tree(mesh, groups), checked);
        blocked = faults.crossed;
        unchecked = faults.unchecked;
    }
    dvec3 apex(uint32_t t, int side) const {
        const auto c = mesh.triangle(t);
        const dvec3 normal = normalized(cross(c[1] - c[0], c[2] - c[0]));
        return (c[0] + c[1] + c[2]) / 3.0 + (side ? 1.0 : -1.0) * double(checked.side[side][t]) * normal;
    }

    static SceneDescription scene_of(TrianglesObject object) {
        SceneDescription scene = samples::empty_scene();
        object.uvs.clear();
        samples::add_object(scene, object);
        return scene;
    }

    SceneDescription scene;
    SceneSource source;
    SceneNormalization normalization;
    std::vector<dvec3> unmoved;
    NormalizedMesh mesh;
    MeshEdges edges;
    ApexHeights first, checked;
    uint32_t blocked = 0, unchecked = 0;
};

/// Turns of a closed mesh about a point (van Oosterom and Strackee 1983): 1 inside, 0 outside.
double winding(const NormalizedMesh& mesh, const dvec3& p) {
    double sum = 0;
    for (uint32_t i = 0; i < mesh.size(); ++i) {
        const auto t = mesh.triangle(i);
        const dvec3 a = t[0] - p, b = t[1] - p, c = t[2] - p;
        const double la = length(a), lb = length(b), lc = length(c);
        sum += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (4 * M_PI);
}

/// Moller and Trumbore's test in long double, for interior crossings of the segment.
bool segment_crosses(const dvec3& from, const dvec3& to, const std::array<dvec3, 3>& t) {
    using V = glm::tvec3<long double>;
    const auto cross_l = [](const V& a, const V& b) {
        return V(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    };
    const auto dot_l = [](const V& a, const V& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    const V d = V(to) - V(from), e1 = V(t[1]) - V(t[0]), e2 = V(t[2]) - V(t[0]), s = V(from) - V(t[0]);
    const V p = cross_l(d, e2), q = cross_l(s, e1);
    const long double det = dot_l(e1, p);
    if (det == 0) return false;
    const long double u = dot_l(s, p) / det, v = dot_l(d, q) / det, along = dot_l(e2, q) / det;
    const long double slack = 1e-12L;
    return u > slack && v > slack && u + v < 1 - slack && along > slack && along < 1 - slack;
}

void expect_free(const Apexes& apexes) {
    for (uint32_t t = 0; t < apexes.mesh.size(); ++t)
        for (int side = 0; side < 2; ++side)
            for (const dvec3& corner : apexes.mesh.triangle(t))
                for (uint32_t other = 0; other < apexes.mesh.size(); ++other)
                    ASSERT_FALSE(other != t &&
                                 segment_crosses(apexes.apex(t, side), corner, apexes.mesh.triangle(other)))
                        << "triangle " << t << " side " << side << " by " << other;
}

TEST(MeshApex, LieOnTheirSideAndSeeTheirCorners) {
    for (const bool single : {false, true}) {
        std::vector<TrianglesObject> meshes = {torus(1, 0.3, 16, 12), star(0.3), bumpy_sphere(900, 0.3)};
        for (int kind = 0; kind < 5; ++kind) meshes.push_back(platonic(kind));
        for (const TrianglesObject& object : meshes) {
            const Apexes apexes(object, single);
            ASSERT_TRUE(apexes.source.solids[0].closed);
            EXPECT_EQ(apexes.blocked, 0u);
            for (uint32_t t = 0; t < apexes.mesh.size(); ++t) {
                ASSERT_GT(apexes.checked.side[0][t], 0);
                ASSERT_GT(apexes.checked.side[1][t], 0);
                EXPECT_NEAR(winding(apexes.mesh, apexes.apex(t, 0)), 1, 1e-9);
                EXPECT_NEAR(winding(apexes.mesh, apexes.apex(t, 1)), 0, 1e-9);
            }
            expect_free(apexes);
        }
    }
}

TEST(MeshApex, FlippedMeshesHaveTheSameApexes) {
    TrianglesObject object = star(0.4);
    const Apexes straight(object);
    for (auto& t : object.triangles) std::swap(t[0], t[1]);
    const Apexes turned(object);
    for (uint32_t t = 0; t < straight.mesh.size(); ++t)
        for (int side = 0; side < 2; ++side)
            EXPECT_NEAR(turned.first.side[side][t], straight.first.side[side][t], 1e-7);
}

TEST(MeshApex, HeightsByHand) {
    // Cube: interior angles of 90 degrees, factor 1 inside; outside 270, factor 1. Diagonals are flat: 180, factor 1.
    const Apexes cube(platonic(1));
    const double side = 2 / std::sqrt(3.0), inradius = side * side / (side * (2 + std::sqrt(2.0)));
    for (uint32_t t = 0; t < 12; ++t)
        for (int s = 0; s < 2; ++s) EXPECT_NEAR(cube.first.side[s][t], inradius / 8, 1e-8);
    // Tetrahedron: acos(1 / 3) inside, tan(a / 2) = 1 / sqrt 2.
    const Apexes tetrahedron(platonic(0));
    const double edge = 4 / std::sqrt(6.0), r = edge / (2 * std::sqrt(3.0));
    for (uint32_t t = 0; t < 4; ++t) {
        EXPECT_NEAR(tetrahedron.first.side[0][t], r / 8 / std::sqrt(2.0), 1e-8);
        EXPECT_NEAR(tetrahedron.first.side[1][t], r / 8, 1e-8);
    }
    // A lone triangle has no neighbors.
    TrianglesObject lone = square();
    lone.triangles.pop_back();
    const Apexes single(lone);
    EXPECT_NEAR(single.first.side[0][0], 2 / (2 + std::sqrt(2.0)) / 8, 1e-7);
    EXPECT_EQ(single.first.side[0][0], single.first.side[1][0]);
}

TEST(MeshApex, SheetsFoldedSharplyTakeTheirNeighborIntoAccount) {
    // Two triangles on one edge, the second folded back over the first by 0.02 radians, in either winding.
    for (const bool same_winding : {true, false}) {
        TrianglesObject fold;
        fold.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, std::cos(0.02), std::sin(0.02)}};
        fold.triangles = {{0, 1, 2},
                          same_winding ? std::array<uint32_t, 3>{1, 0, 3} : std::array<uint32_t, 3>{0, 1, 3}};
        const Apexes apexes(fold);
        const double inradius = 1 / (2 + std::sqrt(2.0));
        EXPECT_NEAR(apexes.first.side[1][0], inradius / 8 * std::tan(0.01), 1e-8);
        EXPECT_NEAR(apexes.first.side[0][0], inradius / 8, 1e-8);
        expect_free(apexes);
    }
}

TEST(MeshApex, SurfacesThatComeCloseLowerTheApexes) {
    // Two parallel squares with a gap far below their size, unconnected: the apexes between them must stay in the gap.
    TrianglesObject object = square();
    const TrianglesObject upper = square(0.9, 0.001);
    object.vertices.insert(object.vertices.end(), upper.vertices.begin(), upper.vertices.end());
    for (const auto& t : upper.triangles) object.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    const Apexes apexes(object);
    EXPECT_EQ(apexes.blocked, 0u);
    for (uint32_t t = 0; t < 2; ++t) {
        EXPECT_GT(apexes.first.side[1][t], 0.05f);
        EXPECT_LT(apexes.checked.side[1][t], 0.001f);
        EXPECT_GT(apexes.checked.side[1][t], 0.0004f);
        EXPECT_EQ(apexes.checked.side[0][t], apexes.first.side[0][t]);
    }
    expect_free(apexes);
}

TEST(MeshApex, SurfacesThatPassThroughOneAnotherAreCountedAndLowerNothing) {
    TrianglesObject object = square();
    object.vertices.insert(object.vertices.end(), {{0.5, -0.3, -1}, {0.5, -0.2, 1}, {0.6, -0.3, 1}});
    object.triangles.push_back({4, 5, 6});  // through the first triangle of the square
    const Apexes apexes(object);
    EXPECT_EQ(apexes.blocked, 4u);
    for (int side = 0; side < 2; ++side) EXPECT_EQ(apexes.checked.side[side], apexes.first.side[side]);
}

TEST(MeshApex, SoupsEndWithinTheBoundedNumberOfHalvings) {
    const Apexes soup(triangle_soup(300, 1.5, 11));
    EXPECT_GT(soup.blocked, 0u);
    for (uint32_t t = 0; t < soup.mesh.size(); ++t)
        for (int side = 0; side < 2; ++side)
            EXPECT_GE(soup.checked.side[side][t], std::ldexp(soup.first.side[side][t], -most_halvings));
}

TEST(MeshApex, CrowdedEdgesTakeTheNearestOnEachSide) {
    // Pages of a book at uneven angles: by all pairs up to 16 pages, by their order beyond.
    for (const int pages : {15, 40}) {
        TrianglesObject book;
        book.vertices = {{0, 0, 0}, {0, 0, 2}};
        std::vector<double> angles;
        for (int i = 0; i < pages; ++i) {
            angles.push_back(i * i * 6.0 / (pages * pages));
            const auto last = static_cast<uint32_t>(book.vertices.size());
            book.vertices.push_back({std::cos(angles.back()), std::sin(angles.back()), 1});
            if (i % 2)
                book.triangles.push_back({1, 0, last});
            else
                book.triangles.push_back({0, 1, last});
        }
        const Apexes apexes(book);
        EXPECT_EQ(apexes.edges.crowded, 1u);
        const double inradius = 2 / (2 + 2 * std::sqrt(2.0));
        for (int i = 0; i < pages; ++i) {
            const double after = (i + 1 < pages ? angles[i + 1] : angles[0] + 2 * M_PI) - angles[i];
            const double before = angles[i] - (i > 0 ? angles[i - 1] : angles[pages - 1] - 2 * M_PI);
            const auto height = [&](double angle) { return inradius / 8 * std::min(1.0, std::tan(angle / 2)); };
            EXPECT_NEAR(apexes.first.side[i % 2 ? 0 : 1][i], height(after), 1e-8) << i;
            EXPECT_NEAR(apexes.first.side[i % 2 ? 1 : 0][i], height(before), 1e-8) << i;
        }
    }
}

TEST(MeshApex, FansOfHundredsAreCheckedWhole) {
    const Apexes fan(torus(1, 1, 400, 3));
    EXPECT_EQ(fan.unchecked, 0u);
}

TEST(MeshApex, WhatIsTooTangledIsCounted) {
    const Apexes soup(triangle_soup(100000, 1.5, 11));
    EXPECT_GT(soup.blocked, 0u);
    EXPECT_GT(soup.unchecked, 0u);
    EXPECT_LE(soup.blocked + soup.unchecked, 200000u);
}

TEST(MeshApex, DoNotDependOnTheRun) {
    const TrianglesObject object = bumpy_sphere(20000, 0.3);
    const Apexes a(object), b(object);
    EXPECT_EQ(a.checked.side[0], b.checked.side[0]);
    EXPECT_EQ(a.checked.side[1], b.checked.side[1]);
}

TEST(Groups, AreTheSameFromRunToRunAndWellFilled) {
    const TrianglesObject object = bumpy_sphere(100000);
    MeshSource source;
    source.vertices = object.vertices;
    source.triangles = object.triangles;
    const SceneNormalization normalization;
    const std::vector<dvec3> unmoved;
    const NormalizedMesh mesh(source, normalization, unmoved, true);
    const Groups first = group_triangles(mesh);
    EXPECT_GT(double(mesh.size()) / (8 * first.size()), 0.8);
    for (int i = 0; i < 3; ++i) {
        const Groups again = group_triangles(mesh);
        EXPECT_EQ(first.order, again.order);
        EXPECT_EQ(first.first, again.first);
    }
}

}  // namespace
}  // namespace cistula
