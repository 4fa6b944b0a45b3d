// Which way the pieces of a mesh face: by depth, whatever their winding (docs/rules.md, 2).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "pieces_of.h"
#include "scene/compile/scene_source.h"
#include "testing/support/scene.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

using test::dvec3;
using test::Random;

/// A shape about the origin, wound counter-clockwise seen from outside, within the unit ball.
struct Shape {
    std::vector<dvec3> vertices;
    std::vector<TriangleCorners> triangles;
    double inner;  // the radius of a ball about the origin inside
};

/// Pieces at known depths, which hide in one mesh.
struct Nested {
    TrianglesObject mesh;
    std::vector<uint32_t> first;  // of each piece's triangles, and their number
    std::vector<int> depth;
};

class Nest {
  public:
    explicit Nest(uint64_t seed) : random_(seed), shuffled_(random_.below(2) == 0) {}

    /// Up to three nests, moved by up to 1,000, with 7 to 9 or 17 digits.
    Nested make() {
        const double reach = random_.below(2) ? 0 : std::pow(10, random_.below(4));
        away_ = random_.in_cube(reach);
        const uint32_t nests = 1 + random_.below(3);
        for (uint32_t i = 0; i < nests; ++i) fill({2.5 * i, 0, 0}, random_.between(0.2, 1.2), 0);
        const int digits = random_.below(2) ? 17 : reach > 99 ? 9 : 7 + static_cast<int>(random_.below(3));
        for (dvec3& p : nested_.mesh.vertices)
            for (int axis = 0; axis < 3; ++axis) p[axis] = rounded(p[axis], digits);
        nested_.first.push_back(static_cast<uint32_t>(nested_.mesh.triangles.size()));
        return std::move(nested_);
    }

  private:
    static double rounded(double value, int digits) {
        char text[40];
        std::snprintf(text, sizeof text, "%.*g", digits, value);
        return std::strtod(text, nullptr);
    }
    Rotation turn() { return Rotation(random_.in_cube(180)); }

    static Shape shape_of(const TrianglesObject& mesh, double scale, double inner) {
        Shape shape{mesh.vertices, mesh.triangles, inner};
        for (dvec3& p : shape.vertices) p *= scale;
        return shape;
    }
    static Shape box(const dvec3& low, const dvec3& high) {
        Shape shape = shape_of(test::solid_mesh(PlatonicSolid::cube), std::sqrt(3.0), 0);
        for (dvec3& p : shape.vertices) p = 0.5 * (low + high) + p * 0.5 * (high - low);
        return shape;
    }
    Shape any_shape() {
        const uint32_t kind = random_.below(4);
        if (kind == 0) {
            const dvec3 half{random_.between(0.23, 0.577), random_.between(0.23, 0.577), random_.between(0.23, 0.577)};
            Shape shape = box(-half, half);
            shape.inner = std::min({half.x, half.y, half.z});
            return shape;
        }
        if (kind == 1) return shape_of(test::solid_mesh(PlatonicSolid::icosahedron), 1, 0.79);
        if (kind == 2) return bumpy();
        const TrianglesObject ring = torus(0.65, 0.33, 6 + random_.below(12), 4 + random_.below(6));
        Shape shape = shape_of(ring, 0.6, 0.09);
        // A point on its circle comes to the origin.
        for (dvec3& p : shape.vertices) p -= dvec3(0.39, 0, 0);
        return shape;
    }
    Shape bumpy() {
        Shape shape = shape_of(bumpy_sphere(random_.below(2) ? 80 : 320), 1, 0);
        for (dvec3& p : shape.vertices) p = normalized(p) * (1 - 0.3 * random_.unit());
        shape.inner = 0.5;
        return shape;
    }

    /// Adds a piece with its winding at random, and that of each of its triangles too where they are shuffled.
    void add(const Shape& shape, double radius, const dvec3& center, const Rotation& turned, int depth) {
        const auto first = static_cast<uint32_t>(nested_.mesh.vertices.size());
        nested_.first.push_back(static_cast<uint32_t>(nested_.mesh.triangles.size()));
        nested_.depth.push_back(depth);
        for (const dvec3& p : shape.vertices) nested_.mesh.vertices.push_back(turned(p * radius) + center + away_);
        const bool reversed = random_.below(2) == 0;
        for (TriangleCorners t : shape.triangles) {
            if (reversed != (shuffled_ && random_.below(2) == 0)) std::swap(t[1], t[2]);
            std::rotate(t.begin(), t.begin() + random_.below(3), t.end());
            nested_.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        }
    }

    /// Adds a piece within a ball, and others within it.
    void fill(const dvec3& center, double radius, int depth) {
        if (random_.below(5) == 0 && depth < 4 && radius > 0.05) return add_boxes(center, radius * 0.55, depth);
        const Shape shape = any_shape();
        add(shape, radius, center, turn(), depth);
        if (depth >= 6 || radius < 0.02 || nested_.depth.size() > 24) return;
        const double within = shape.inner * radius * 0.98;
        const uint32_t kids = random_.below(3);
        if (kids == 1) fill(center, within * random_.between(0.3, 1), depth + 1);
        if (kids == 2) {
            const dvec3 way = random_.direction() * (within * 0.52);
            fill(center + way, within * 0.47, depth + 1);
            fill(center - way, within * 0.47, depth + 1);
        }
    }

    /// Adds boxes of one frame that share faces, parts of faces, edges or corners.
    void add_boxes(const dvec3& center, double radius, int depth) {
        const Rotation turned = turn();
        const auto put = [&](const dvec3& low, const dvec3& high, int more) {
            add(box(low, high), radius, center, turned, depth + more);
        };
        switch (random_.below(6)) {
            case 0:  // in two corners of a box, touching in a vertex
                put(dvec3(-1), dvec3(1), 0);
                put(dvec3(-1), dvec3(0), 1);
                if (random_.below(2)) put(dvec3(0), {1, 1, 0.5}, 1);
                return;
            case 1:  // two that share a face, a hole in one
                put(dvec3(-1), {0, 1, 1}, 0);
                put({0, -1, -1}, dvec3(1), 0);
                put({-0.75, -0.5, -0.5}, {-0.25, 0.5, 0.5}, 1);
                return;
            case 2:  // two that share an edge, a hole flush with the top of one
                put(dvec3(-1), {0, 0, 1}, 0);
                put({0, 0, -1}, dvec3(1), 0);
                put({0.25, 0.25, -0.5}, {0.75, 0.75, 1}, 1);
                return;
            case 3:  // four, flush with one face
                for (int i = 0; i < 4; ++i) {
                    const double half = std::ldexp(1, -i);
                    put({-half, -half, -1}, {half, half, i == 0 ? 1 : half}, i);
                }
                return;
            case 4:  // cubes in a block
                put(dvec3(-1), dvec3(1), 0);
                for (int i = 0; i < 8; ++i) {
                    const dvec3 low{i & 1 ? 0.0 : -0.5, i & 2 ? 0.0 : -0.5, i & 4 ? 0.0 : -0.5};
                    if (random_.below(2)) put(low, low + 0.5, 1);
                }
                return;
            default:  // a thin lid, five faces flush
                put(dvec3(-1), dvec3(1), 0);
                put(dvec3(-1), {1, 1, 0.999}, 1);
        }
    }

    Random random_;
    const bool shuffled_;
    dvec3 away_{0};
    Nested nested_;
};

/// The triangles as they are rendered, by their numbers in the mesh; empty where they are left out: three equal
/// corners.
std::vector<TriangleCorners> rendered(const TrianglesObject& mesh, const MeshPieces& pieces) {
    std::vector<TriangleCorners> triangles(mesh.triangles.size(), TriangleCorners{0, 0, 0});
    for (size_t i = 0; i < pieces.source.size(); ++i) {
        TriangleCorners& t = triangles[pieces.source[i]] = mesh.triangles[pieces.source[i]];
        if (pieces.turned[i]) std::swap(t[1], t[2]);
    }
    return triangles;
}

/// Whether a piece's triangles are all there, face alike, and face as its depth says.
bool faces_right(const Nested& nested, const std::vector<TriangleCorners>& triangles, size_t piece) {
    const std::vector<dvec3>& vertices = nested.mesh.vertices;
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    const dvec3 origin = vertices[nested.mesh.triangles[nested.first[piece]][0]];
    double volume = 0;
    for (uint32_t i = nested.first[piece]; i < nested.first[piece + 1]; ++i) {
        const TriangleCorners& t = triangles[i];
        if (t[0] == t[1]) return false;
        for (size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
            edges[{a, b}] += t[k] < t[(k + 1) % 3] ? 1 : -1;
        }
        volume += dot(vertices[t[0]] - origin, cross(vertices[t[1]] - origin, vertices[t[2]] - origin));
    }
    const bool alike = std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second == 0; });
    return alike && (volume > 0) == (nested.depth[piece] % 2 == 0);
}

/// Gives vertices at one place one number.
void weld_all(TrianglesObject& mesh) {
    std::map<std::array<double, 3>, uint32_t> number;
    std::vector<dvec3> vertices;
    for (TriangleCorners& t : mesh.triangles)
        for (uint32_t& corner : t) {
            const dvec3& p = mesh.vertices[corner];
            const auto [known, is_new] = number.try_emplace({p.x, p.y, p.z}, static_cast<uint32_t>(vertices.size()));
            if (is_new) vertices.push_back(p);
            corner = known->second;
        }
    mesh.vertices = vertices;
}

constexpr uint64_t scenes = 500;

TEST(MeshPieces, FaceByTheirDepthHoweverTheyAreWound) {
    int deepest = 0;
    for (uint64_t seed = 0; seed < scenes; ++seed) {
        const Nested nested = Nest(seed).make();
        const MeshPieces found = pieces_of(nested.mesh);
        ASSERT_TRUE(found.closed) << seed << ": " << found.faults.why_not_closed();
        EXPECT_EQ(found.faults.passing, 0u) << seed;
        const auto triangles = rendered(nested.mesh, found);
        for (size_t i = 0; i < nested.depth.size(); ++i) {
            EXPECT_TRUE(faces_right(nested, triangles, i)) << seed << ": piece " << i << " at " << nested.depth[i];
            deepest = std::max(deepest, nested.depth[i]);
        }
    }
    EXPECT_GE(deepest, 5);
}

/// Where pieces share edges and are wound differently, their numbers no longer tell them apart.
TEST(MeshPieces, WeldedOnesDoSoOrAreSaidNotToBeClosed) {
    size_t closed = 0;
    for (uint64_t seed = 0; seed < scenes; ++seed) {
        Nested nested = Nest(seed).make();
        weld_all(nested.mesh);
        const MeshPieces found = pieces_of(nested.mesh);
        if (!found.closed) {
            EXPECT_GT(found.faults.crowded_edges, 0u) << seed;
            continue;
        }
        ++closed;
        const auto triangles = rendered(nested.mesh, found);
        for (size_t i = 0; i < nested.depth.size(); ++i)
            EXPECT_TRUE(faces_right(nested, triangles, i)) << seed << ": piece " << i << " at " << nested.depth[i];
    }
    EXPECT_GT(closed, scenes / 2);
}

TrianglesObject cube_at(const dvec3& center, double half = 1) {
    return test::solid_mesh(PlatonicSolid::cube, center, half * std::sqrt(3.0));
}

void append(TrianglesObject& mesh, const TrianglesObject& other) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const TriangleCorners& t : other.triangles)
        mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

TrianglesObject together(const std::vector<TrianglesObject>& all) {
    TrianglesObject mesh;
    for (const TrianglesObject& one : all) append(mesh, one);
    return mesh;
}

TEST(MeshBodies, AreSolidsOfTheirOwnWhereTheyMeet) {
    const auto solids = [](const dvec3& second) {
        return pieces_of(together({cube_at({0, 0, 0}), cube_at(second)})).thickness.size();
    };
    EXPECT_EQ(solids({2, 0, 0}), 2u) << "a common face";
    EXPECT_EQ(solids({2, 2, 0}), 2u) << "a common edge";
    EXPECT_EQ(solids({2, 2, 2}), 2u) << "a common corner";
    EXPECT_EQ(solids({1, 0.5, 0.5}), 2u) << "an overlap";
    EXPECT_EQ(solids({2 + 1e-4, 0, 0}), 2u) << "what may be a contact";
    EXPECT_EQ(solids({2.01, 0, 0}), 1u);
    EXPECT_EQ(
        pieces_of(together({cube_at({0, 0, 0}), cube_at({9, 0, 0}), cube_at({11, 0, 0}), cube_at({0, 9, 0})})).solid,
        [] {
            std::vector<uint32_t> expected(48, 0);
            std::fill_n(expected.begin() + 12, 12, 1);
            std::fill_n(expected.begin() + 24, 12, 2);
            return expected;
        }());
}

/// Cubes with common vertices: around their common edges there are more than two triangles.
TEST(MeshBodies, AreToldApartAtCommonEdges) {
    for (const dvec3& second : {dvec3(2, 0, 0), dvec3(2, 2, 0), dvec3(2, 2, 2)}) {
        TrianglesObject mesh = together({cube_at({0, 0, 0}), cube_at(second)});
        for (dvec3& p : mesh.vertices) p = dvec3(std::round(p.x), std::round(p.y), std::round(p.z));
        weld_all(mesh);
        EXPECT_LT(mesh.vertices.size(), 16u);
        const MeshPieces found = pieces_of(mesh);
        EXPECT_TRUE(found.closed) << found.faults.why_not_closed();
        EXPECT_EQ(found.source.size(), 24u);
        EXPECT_EQ(found.thickness.size(), 2u);
    }
}

TEST(MeshBodies, HaveTheirHolesAndWhatIsInThese) {
    const MeshPieces found =
        pieces_of(together({cube_at({0, 0, 0}), cube_at({0.25, 0, 0.5}, 0.5), cube_at({0.25, 0, 0.5}, 0.25)}));
    ASSERT_EQ(found.thickness.size(), 1u);
    EXPECT_NEAR(found.thickness[0], 0.125 / 1.5, 1e-15) << "that of the innermost";
    // A second body meets the first: its hole goes with it.
    const MeshPieces two = pieces_of(together({cube_at({0, 0, 0}, 0.5), cube_at({2, 0, 0}), cube_at({0, 0, 0})}));
    EXPECT_EQ(two.thickness.size(), 2u);
    EXPECT_EQ(two.solid[0], two.solid[24]);
    EXPECT_NEAR(two.thickness[two.solid[0]], 7.0 / 30, 1e-15);
    EXPECT_NEAR(two.thickness[two.solid[12]], 8.0 / 24, 1e-15);
}

TEST(MeshBodies, ThatPassThroughOneAnotherHaveNoHoles) {
    const MeshPieces found = pieces_of(together({cube_at({0, 0, 0}), cube_at({0.5, 0, 0}, 0.75)}));
    EXPECT_EQ(found.thickness.size(), 2u);
    EXPECT_EQ(std::count(found.turned.begin(), found.turned.end(), 1), 0);
    // Boxes partly in the tube of a ring, and within its box.
    uint32_t passing = 0;
    for (const double x : {0.65, 0.7, 0.8}) {
        TrianglesObject box = cube_at({0, 0, 0}, 0.125);
        for (dvec3& p : box.vertices) p.x = 1.25 * p.x + x;
        const MeshPieces half = pieces_of(together({torus(1, 0.3, 64, 32), box}));
        EXPECT_EQ(std::count(half.turned.begin(), half.turned.end(), 1), 0) << x;
        EXPECT_EQ(half.thickness.size(), 2u) << x;
        passing += half.faults.passing;
    }
    EXPECT_GT(passing, 0u);
}

/// Cubes on all faces of one that come first, and a face that is there once more.
TEST(MeshBodies, ThatOthersSurroundFaceByFaceStay) {
    std::vector<TrianglesObject> cubes;
    for (int axis = 0; axis < 3; ++axis)
        for (const double way : {-2, 2}) {
            dvec3 center(0);
            center[axis] = way;
            cubes.push_back(cube_at(center));
        }
    cubes.push_back(cube_at(dvec3(0)));
    cubes.push_back(cube_at({2, 0, 0}));
    cubes.back().triangles.resize(1);
    const MeshPieces found = pieces_of(together(cubes));
    EXPECT_TRUE(found.closed);
    EXPECT_EQ(found.source.size(), 7u * 12);
    EXPECT_EQ(found.thickness.size(), 7u);
    EXPECT_EQ(found.faults.doubled, 1u);
}

TEST(MeshBodies, CopiesAreMerged) {
    TrianglesObject other_way = cube_at({0, 0, 0});
    for (size_t i = 0; i < 12; i += 2) {  // a b c, a c d: the other diagonal, and the other winding
        const auto [a, b, c] = other_way.triangles[i];
        const uint32_t d = other_way.triangles[i + 1][2];
        other_way.triangles[i] = {a, d, b};
        other_way.triangles[i + 1] = {b, d, c};
    }
    const MeshPieces found =
        pieces_of(together({cube_at({0, 0, 0}), other_way, cube_at({4, 0, 0}), cube_at({0, 0, 0})}));
    EXPECT_TRUE(found.closed);
    EXPECT_EQ(found.faults.doubled, 24u);
    EXPECT_EQ(found.source.size(), 24u);
}

TEST(MeshBodies, FlatPiecesAreLeftOutBesideOthersAndSheetsAlone) {
    TrianglesObject card;
    card.vertices = {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}};
    card.triangles = {{0, 1, 2}, {0, 2, 1}};
    const MeshPieces both = pieces_of(together({cube_at({0, 0, 0}), card}));
    EXPECT_TRUE(both.closed);
    EXPECT_EQ(both.source.size(), 12u);
    EXPECT_EQ(both.faults.left_out(), "left out 1 closed piece without a volume");
    const MeshPieces alone = pieces_of(card);
    EXPECT_FALSE(alone.closed);
    EXPECT_EQ(alone.source.size(), 1u);
}

TEST(MeshBodies, SurfacesWithOneSideAreSheets) {
    constexpr uint32_t n = 12;  // a Klein bottle: the second way about runs backward after the first
    TrianglesObject bottle;
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j) {
            const double u = 2 * M_PI * i / n, v = 2 * M_PI * j / n;
            const double r = 2 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
            bottle.vertices.push_back(
                {r * std::cos(u), r * std::sin(u), std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v)});
        }
    const auto at = [](uint32_t i, uint32_t j) { return i < n ? i * n + j % n : (n - j % n) % n; };
    for (uint32_t i = 0; i < n; ++i)
        for (uint32_t j = 0; j < n; ++j) {
            bottle.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            bottle.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    const MeshPieces found = pieces_of(bottle);
    EXPECT_FALSE(found.closed);
    EXPECT_EQ(found.faults.why_not_closed(), "its two sides are one, as a Klein bottle's");
    EXPECT_EQ(found.source.size(), bottle.triangles.size());
}

/// Solids of one mesh have its name, place and material.
TEST(MeshBodies, ShareTheObjectsName) {
    SceneDescription scene;
    test::add_object(scene, cube_at({9, 0, 0}), 0);
    test::add_object(scene, together({cube_at({0, 0, 0}), cube_at({2, 0, 0})}), test::add_material(scene));
    const SceneSource source = gather_scene(scene);
    ASSERT_EQ(source.solids.size(), 3u);
    for (size_t i = 1; i < 3; ++i) {
        EXPECT_EQ(source.solids[i].name, "o1");
        EXPECT_EQ(source.solids[i].place, "/objects/1");
        EXPECT_EQ(source.solids[i].material, 1u);
        EXPECT_EQ(source.solids[i].body, i - 1);
        EXPECT_EQ(source.solids[i].mesh.vertices.size(), 8u);
        EXPECT_EQ(source.solids[i].mesh.triangles.size(), 12u);
    }
    EXPECT_EQ(test::compile<float>(scene)->solids.size(), 3u);
}

}  // namespace
}  // namespace cistula
