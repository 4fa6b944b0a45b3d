// Faces of a mesh that are there several times count once: the first one stays as it is.
#include <algorithm>
#include <cstring>
#include <utility>

#include <gtest/gtest.h>

#include "pieces_of.h"
#include "scene/compile/compiled_scene.h"
#include "testing/support/scene.h"
#include "testing/support/scene_samples.h"

namespace cistula {
namespace {

using test::Random;

using Triangle = std::array<uint32_t, 3>;

/// One of a triangle's six orders of corners; odd ones turn it over.
Triangle reordered(Triangle t, uint32_t order) {
    std::rotate(t.begin(), t.begin() + order / 2, t.end());
    if (order % 2) std::swap(t[1], t[2]);
    return t;
}

/// A copy of a triangle, with new vertices at the same positions (zeros of the other sign) and other uvs.
Triangle copy_of(TrianglesObject& object, const Triangle& t) {
    Triangle copy;
    for (size_t c = 0; c < 3; ++c) {
        copy[c] = static_cast<uint32_t>(object.vertices.size());
        glm::dvec3 p = object.vertices[t[c]];
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] == 0) p[axis] = -p[axis];
        object.vertices.push_back(p);
        if (!object.uvs.empty()) object.uvs.push_back({-7, 7});
    }
    return copy;
}

TEST(DoubledFaces, TheFirstStaysWhateverTheOrderOfCornersOfOthers) {
    for (uint32_t order = 0; order < 6; ++order) {
        TrianglesObject object = samples::square();
        object.triangles.push_back(reordered(object.triangles[1], order));
        object.triangles.push_back(reordered(copy_of(object, object.triangles[0]), order));
        const MeshPieces pieces = pieces_of(object);
        EXPECT_EQ(pieces.source.size(), 2u);
        EXPECT_EQ(pieces.faults.doubled, 2u);
        EXPECT_EQ(pieces.source, (std::vector<uint32_t>{0, 1}));
        EXPECT_EQ(pieces.faults.open_edges, 4u);
        EXPECT_EQ(pieces.faults.left_out(), "");
    }
}

TEST(DoubledFaces, OneThatSharesTwoCornersIsAnother) {
    TrianglesObject object = samples::square();
    object.triangles.push_back({1, 2, 3});
    EXPECT_EQ(pieces_of(object).faults.doubled, 0u);
    EXPECT_EQ(pieces_of(object).source.size(), 3u);
}

TEST(DoubledFaces, ClosedMeshesAreClosedAgain) {
    for (const TrianglesObject& once : {star(), torus(1, 0.3, 12, 8), test::solid_mesh(PlatonicSolid::cube)})
        for (uint32_t order = 0; order < 6; ++order) {
            const auto count = static_cast<uint32_t>(once.triangles.size());
            TrianglesObject one_by_one = once, side_by_side = once;
            one_by_one.triangles.clear();
            for (const Triangle& t : once.triangles) {
                one_by_one.triangles.insert(one_by_one.triangles.end(), {t, reordered(t, order)});
                side_by_side.triangles.push_back(reordered(copy_of(side_by_side, t), order));
            }
            for (const TrianglesObject& object : {one_by_one, side_by_side}) {
                const MeshPieces pieces = pieces_of(object);
                EXPECT_TRUE(pieces.closed);
                EXPECT_EQ(std::count(pieces.turned.begin(), pieces.turned.end(), 1), 0);
                EXPECT_EQ(pieces.source.size(), count);
                EXPECT_EQ(pieces.faults.doubled, count);
            }
        }
}

/// Both sides of every face, in any order: those that stay are turned to face alike, outward.
TEST(DoubledFaces, WindingsInAnyOrderAreClosedAgain) {
    Random random(7);
    for (const TrianglesObject& once : {star(), torus(1, 0.3, 12, 8), test::solid_mesh(PlatonicSolid::cube)})
        for (int trial = 0; trial < 8; ++trial) {
            TrianglesObject object = once;
            // A second piece of the same form, apart from the first.
            const auto corners = static_cast<uint32_t>(once.vertices.size());
            for (const glm::dvec3& p : once.vertices) object.vertices.push_back(p + glm::dvec3(9, 0, 0));
            std::vector<Triangle> all = once.triangles;
            for (const Triangle& t : once.triangles) all.push_back({t[0] + corners, t[1] + corners, t[2] + corners});
            object.triangles.clear();
            for (const Triangle& t : all) {
                const uint32_t order = random.below(6);
                object.triangles.insert(object.triangles.end(), {reordered(t, order), reordered(t, order ^ 1)});
            }
            const MeshPieces pieces = pieces_of(object);
            ASSERT_TRUE(pieces.closed);
            EXPECT_EQ(pieces.source.size(), all.size());
            for (uint32_t i = 0; i < pieces.source.size(); ++i) {
                Triangle t = object.triangles[pieces.source[i]];
                if (pieces.turned[i]) std::swap(t[1], t[2]);
                std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
                Triangle right = all[i];
                std::rotate(right.begin(), std::min_element(right.begin(), right.end()), right.end());
                EXPECT_EQ(t, right) << i;
            }
        }
}

/// Two flat quads of the same corners, divided along the two diagonals: the pair of the first triangle stays.
TEST(DoubledFaces, QuadsDividedAlongTheOtherDiagonalAreOne) {
    TrianglesObject object = samples::square();  // 0 1 2, 0 2 3
    const std::vector<Triangle> first = object.triangles;
    for (const std::vector<Triangle>& second :
         {std::vector<Triangle>{{1, 2, 3}, {1, 3, 0}}, std::vector<Triangle>{{3, 2, 1}, {0, 3, 1}}}) {
        object.triangles = first;
        object.triangles.insert(object.triangles.end(), second.begin(), second.end());
        MeshPieces pieces = pieces_of(object);
        EXPECT_EQ(pieces.source, (std::vector<uint32_t>{0, 1}));
        EXPECT_EQ(pieces.faults.doubled, 2u);
        object.triangles = {second[0], first[0], second[1], first[1]};
        EXPECT_EQ(pieces_of(object).source, (std::vector<uint32_t>{0, 2}));
        // What lies in between is a body, where there is something in between.
        object.vertices[2] +=
            0.01 * cross(object.vertices[1] - object.vertices[0], object.vertices[3] - object.vertices[0]);
        pieces = pieces_of(object);
        EXPECT_EQ(pieces.faults.doubled, 0u);
        EXPECT_EQ(pieces.source.size(), 4u);
        object.vertices = samples::square().vertices;
    }
    // No quad: the same four corners in another cycle.
    object.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}};
    EXPECT_EQ(pieces_of(object).faults.doubled, 0u);
    EXPECT_EQ(pieces_of(test::solid_mesh(PlatonicSolid::tetrahedron)).faults.doubled, 0u);
}

TEST(DoubledFaces, SealingSliversCountToo) {
    // ClosedMeshes.SliversThatSealAMeshStay, with every triangle twice.
    TrianglesObject object;
    object.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}};
    object.triangles = {{0, 2, 4}, {4, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 1}};
    const auto once = object.triangles;
    for (const Triangle& t : once) object.triangles.push_back({t[1], t[0], t[2]});
    const MeshPieces pieces = pieces_of(object);
    EXPECT_TRUE(pieces.closed);
    EXPECT_EQ(pieces.source.size(), 6u);
    EXPECT_EQ(pieces.faults.doubled, 6u);
    EXPECT_EQ(pieces.faults.zero_area, 0u);
}

TEST(DoubledFaces, TrianglesWithoutThreeCornersAreCountedAsSuch) {
    TrianglesObject object = samples::square();
    object.vertices.push_back({NAN, 0, 0});
    object.triangles.insert(object.triangles.end(), {{0, 0, 1}, {0, 0, 1}, {0, 1, 4}, {0, 1, 4}});
    const MeshPieces pieces = pieces_of(object);
    EXPECT_EQ(pieces.faults.repeated_vertex, 2u);
    EXPECT_EQ(pieces.faults.not_finite, 2u);
    EXPECT_EQ(pieces.faults.doubled, 0u);
}

TEST(DoubledFaces, AreCountedInAWarning) {
    SceneDescription scene = samples::empty_scene();
    TrianglesObject object = samples::square();
    object.triangles.push_back({2, 1, 0});
    samples::add_object(scene, object);
    object.triangles.push_back({2, 0, 3});
    samples::add_object(scene, object);
    samples::add_object(scene, samples::square(1, 2));
    EXPECT_EQ(compile_scene<float>(scene)->warnings,
              (std::vector<std::string>{"/objects/0: object 0: merged 1 face with the corners of an earlier one",
                                        "/objects/1: object 1: merged 2 faces with the corners of an earlier one"}));
}

/// Adds copies of random triangles, each somewhere after the first of its kind; how many.
uint32_t put_copies(Random& random, TrianglesObject& object) {
    const uint32_t copies = 1 + random.below(static_cast<uint32_t>(object.triangles.size()));
    std::vector<std::pair<double, Triangle>> places;
    for (const Triangle& t : object.triangles) places.push_back({static_cast<double>(places.size()), t});
    const auto first = places;
    for (uint32_t i = 0; i < copies; ++i) {
        const auto& [place, t] = first[random.below(static_cast<uint32_t>(first.size()))];
        const Triangle copy = random.below(2) ? copy_of(object, t) : t;
        places.push_back(
            {random.between(place + 0.5, static_cast<double>(first.size())), reordered(copy, random.below(6))});
    }
    std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    object.triangles.clear();
    for (const auto& place : places) object.triangles.push_back(place.second);
    return copies;
}

template <class T>
void expect_same_bits(const std::vector<T>& a, const std::vector<T>& b, const char* what) {
    ASSERT_EQ(a.size(), b.size()) << what;
    EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) << what;
}

template <class Real>
void expect_same_arrays(const CompiledScene<Real>& a, const CompiledScene<Real>& b) {
    ASSERT_EQ(a.solids.size(), b.solids.size());
    for (size_t i = 0; i < a.solids.size(); ++i) {
        const Solid &p = a.solids[i], &q = b.solids[i];
        EXPECT_TRUE(p.kind == q.kind && p.material == q.material && p.first_triangle == q.first_triangle &&
                    p.first_uv == q.first_uv && p.flat == q.flat && p.plane_normal == q.plane_normal &&
                    p.plane_offset == q.plane_offset)
            << "solid " << i;
    }
    expect_same_bits(a.clusters, b.clusters, "clusters");
    expect_same_bits(a.uvs, b.uvs, "uvs");
    expect_same_bits(a.incidents, b.incidents, "incidents");
    ASSERT_EQ(a.hulls.size(), b.hulls.size());
    for (size_t i = 0; i < a.hulls.size(); ++i) expect_same_bits(a.hulls[i].points, b.hulls[i].points, "hulls");
    EXPECT_EQ(a.effects, b.effects);
    EXPECT_EQ(a.bound, b.bound);
    EXPECT_EQ(a.extent, b.extent);
}

template <class Real>
void expect_no_trace(uint64_t seed) {
    Random random(seed);
    SceneDescription plain = samples::empty_scene();
    plain.materials.push_back(samples::material("textured"));
    plain.materials[1].texture = 0;
    plain.textures.resize(1);
    samples::add_object(plain, torus(1 + random.unit(), 0.3, 3 + random.below(6), 3 + random.below(4)));
    samples::add_object(plain, star());
    samples::add_object(plain, triangle_soup(1 + random.below(40), 0.7, random.bits()));
    samples::add_object(plain, samples::square(), 1);
    samples::add_light(plain, {0.25, 0.5, 0});  // on the square
    SceneDescription doubled = plain;
    uint32_t copies = 0;
    for (ObjectDescription& object : doubled.objects)
        copies += put_copies(random, std::get<TrianglesObject>(object.shape));
    const auto expected = compile_scene<Real>(plain), compiled = compile_scene<Real>(doubled);
    expect_same_arrays(*compiled, *expected);
    EXPECT_TRUE(expected->warnings.empty()) << expected->warnings[0];
    ASSERT_EQ(compiled->warnings.size(), 4u);
    uint32_t counted = 0;
    for (const std::string& warning : compiled->warnings)
        counted += static_cast<uint32_t>(std::stoul(warning.substr(warning.find("merged ") + 7)));
    EXPECT_EQ(counted, copies);
}

TEST(DoubledFaces, LeaveNoTraceInTheCompiledScene) {
    for (uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        expect_no_trace<float>(seed);
        expect_no_trace<double>(seed);
        if (HasFailure()) break;
    }
}

}  // namespace
}  // namespace cistula
