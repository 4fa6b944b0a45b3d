// Which closed meshes are given by planes, and which planes (docs/rules.md, 3).
#include "scene/compile/solids/placed_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scene/compile/solids/compile_solids.h"
#include "testing/support/scene.h"
#include "verify/scenes/generated_scene.h"

namespace cistula {
namespace {

using test::dvec3;

TrianglesObject free_mesh(PlatonicSolid solid, double radius = 1, const dvec3& rotation = dvec3(0),
                          const dvec3& center = dvec3(0)) {
    TrianglesObject mesh = test::solid_mesh(solid, center, radius, rotation);
    mesh.keep_triangles = false;
    return mesh;
}

/// The cube from -1 to 1 along each axis.
TrianglesObject cube() {
    return free_mesh(PlatonicSolid::cube, std::sqrt(3.0));
}

/// A roof 2 wide, 2 long and `height` high: its two slopes meet at its ridge.
TrianglesObject wedge(double height) {
    TrianglesObject mesh;
    mesh.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, -1, height}, {0, 1, height}};
    mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {3, 5, 2}, {1, 2, 5}, {1, 5, 4}, {0, 4, 5}, {0, 5, 3}};
    return mesh;
}

/// The cube with faces cut into n x n squares.
TrianglesObject cut_cube(uint32_t n) {
    TrianglesObject mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            const auto first = static_cast<uint32_t>(mesh.vertices.size());
            for (uint32_t i = 0; i <= n; ++i)
                for (uint32_t j = 0; j <= n; ++j) {
                    dvec3 p;
                    p[axis] = side;
                    p[(axis + 1) % 3] = (2.0 * i - n) / n;
                    p[(axis + 2) % 3] = side * (2.0 * j - n) / n;
                    mesh.vertices.push_back(p);
                }
            for (uint32_t i = 0; i < n; ++i)
                for (uint32_t j = 0; j < n; ++j) {
                    const uint32_t a = first + i * (n + 1) + j, b = a + n + 1;
                    mesh.triangles.push_back({a, b, b + 1});
                    mesh.triangles.push_back({a, b + 1, a + 1});
                }
        }
    return mesh;
}

TrianglesObject joined(TrianglesObject mesh, const TrianglesObject& other) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& t : other.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    return mesh;
}

TrianglesObject scaled(TrianglesObject mesh, const dvec3& factor) {
    for (dvec3& p : mesh.vertices) p *= factor;
    return mesh;
}

template <class Real>
class ConvexMesh : public testing::Test {
  protected:
    static std::unique_ptr<CompiledScene<Real>> compiled(const TrianglesObject& mesh, bool textured = false) {
        SceneDescription scene;
        test::add_material(scene);
        if (textured) scene.textures.emplace_back(), scene.materials[0].texture = 0;
        test::add_object(scene, mesh, 0);
        scene.frame = FrameOfReference{dvec3(0), 0, {}};
        return test::compile<Real>(scene);
    }

    /// The number of slabs of a mesh, or 0 if it has triangles.
    static uint32_t slabs(const TrianglesObject& mesh) {
        const auto scene = compiled(mesh);
        const bool by_planes = scene->solids[0].kind == SolidKind::convex;
        EXPECT_EQ(scene->clusters.empty(), by_planes);
        EXPECT_EQ(scene->convex.size(), by_planes ? 1u : 0u);
        EXPECT_EQ((scene->effects & effect_triangles) == 0, by_planes);
        return by_planes ? scene->solids[0].slab_count : 0;
    }
    static bool by_planes(const TrianglesObject& mesh) { return slabs(mesh) > 0; }

    static constexpr double unit = RealTraits<float>::unit;  // by which faces are flat, in either precision
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ConvexMesh, Reals);

TYPED_TEST(ConvexMesh, PlatonicSolidsHaveTheirOwnPlanes) {
    for (const PlatonicSolid solid : test::platonic_solids)
        for (const dvec3& turn : {dvec3(0), dvec3(31, 47, 11)}) {
            SceneDescription description;
            test::add_object(description, free_mesh(solid, 1, turn), 0);
            const auto mesh = test::compile<TypeParam>(description);
            description.objects.clear();
            test::add_solid(description, solid, dvec3(0), 1, turn);
            const auto own = test::compile<TypeParam>(description);
            const auto planes = solid_planes(mesh->view(), mesh->solids[0]);
            const auto expected = solid_planes(own->view(), own->solids[0]);
            ASSERT_EQ(planes.size(), expected.size()) << platonic_name(solid);
            EXPECT_EQ(mesh->slabs.size(), own->slabs.size()) << platonic_name(solid);
            for (const SolidPlane& plane : planes) {
                double nearest = INFINITY;
                for (const SolidPlane& other : expected) {
                    const double off = length(plane.normal - other.normal) + magnitude(plane.offset - other.offset);
                    nearest = std::min(nearest, off);
                }
                EXPECT_LE(nearest, 8 * this->unit) << platonic_name(solid);
            }
        }
}

TYPED_TEST(ConvexMesh, ParallelFacesShareASlab) {
    EXPECT_EQ(this->slabs(cube()), 3u);
    EXPECT_EQ(this->slabs(free_mesh(PlatonicSolid::tetrahedron)), 4u);
    EXPECT_EQ(this->slabs(prism(4, 1.5, 0.5)), 5u);
    EXPECT_EQ(this->slabs(wedge(1)), 4u);
    EXPECT_EQ(this->slabs(prism(7)), 8u);
    EXPECT_EQ(this->slabs(prism(8)), 5u);
}

TYPED_TEST(ConvexMesh, HowAFaceIsCutDoesNotMatter) {
    EXPECT_EQ(this->slabs(cut_cube(2)), 3u);
    EXPECT_EQ(this->slabs(cut_cube(18)), 3u);
    EXPECT_FALSE(this->by_planes(cut_cube(19))) << "6 x 19 x 19 x 2 triangles are more than are looked at";
    TrianglesObject turned = cut_cube(5);
    for (dvec3& p : turned.vertices) p = dvec3(Vec3<float>(Rotation({31, 47, 11})(p) * 0.5));
    EXPECT_EQ(this->slabs(turned), 3u) << "rounded to float";
}

TYPED_TEST(ConvexMesh, NeitherDoWindingAndDoubledFaces) {
    TrianglesObject mesh = cube();
    for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
    EXPECT_EQ(this->slabs(mesh), 3u);
    const auto planes = solid_planes(this->compiled(mesh)->view(), this->compiled(mesh)->solids[0]);
    for (const SolidPlane& plane : planes) EXPECT_NEAR(plane.offset, 1, 4 * this->unit) << "turned inside out";
    TrianglesObject doubled = cube();
    for (const auto& t : cube().triangles) doubled.triangles.push_back({t[0], t[2], t[1]});
    const auto scene = this->compiled(doubled);
    EXPECT_EQ(scene->solids[0].kind, SolidKind::convex);
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_NE(scene->warnings[0].find("merged 12 faces"), std::string::npos) << scene->warnings[0];
}

/// A triangle without area along an edge on which one side has a vertex more.
TYPED_TEST(ConvexMesh, SealedEdgesAreEdges) {
    TrianglesObject mesh;
    mesh.vertices = {{-1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, 1, 1}, {1, -1, -1},
                     {1, -1, 1},   {1, 1, -1},  {1, 1, 1},   {1, 0, 1}};
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1}, {2, 3, 7},
                      {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 8}, {1, 8, 3}, {3, 8, 7}, {5, 7, 8}};
    EXPECT_EQ(this->slabs(mesh), 3u);
    mesh.triangles.pop_back();
    EXPECT_FALSE(this->by_planes(mesh)) << "it is open";
}

/// Pushed by less than the bound, a corner changes nothing. By more, the squares at it are bent: outward along the
/// diagonal on which they are cut, if it ends there, or inward. It takes all three to be convex.
TYPED_TEST(ConvexMesh, ACornerPushedInOrOutBendsFaces) {
    size_t meshes = 0;
    for (size_t corner = 0; corner < 8; ++corner) {
        size_t triangles = 0;  // 3 squares have one triangle there, or two if they are cut there
        for (const auto& t : cube().triangles) triangles += t[0] == corner || t[1] == corner || t[2] == corner;
        for (const int way : {-1, 1}) {
            TrianglesObject mesh = cube();
            mesh.vertices[corner] *= 1 + way * this->unit;
            EXPECT_EQ(this->slabs(mesh), 3u) << corner;
            mesh.vertices[corner] *= 1 + way * 64 * this->unit;
            const bool convex = triangles == (way > 0 ? 6u : 3u);
            EXPECT_EQ(this->by_planes(mesh), convex) << corner << " with " << triangles << " triangles, " << way;
            meshes += !convex;
        }
    }
    EXPECT_GE(meshes, 8u);
}

TYPED_TEST(ConvexMesh, WhatIsNotConvexStaysAMesh) {
    EXPECT_FALSE(this->by_planes(torus(0.7, 0.3, 12, 8)));
    EXPECT_FALSE(this->by_planes(star()));
    const TrianglesObject small = scaled(cube(), dvec3(0.25));
    TrianglesObject beside = small, inside_out = small, other_way = cube();
    for (dvec3& p : beside.vertices) p += dvec3(0.5, 0, 0);
    for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
    EXPECT_FALSE(this->by_planes(joined(scaled(cube(), dvec3(0.125)), beside))) << "two cubes side by side";
    EXPECT_FALSE(this->by_planes(joined(cube(), small))) << "one in another";
    EXPECT_FALSE(this->by_planes(joined(cube(), inside_out))) << "with a cavity";
    for (size_t i = 0; i < other_way.triangles.size(); i += 2) {  // a b c, a c d: the other diagonal
        const uint32_t a = other_way.triangles[i][0], b = other_way.triangles[i][1], c = other_way.triangles[i][2],
                       d = other_way.triangles[i + 1][2];
        other_way.triangles[i] = {a, b, d};
        other_way.triangles[i + 1] = {b, c, d};
    }
    EXPECT_EQ(this->slabs(other_way), 3u);
    EXPECT_EQ(this->slabs(joined(cube(), other_way)), 3u) << "twice the same, cut in two ways, is once the same";
}

TYPED_TEST(ConvexMesh, WhatPlanesReproduceBadlyStaysAMesh) {
    EXPECT_EQ(this->slabs(prism(62)), 32u);
    EXPECT_FALSE(this->by_planes(prism(64))) << "33 slabs";
    EXPECT_TRUE(this->by_planes(wedge(1.8)));
    EXPECT_TRUE(this->by_planes(wedge(0.3)));
    EXPECT_FALSE(this->by_planes(wedge(0.2))) << "11 degrees at the eaves";
    EXPECT_TRUE(this->by_planes(scaled(wedge(1), dvec3(0.2, 1, 1))));
    EXPECT_FALSE(this->by_planes(scaled(wedge(1), dvec3(0.1, 1, 1)))) << "11 degrees at the ridge";
    const double thin = 0x1p9 * RealTraits<double>::unit;
    EXPECT_TRUE(this->by_planes(scaled(cube(), {1, 1, 1.01 * thin})));
    EXPECT_FALSE(this->by_planes(scaled(cube(), {1, 1, 0.99 * thin})));
}

TYPED_TEST(ConvexMesh, WhatIsAskedToKeepItsTrianglesDoes) {
    TrianglesObject mesh = cube();
    mesh.keep_triangles = true;
    EXPECT_FALSE(this->by_planes(mesh));
    mesh.keep_triangles = false;
    mesh.uvs.assign(mesh.vertices.size(), {0, 0});
    EXPECT_TRUE(this->by_planes(mesh)) << "nothing shows the texture coordinates";
    EXPECT_EQ(this->compiled(mesh, true)->solids[0].kind, SolidKind::mesh) << "it has a texture";
}

/// Vertices rounded to float, as in most files, make flat faces in double, too.
TYPED_TEST(ConvexMesh, FlatnessIsThatOfFloatInBothPrecisions) {
    TrianglesObject mesh = free_mesh(PlatonicSolid::dodecahedron, 1, {31, 47, 11});
    for (dvec3& p : mesh.vertices) p = dvec3(Vec3<float>(p));
    EXPECT_EQ(this->slabs(mesh), 6u);
    TrianglesObject icosahedron = free_mesh(PlatonicSolid::icosahedron, 1, {31, 47, 11});
    for (dvec3& p : icosahedron.vertices) p = dvec3(Vec3<float>(p));
    EXPECT_TRUE(this->by_planes(icosahedron)) << "triangles are flat";
}

/// Whether a plane of a solid is within `tolerance` of a point.
bool near_a_plane(const std::vector<SolidPlane>& planes, const dvec3& p, double tolerance) {
    for (const SolidPlane& plane : planes)
        if (magnitude(dot(plane.normal, p) - plane.offset) <= tolerance) return true;
    return false;
}

/// A frustum on its small end, on a floor that slopes by as little as still counts as contact there. Its large end,
/// 32 times as large, does not follow.
TYPED_TEST(ConvexMesh, TheSideOppositeAContactStaysWhereItIs) {
    const double u = this->unit, slope = 8 * u / 0x1p-5;
    SceneDescription scene;
    TrianglesObject floor, frustum = prism(4, 0x1p-5, 1, 0.5);
    floor.vertices = {{-1, -1, -0.5 - slope}, {1, -1, -0.5 + slope}, {1, 1, -0.5 + slope}, {-1, 1, -0.5 - slope}};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    test::add_object(scene, floor, 0);
    test::add_object(scene, frustum, 0);
    scene.frame = FrameOfReference{dvec3(0), 0, {}};
    const auto compiled = test::compile<TypeParam>(scene);
    ASSERT_EQ(compiled->solids[1].kind, SolidKind::convex);
    ASSERT_EQ(compiled->shared_planes.size(), 1u);
    EXPECT_NE(compiled->shared_planes[0].normal.x, 0);
    const auto planes = solid_planes(compiled->view(), compiled->solids[1]);
    EXPECT_EQ(planes.size(), 6u);
    for (size_t i = 4; i < 8; ++i) {
        const dvec3 in_the_end = frustum.vertices[i] * dvec3(0.5, 0.5, 1);
        EXPECT_TRUE(near_a_plane(planes, in_the_end, 4 * u)) << i;
    }
}

/// However their faces are cut.
TYPED_TEST(ConvexMesh, PlanesOfAMeshMayTouchOthers) {
    SceneDescription scene;
    TrianglesObject floor;
    floor.vertices = {{-4, -4, -1}, {4, -4, -1}, {4, 4, -1}, {-4, 4, -1}};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    test::add_object(scene, floor, 0);
    test::add_object(scene, cut_cube(3), 0);
    const auto compiled = test::compile<TypeParam>(scene);
    ASSERT_EQ(compiled->solids[1].kind, SolidKind::convex);
    ASSERT_EQ(compiled->shared_planes.size(), 1u);
    EXPECT_EQ(compiled->shared_planes[0].solid_count, 1u);
    EXPECT_EQ(compiled->solids[1].slab_count, 3u);
    EXPECT_EQ(std::count(compiled->slab_planes.begin(), compiled->slab_planes.end(), 0u), 1);
}

TEST(ConvexMeshHash, IsThatOfTheMeshInBothPrecisions) {
    SceneDescription scene;
    TrianglesObject mesh = free_mesh(PlatonicSolid::dodecahedron, 1, {31, 47, 11});
    for (dvec3& p : mesh.vertices) p = dvec3(Vec3<float>(p));
    test::add_object(scene, mesh, 0);
    test::add_solid(scene, PlatonicSolid::cube, {4, 0, 0});
    const std::string hash = compile_scene<float>(scene)->hashes.of(0);
    EXPECT_EQ(compile_scene<double>(scene)->hashes.of(0), hash);
    std::get<TrianglesObject>(scene.objects[0].shape).keep_triangles = true;
    EXPECT_NE(compile_scene<float>(scene)->hashes.of(0), hash);
}

}  // namespace
}  // namespace cistula
