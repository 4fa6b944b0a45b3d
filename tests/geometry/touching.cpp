// Bodies that share a face pass light from one index straight to the other: no gap of air, no face shaded twice,
// whichever comes first in the file, as planes and as meshes whose shared faces are cut along different diagonals.
#include <gtest/gtest.h>

#include "testing/support/golden.h"
#include "testing/support/scene.h"

using namespace cistula;
using test::dvec3;

namespace {

const dvec3 turn(20, 35, 50);

/// The box [x0, x1] x [-1/2, 1/2]^2, turned. Side 0 and 1 cut its faces along different diagonals.
TrianglesObject box_mesh(double x0, double x1, bool other_diagonal) {
    const Rotation rotation(turn);
    TrianglesObject mesh;
    mesh.keep_triangles = true;
    for (const double x : {x0, x1})
        for (const double y : {-0.5, 0.5})
            for (const double z : {-0.5, 0.5}) mesh.vertices.push_back(rotation(dvec3(x, y, z)));
    const uint32_t quads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (const auto& q : quads) {
        if (other_diagonal) {
            mesh.triangles.push_back({q[0], q[1], q[3]});
            mesh.triangles.push_back({q[1], q[2], q[3]});
        } else {
            mesh.triangles.push_back({q[0], q[1], q[2]});
            mesh.triangles.push_back({q[0], q[2], q[3]});
        }
    }
    return mesh;
}

enum class Shape { planes, mesh };

SceneDescription floor_and_light() {
    SceneDescription scene;
    scene.frame = FrameOfReference{{0, 0, 0}, -3, 64.0};
    scene.camera.position = {3.3, -2.1, 2.2};
    scene.camera.field_of_view = 35;
    scene.depth = 12;
    scene.ambient = dvec3(0.3);
    TextureDescription checker;
    checker.name = "checker";
    checker.checker = {dvec3(0.9), dvec3(0.1)};
    checker.repeat = {8, 8};
    scene.textures.push_back(checker);
    test::add_material(scene);
    scene.materials[0].texture = 0;
    TrianglesObject quad;
    quad.vertices = {{-4, -4, -2}, {4, -4, -2}, {4, 4, -2}, {-4, 4, -2}};
    quad.triangles = {{0, 1, 2}, {0, 2, 3}};
    quad.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    test::add_object(scene, quad, 0);
    test::add_light(scene, {3, -3, 5});
    return scene;
}

void add_box(SceneDescription& scene, Shape shape, bool right, int material) {
    const double middle = right ? 0.5 : -0.5;
    if (shape == Shape::planes)
        test::add_solid(scene, PlatonicSolid::cube, Rotation(turn)(dvec3(middle, 0, 0)), square_root(0.75), turn,
                        material);
    else
        test::add_object(scene, box_mesh(middle - 0.5, middle + 0.5, right), material);
}

template <class Real>
Film film_of(const SceneDescription& scene) {
    FrameSettings settings = golden::settings_for(scene);
    const auto renderer = make_embree_renderer<Real>(compile_scene<Real>(scene));
    Film film;
    RenderProgress progress;
    renderer->render(camera_at(scene.camera, 0), settings, film, progress);
    EXPECT_EQ(film.flags, 0u);
    return film;
}

/// Pixels that differ by more than half of 1/255.
size_t apart(const Film& a, const Film& b) {
    const ColorPicture x = to_color(a), y = to_color(b);
    size_t count = 0;
    for (size_t i = 0; i < x.texels.size(); ++i) {
        const glm::vec3 d = x.texels[i] - y.texels[i];
        count += magnitude(d.x) > 0.5f / 255 || magnitude(d.y) > 0.5f / 255 || magnitude(d.z) > 0.5f / 255;
    }
    return count;
}

/// Rays that rounding sends past an edge on the other side; of 57,600 pixels, most of them with glass.
template <class Real>
constexpr size_t past_edges = sizeof(Real) == sizeof(float) ? 12 : 0;

template <class Real>
class Touching : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Touching, Reals);

TYPED_TEST(Touching, ClearHalvesAreOneBody) {
    SceneDescription whole = floor_and_light();
    const int glass = test::add_material(whole, 0, 1, dvec3(1), 1.5);
    SceneDescription halves = whole;
    test::add_object(whole, box_mesh(-1, 1, false), glass);
    const Film expected = film_of<TypeParam>(whole);
    for (const Shape shape : {Shape::planes, Shape::mesh})
        for (const bool right_first : {false, true}) {
            SceneDescription scene = halves;
            add_box(scene, shape, right_first, glass);
            add_box(scene, shape, !right_first, glass);
            EXPECT_LE(apart(film_of<TypeParam>(scene), expected), past_edges<TypeParam>)
                << (shape == Shape::mesh ? "meshes" : "planes") << ", the " << (right_first ? "right" : "left")
                << " one first";
        }
    SceneDescription mixed = halves;
    add_box(mixed, Shape::mesh, false, glass);
    add_box(mixed, Shape::planes, true, glass);
    EXPECT_LE(apart(film_of<TypeParam>(mixed), expected), past_edges<TypeParam>) << "a mesh and planes";
}

TYPED_TEST(Touching, ASharedFaceIsShadedOnce) {
    for (const double index : {1.0, 1.5}) {
        SceneDescription empty = floor_and_light();
        const int tinted = test::add_material(empty, 0, 0.95, dvec3(0.9, 1, 0.9), index);
        std::vector<Film> films;
        for (const Shape shape : {Shape::planes, Shape::mesh})
            for (const bool right_first : {false, true}) {
                SceneDescription scene = empty;
                add_box(scene, shape, right_first, tinted);
                add_box(scene, shape, !right_first, tinted);
                films.push_back(film_of<TypeParam>(scene));
            }
        for (size_t i = 1; i < films.size(); ++i)
            EXPECT_LE(apart(films[0], films[i]), past_edges<TypeParam>) << "index " << index << ", variant " << i;
    }
}

/// An opaque box and its twin in the same place, as planes and as a mesh, in either order: the later one is shaded, and
/// the other must not shadow it.
TYPED_TEST(Touching, ATwinCastsNoShadowOnItsTwin) {
    SceneDescription empty = floor_and_light();
    const int opaque = test::add_material(empty);
    for (const Shape later : {Shape::planes, Shape::mesh}) {
        SceneDescription alone = empty;
        add_box(alone, later, true, opaque);
        const Film expected = film_of<TypeParam>(alone);
        for (const Shape earlier : {Shape::planes, Shape::mesh}) {
            SceneDescription twins = empty;
            add_box(twins, earlier, true, opaque);
            add_box(twins, later, true, opaque);
            EXPECT_LE(apart(film_of<TypeParam>(twins), expected), past_edges<TypeParam>)
                << (earlier == Shape::mesh ? "a mesh" : "planes") << " under "
                << (later == Shape::mesh ? "a mesh" : "planes");
        }
    }
}

/// Glass that stands on an opaque box shows the box's face, whichever comes later in the file.
TYPED_TEST(Touching, AnOpaqueBodyUnderGlassIsSeenInEitherOrder) {
    SceneDescription empty = floor_and_light();
    const int opaque = test::add_material(empty);
    const int glass = test::add_material(empty, 0, 1, dvec3(1), 1.5);
    std::vector<Film> films;
    for (const bool glass_first : {false, true}) {
        SceneDescription scene = empty;
        add_box(scene, Shape::planes, glass_first, glass_first ? glass : opaque);
        add_box(scene, Shape::planes, !glass_first, glass_first ? opaque : glass);
        films.push_back(film_of<TypeParam>(scene));
        SceneDescription other = empty;  // left and right exchanged: what is where must not matter
        add_box(other, Shape::planes, !glass_first, glass_first ? glass : opaque);
        add_box(other, Shape::planes, glass_first, glass_first ? opaque : glass);
        films.push_back(film_of<TypeParam>(other));
    }
    EXPECT_LE(apart(films[0], films[2]), past_edges<TypeParam>);
    EXPECT_LE(apart(films[1], films[3]), past_edges<TypeParam>);
}

}  // namespace
