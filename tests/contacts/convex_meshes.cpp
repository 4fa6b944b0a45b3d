// Meshes that are given by planes, read from files: what they show, throw and bend is what the same solids do that are
// built in, or the same meshes that keep their triangles.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "testing/support/pictures/film_of_all.h"
#include "testing/support/scratch_directory.h"

namespace cistula {
namespace {

using test::dvec3;
using test::film_of_all;
using test::share_apart;

/// Rays that rounding sends past an edge on the other side, as a share of all pixels.
constexpr double largest_share_apart = 0.002;

/// Pixels of which the first samples meet different objects, or surfaces whose normals or depths are apart.
size_t layers_apart(const Film& a, const Film& b) {
    size_t apart = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        const PixelRecord &p = a.pixels[i], &q = b.pixels[i];
        double off = p.z == q.z ? 0 : std::abs(p.z - q.z);
        for (int k = 0; k < 3; ++k) off = std::max<double>(off, std::abs(p.normal[k] - q.normal[k]));
        apart += p.id != q.id || off > 1e-4;
    }
    return apart;
}

std::string ply(const std::vector<dvec3>& vertices, const std::vector<std::vector<uint32_t>>& faces) {
    std::string text =
        fmt::format("ply\nformat ascii 1.0\nelement vertex {}\n", vertices.size()) +
        "property double x\nproperty double y\nproperty double z\n" +
        fmt::format("element face {}\nproperty list uchar int vertex_indices\nend_header\n", faces.size());
    for (const dvec3& p : vertices) text += fmt::format("{:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
    for (const auto& face : faces) text += fmt::format("{} {}\n", face.size(), fmt::join(face, " "));
    return text;
}

/// A solid of radius sqrt(3), so that the numbers of a cube are exact.
std::string ply_of(PlatonicSolid solid) {
    const Polyhedron& shape = platonic_shape(solid);
    std::vector<dvec3> vertices;
    for (const dvec3& p : shape.vertices) vertices.push_back(p * std::sqrt(3.0));
    std::vector<std::vector<uint32_t>> faces;
    for (const auto& face : shape.faces) faces.push_back(face.vertices);
    return ply(vertices, faces);
}

std::string frustum() {
    return ply({{-1, -1, -1},
                {1, -1, -1},
                {1, 1, -1},
                {-1, 1, -1},
                {-0.5, -0.5, 1},
                {0.5, -0.5, 1},
                {0.5, 0.5, 1},
                {-0.5, 0.5, 1}},
               {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

std::string wedge() {
    return ply({{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {0.25, -1, 1}, {0.25, 1, 1}},
               {{0, 3, 2, 1}, {0, 1, 4}, {2, 3, 5}, {1, 2, 5, 4}, {3, 0, 4, 5}});
}

/// What a body is made of, where it is and how it is turned.
struct BoxPlace {
    const char* name;
    dvec3 rotation;
    dvec3 center;
};

/// A floor of tiles and a wall, a light in front and one above.
SceneDescription lit_room() {
    SceneDescription scene;
    scene.film.width = 96, scene.film.height = 72;
    scene.depth = 8;
    scene.ambient = dvec3(0.3);
    scene.background = {0.2, 0.4, 0.7};
    const int paper = test::add_material(scene);
    MaterialDescription& glass = scene.materials[size_t(test::add_material(scene, 0, 1, dvec3(1), 1.5))];
    glass.fresnel = true;
    glass.absorption = {0.1, 0.3, 0.5};
    test::add_material(scene, 0.4, 0.3, {0.9, 0.6, 0.4});
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            if ((i + j) % 2 == 0) continue;
            TrianglesObject tile;
            const double x = i - 4, y = j - 4;
            tile.vertices = {{x, y, -1}, {x + 1, y, -1}, {x + 1, y + 1, -1}, {x, y + 1, -1}};
            tile.triangles = {{0, 1, 2}, {0, 2, 3}};
            test::add_object(scene, tile, paper);
        }
    test::add_light(scene, {3, -4, 5});
    test::add_light(scene, {-2, -1, 4});
    scene.camera.position = {1.3, -5.5, 2.1};
    scene.camera.target = {0, 0, -0.2};
    scene.camera.field_of_view = 45;
    return scene;
}

template <class Real>
class ConvexMeshes : public testing::Test {
  protected:
    const ScratchDirectory scratch_;

    MeshObject mesh(const std::string& text, const BoxPlace& place, double scale, bool keep_triangles = false) const {
        const std::string name = scratch_.file("body.ply");
        put_bytes(name, text);
        MeshObject object;
        object.file = name;
        object.center = place.center;
        object.rotation = place.rotation;
        object.scale = scale;
        object.keep_triangles = keep_triangles;
        return object;
    }

    /// The film of the room with a body of one of its materials; whether the body is given by planes.
    static Film film(const decltype(ObjectDescription::shape)& body, int material, bool by_planes) {
        SceneDescription scene = lit_room();
        test::add_object(scene, body, material);
        const auto compiled = test::compile<Real>(scene);
        EXPECT_EQ(compiled->solids.back().kind == SolidKind::convex, by_planes);
        return film_of_all<Real>(scene);
    }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ConvexMeshes, Reals);

const BoxPlace box_places[] = {{"on the floor", dvec3(0), {0, 0, -1 + 0.57735026918962584}},
                               {"in the air", {31, 47, 11}, {0.1, 0.2, 0.3}},
                               {"through the floor", {20, 0, 40}, {0, 0, -1}}};

TYPED_TEST(ConvexMeshes, LookLikeTheSolidsThatAreBuiltIn) {
    for (const PlatonicSolid kind : {PlatonicSolid::cube, PlatonicSolid::icosahedron, PlatonicSolid::tetrahedron})
        for (const BoxPlace& place : box_places)
            for (int material = 0; material < 3; ++material) {
                SolidObject solid;
                solid.solid = kind;
                solid.center = place.center;
                solid.rotation = place.rotation;
                const Film built_in = this->film(solid, material, true);
                const Film film = this->film(this->mesh(ply_of(kind), place, 1 / std::sqrt(3.0)), material, true);
                SCOPED_TRACE(fmt::format("{} {}, material {}", platonic_name(kind), place.name, material));
                EXPECT_LE(share_apart(film, built_in), largest_share_apart);
                EXPECT_LE(layers_apart(film, built_in), 4u);
            }
}

TYPED_TEST(ConvexMeshes, LookLikeTheirTriangles) {
    for (const auto& [name, text] : {std::pair("frustum", frustum()), std::pair("wedge", wedge())})
        for (const BoxPlace& place : {BoxPlace{"raised", dvec3(0), {0, 0, 0.125}}, box_places[1], box_places[2]})
            for (int material = 0; material < 3; ++material) {
                const Film triangles = this->film(this->mesh(text, place, 1, true), material, false);
                const Film film = this->film(this->mesh(text, place, 1), material, true);
                SCOPED_TRACE(fmt::format("{} {}, material {}", name, place.name, material));
                EXPECT_LE(share_apart(film, triangles), largest_share_apart);
                EXPECT_LE(layers_apart(film, triangles), 4u);
            }
}

/// A cube whose numbers are exact has the planes of the solid, bit for bit, and so all else.
TYPED_TEST(ConvexMeshes, AnExactCubeIsTheSolid) {
    SceneDescription scene = lit_room();
    SolidObject solid;
    solid.solid = PlatonicSolid::cube;
    solid.radius = std::sqrt(3.0) / 2;
    solid.center = {0, 0, -0.5};
    test::add_object(scene, solid, 1);
    const Film built_in = film_of_all<TypeParam>(scene);
    TrianglesObject mesh;
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5})
            for (const double z : {-1.0, 0.0}) mesh.vertices.push_back({x, y, z});
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                      {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    scene.objects.back().shape = mesh;
    EXPECT_EQ(record_hash(film_of_all<TypeParam>(scene)), record_hash(built_in));
}

}  // namespace
}  // namespace cistula
