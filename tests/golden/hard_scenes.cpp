// What must hold of the pictures of scenes/hard, whatever their golden images say: what is not there is not seen, what
// is the same looks the same, and pictures that can be known are those.
#include <gtest/gtest.h>

#include "testing/support/golden.h"
#include "testing/support/shipped_scenes.h"

using namespace cistula;

namespace {

SceneDescription load(const std::string& name) {
    return test::shipped_scene("hard/" + name);
}

bool begins(const std::string& text, const char* with) {
    return text.rfind(with, 0) == 0;
}

/// Leaves out the objects whose names begin with this; how many.
size_t drop(SceneDescription& scene, const char* name) {
    return std::erase_if(scene.objects, [&](const ObjectDescription& object) { return begins(object.name, name); });
}

SolidObject cube(const glm::dvec3& center, double half, const glm::dvec3& rotation = glm::dvec3(0)) {
    SolidObject solid;
    solid.solid = PlatonicSolid::cube;
    solid.center = center;
    solid.radius = std::sqrt(3.0) * half;
    solid.rotation = rotation;
    return solid;
}

template <class Real>
class HardScenes : public ::testing::Test {
  protected:
    static Film render(const SceneDescription& scene) {
        const Film film = golden::render_embree<Real>(scene);
        EXPECT_EQ(film.flags, 0u);
        return film;
    }

    /// Pixels of which two films differ in a bit of the radiance, the ledger, the distance or the normal.
    static size_t differing(const Film& a, const Film& b) {
        EXPECT_EQ(a.pixels.size(), b.pixels.size());
        EXPECT_EQ(a.fixed_shift, b.fixed_shift);
        EXPECT_EQ(a.radiance_exponent, b.radiance_exponent);
        size_t count = 0;
        for (size_t i = 0; i < a.pixels.size(); ++i) {
            const PixelRecord &p = a.pixels[i], &q = b.pixels[i];
            const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
            count += !same(p.radiance, q.radiance) || !same(p.cut, q.cut) || !same(p.pruned, q.pruned) ||
                     !same(p.z, q.z) || !same(p.normal, q.normal);
        }
        return count;
    }

    /// Share of pixels that differ by more than half of 1/255 in some channel.
    static double share_apart(const Film& a, const Film& b) {
        const ColorPicture x = to_color(a), y = to_color(b);
        size_t count = 0;
        for (size_t i = 0; i < x.texels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                if (std::abs(x.texels[i][c] - y.texels[i][c]) > 0.5f / 255) {
                    ++count;
                    break;
                }
        return double(count) / double(x.texels.size());
    }

    /// Rays that rounding sends past an edge on the other side.
    static constexpr double largest_share_apart = 0.002;
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(HardScenes, Reals);

TYPED_TEST(HardScenes, SolidsOfIndexOneAreNotThere) {
    SceneDescription scene = load("index-one");
    const Film with = this->render(scene);
    EXPECT_EQ(drop(scene, "nothing"), 4u);
    EXPECT_EQ(this->differing(with, this->render(scene)), 0u);
}

TYPED_TEST(HardScenes, MediaOfMeshesLookLikeThoseOfPlanes) {
    EXPECT_LE(this->share_apart(this->render(load("media")), this->render(load("media-meshes"))),
              this->largest_share_apart);
}

/// The scenes of which meshes keep triangles that planes could reproduce.
TYPED_TEST(HardScenes, PlanesOfMeshesLookLikeTheirTriangles) {
    for (const char* name : {"media-meshes", "slivers", "closed-box", "degenerate"}) {
        SceneDescription scene = load(name);
        const Film triangles = this->render(scene);
        const size_t convex = compile_scene<TypeParam>(scene)->convex.size();
        for (ObjectDescription& object : scene.objects) {
            if (auto* list = std::get_if<TrianglesObject>(&object.shape)) list->keep_triangles = false;
            if (auto* mesh = std::get_if<MeshObject>(&object.shape)) mesh->keep_triangles = false;
        }
        EXPECT_GT(compile_scene<TypeParam>(scene)->convex.size(), convex) << name;
        EXPECT_LE(this->share_apart(triangles, this->render(scene)), this->largest_share_apart) << name;
    }
}

TYPED_TEST(HardScenes, EightPartsOfAGlassLookLikeOne) {
    SceneDescription scene = load("media");
    const Film parts = this->render(scene);
    ObjectDescription whole = scene.objects.back();
    whole.shape = cube({3.75, -0.5, 0.75}, 0.75);
    EXPECT_EQ(drop(scene, "part"), 8u);
    EXPECT_GT(this->share_apart(parts, this->render(scene)), 0.03) << "they are hardly in view";
    scene.objects.push_back(whole);
    EXPECT_LE(this->share_apart(parts, this->render(scene)), this->largest_share_apart);
}

TYPED_TEST(HardScenes, BoxesOfStripsLookLikeBoxes) {
    SceneDescription scene = load("slivers");
    const Film strips = this->render(scene);
    int boxes = 0;
    for (ObjectDescription& object : scene.objects) {
        const auto* mesh = std::get_if<MeshObject>(&object.shape);
        if (!mesh) continue;
        object.shape = cube(mesh->center, mesh->scale, mesh->rotation);
        ++boxes;
    }
    EXPECT_EQ(boxes, 2);
    EXPECT_LE(this->share_apart(strips, this->render(scene)), this->largest_share_apart);
}

TYPED_TEST(HardScenes, NoLightLeavesClosedSolids) {
    const Film film = this->render(load("closed-box"));
    size_t red = 0, lit = 0;
    for (const PixelRecord& pixel : film.pixels) {
        red += pixel.radiance[0] != 0;
        lit += pixel.radiance[2] != 0;
    }
    EXPECT_EQ(red, 0u);
    EXPECT_EQ(lit, film.pixels.size());
}

/// Picture and ledger are 1 together, in integers.
TYPED_TEST(HardScenes, AFurnaceLosesWhatItsLedgerSays) {
    const Film film = this->render(load("furnace"));
    ASSERT_EQ(film.fixed_shift, 62);
    ASSERT_EQ(film.radiance_exponent, 1);  // the bound is 1 + 2^-10
    constexpr int64_t whole = int64_t{1} << 61, bound = whole + (whole >> 10);
    size_t wrong = 0, cut = 0;
    for (const PixelRecord& pixel : film.pixels)
        for (int c = 0; c < 3; ++c) {
            const int64_t missing = whole - pixel.radiance[c];
            wrong += missing < 0 || pixel.pruned[c] != 0 || __int128{missing} * bound != __int128{pixel.cut[c]} * whole;
            cut += missing > 0;
        }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(cut, film.pixels.size() / 2) << "hardly a solid is in view";
}

TYPED_TEST(HardScenes, CopiesAndTrianglesWithoutAreaAreNotSeen) {
    SceneDescription scene = load("degenerate");
    const Film with = this->render(scene);
    EXPECT_EQ(drop(scene, "again"), 3u);
    EXPECT_EQ(drop(scene, "flat"), 1u);
    EXPECT_LE(this->share_apart(with, this->render(scene)), this->largest_share_apart);
}

/// The faces that come first make the same meshes alone.
TYPED_TEST(HardScenes, DoubledFacesAreSeenOnce) {
    SceneDescription scene = load("doubled");
    const Film with = this->render(scene);
    const auto triangles = [&](size_t object) -> auto& {
        return std::get<TrianglesObject>(scene.objects[object].shape).triangles;
    };
    ASSERT_EQ(triangles(1).size(), 48u);
    for (size_t i = 0; i < 24; ++i) triangles(1)[i] = triangles(1)[2 * i];
    triangles(1).resize(24);
    ASSERT_EQ(triangles(2).size(), 32u);
    triangles(2).resize(16);
    EXPECT_TRUE(compile_scene<TypeParam>(scene)->warnings.empty());
    EXPECT_EQ(this->differing(with, this->render(scene)), 0u);
}

TYPED_TEST(HardScenes, HugeAndTinyAreOnePicture) {
    const Film huge = this->render(load("huge"));
    Film tiny = this->render(load("tiny"));
    for (size_t i = 0; i < tiny.pixels.size(); ++i)
        tiny.pixels.change(i, [](PixelRecord& pixel) { pixel.z *= 0x1p80f; });
    EXPECT_EQ(this->differing(huge, tiny), 0u);
}

/// A ray in the cube has the same components, but for signs, however often it is reflected; it gets out where one of
/// them is more than the cosine of the critical angle.
TYPED_TEST(HardScenes, BeyondTheCriticalAngleOfAllFacesNothingIsSeen) {
    const SceneDescription scene = load("critical-angle");
    const Film film = this->render(scene);
    const Camera camera = camera_at(scene.camera, 0).camera;
    const double cosine = std::sqrt(1 - 1 / (1.5 * 1.5));
    const int width = scene.film.width, height = scene.film.height;
    size_t dark = 0, lit = 0, wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double right = double(2 * x + 1 - width) / width * camera.tan_half_width,
                         up = double(height - 2 * y - 1) / width * camera.tan_half_width;
            const Vec3<double> d = normalized(camera.forward + camera.right * right + camera.up * up);
            const double largest = std::max({magnitude(d.x), magnitude(d.y), magnitude(d.z)});
            if (std::abs(largest - cosine) < 1e-5) continue;
            const PixelRecord& pixel = film.pixels[size_t(y * width + x)];
            const bool black = pixel.radiance[0] == 0 && pixel.radiance[1] == 0 && pixel.radiance[2] == 0;
            wrong += black != (largest < cosine);
            ++(largest < cosine ? dark : lit);
        }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(dark, 1000u);
    EXPECT_GT(lit, 1000u);
}

/// Cells of 8 x 8 pixels, about the middle of the picture.
TYPED_TEST(HardScenes, AFarFloorIsRegular) {
    const SceneDescription scene = load("far-floor");
    const Film film = this->render(scene);
    const int width = scene.film.width, height = scene.film.height;
    const PixelRadiance* first[2] = {nullptr, nullptr};
    size_t wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const PixelRadiance& pixel = film.pixels.radiance(size_t(y * width + x));
            // In multiples of 8 from a corner of a cell beyond the picture's.
            const int cell = ((x - width / 2 + 800) / 8 + (y - height / 2 + 800) / 8) % 2;
            if (!first[cell]) first[cell] = &pixel;
            wrong += std::memcmp(pixel.radiance, first[cell]->radiance, sizeof pixel.radiance) != 0;
        }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(first[1]->radiance[0], 0);
    EXPECT_GT(std::abs(first[0]->radiance[0] - first[1]->radiance[0]), first[1]->radiance[0] / 2);
}

TYPED_TEST(HardScenes, DimColorsUnderBrightLightsAreTheirProducts) {
    SceneDescription scene = load("brightness");
    const Film extreme = this->render(scene);
    for (MaterialDescription& material : scene.materials) {
        material.color *= 0x1p99;
        material.specular_color *= 0x1p99;
    }
    scene.ambient *= 0x1p-99;
    for (LightDescription& light : scene.lights) light.color *= 0x1p-99;
    EXPECT_LE(scene.lights[0].color.x, 1);
    EXPECT_EQ(this->differing(extreme, this->render(scene)), 0u);
}

}  // namespace
