// Embree's own triangles: another image than the exact one, and how far from it. Where nothing is near an edge only
// rounding differs; hard scenes end, whatever rays slip through there; images of one are never taken for the other's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "apps/common/header_attributes.h"
#include "apps/common/render_options.h"
#include "backend_embree/native/native_triangles.h"
#include "cistula/numerics/trigonometry.h"
#include "testing/support/expect_error.h"
#include "testing/support/golden.h"
#include "testing/support/scene.h"
#include "testing/support/shipped_scenes.h"

using namespace cistula;
using glm::dvec3;

namespace {

bool is_hard(const std::string& name) {
    return name.rfind("hard/", 0) == 0;
}

struct Pair {
    Film exact, native;
};

template <class Real>
Pair render_both(const SceneDescription& scene, const FrameSettings& settings) {
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(scene);
    const auto native = make_native_renderer<Real>(compiled);
    EXPECT_EQ(native->intersector(), "native");
    return {golden::render_with(*make_embree_renderer<Real>(compiled), scene, settings),
            golden::render_with(*native, scene, settings)};
}

FrameSettings frame_of(const SceneDescription& scene, int width, int height) {
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(std::min(settings.full_width, width), std::min(settings.full_height, height));
    return settings;
}

/// How far the pictures are apart in each pixel, in the scene's units of radiance.
std::vector<double> differences(const Pair& films) {
    const ColorPicture a = to_color(films.exact), b = to_color(films.native);
    std::vector<double> apart(a.texels.size());
    for (size_t i = 0; i < apart.size(); ++i)
        for (int c = 0; c < 3; ++c)
            apart[i] = std::max(apart[i], std::abs(double(a.texels[i][c]) - double(b.texels[i][c])));
    return apart;
}

/// Whether the exact image has anything within a pixel that this one could slip to: another solid, a ray tree of
/// another size, or a color at least half as far off as `apart`.
bool near_an_edge(const Film& exact, const ColorPicture& colors, size_t pixel, double apart) {
    const int width = exact.rect.width, x = int(pixel) % width, y = int(pixel) / width;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, exact.rect.height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
            const size_t other = size_t(v) * size_t(width) + size_t(u);
            const PixelRecord &a = exact.pixels[pixel], &b = exact.pixels[other];
            if (a.id != b.id || a.rays != b.rays) return true;
            for (int c = 0; c < 3; ++c)
                if (std::abs(colors.texels[other][c] - colors.texels[pixel][c]) >= apart / 2) return true;
        }
    return false;
}

/// Largest share of pixels whose rays rounding sends past an edge on the other side, as in tests/backends/images.cpp.
constexpr double largest_share_seen = 0.002;

template <class Real>
class Native : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Native, Reals);

/// Hits are floats, a few u M off at each surface and more at a slant, which no picture shows: only where a ray takes
/// another way may it change. Nor is there another tree where no edge is near.
TYPED_TEST(Native, DiffersFromExactOnlyNearEdges) {
    constexpr double visible = 0.5 / 255;
    for (const std::string& name : golden::scene_names(test::scene_folder)) {
        if (is_hard(name)) continue;
        const SceneDescription scene = test::shipped_scene(name);
        const Pair films = render_both<TypeParam>(scene, frame_of(scene, 240, 135));
        EXPECT_EQ(films.native.flags, 0u) << name;
        const std::vector<double> apart = differences(films);
        const ColorPicture colors = to_color(films.exact);
        size_t differing = 0, seen = 0, seen_elsewhere = 0, other_trees = 0, plain = 0;
        for (size_t i = 0; i < apart.size(); ++i) {
            const PixelRecord &e = films.exact.pixels[i], &n = films.native.pixels[i];
            const bool edge = near_an_edge(films.exact, colors, i, 2);  // of the trees alone: no color is so far off
            plain += !edge;
            differing += apart[i] > 0;
            seen += apart[i] > visible;
            seen_elsewhere += apart[i] > visible && !near_an_edge(films.exact, colors, i, apart[i]);
            other_trees += (e.id != n.id || e.rays != n.rays) && !edge;
        }
        std::cout << name << ": of " << apart.size() << " pixels " << differing << " differ, " << seen
                  << " by more than 0.5/255, " << *std::max_element(apart.begin(), apart.end()) << " at most; " << plain
                  << " are not near an edge\n";
        EXPECT_EQ(seen_elsewhere, 0u) << name;
        EXPECT_EQ(other_trees, 0u) << name;
        EXPECT_LE(double(seen), largest_share_seen * double(apart.size())) << name;
        EXPECT_GT(differing, 0u) << name << ": is this Embree's triangles?";
        EXPECT_GT(plain, apart.size() / 10) << name << ": there are only edges, so that little was tested";
    }
}

/// Rays that slip into or out of a solid at an edge find other things, but no way to go on for ever: each crossing is
/// beyond the last, and the tree's depth is what it was. (Of a stack of glasses, whose shared planes these triangles do
/// not know, 2.5 times the rays.)
TYPED_TEST(Native, HardScenesEnd) {
    for (const std::string& name : golden::scene_names(test::scene_folder)) {
        if (!is_hard(name)) continue;
        const SceneDescription scene = test::shipped_scene(name);
        const Pair films = render_both<TypeParam>(scene, frame_of(scene, 96, 54));
        EXPECT_EQ(films.native.flags, 0u) << name;
        EXPECT_LT(films.native.rays.total(), 4 * films.exact.rays.total()) << name;
        for (const double d : differences(films)) ASSERT_TRUE(std::isfinite(d)) << name;
    }
}

/// A cube's faces as triangles: with its corners, counter-clockwise from outside, each under its face's number.
TYPED_TEST(Native, FacesOfSolidsBecomeTheirTriangles) {
    for (const PlatonicSolid kind : test::platonic_solids) {
        SceneDescription scene;
        test::add_solid(scene, kind, dvec3(0.3, -0.2, 0.7), 1.25, dvec3(20, 30, 40));
        const auto compiled = test::compile<TypeParam>(scene);
        const SceneView<TypeParam> view = compiled->view();
        const std::vector<NativeTriangle> triangles = native_triangles(view);
        EXPECT_EQ(triangles.size(), triangulated(platonic_shape(kind)).size());
        const double tolerance = 64 * RealTraits<float>::unit * double(view.extent);
        double area = 0;
        for (const NativeTriangle& t : triangles) {
            const Slab<TypeParam>& slab = view.slabs[t.face / 2];
            const bool high = (t.face & 1u) != 0;
            const Vec3<double> outward = Vec3<double>(slab.normal) * (high ? 1.0 : -1.0);
            const double offset = high ? double(slab.high) : -double(slab.low);
            const Vec3<double> a(t.corner[0]), b(t.corner[1]), c(t.corner[2]), turn = cross(b - a, c - a);
            for (const Vec3<double>& p : {a, b, c}) EXPECT_NEAR(dot(outward, p), offset, tolerance);
            EXPECT_GT(dot(outward, turn), 0.999 * length(turn));
            area += length(turn) / 2;
        }
        const PlatonicShape& shape = platonic_shape(kind);
        double expected = 0;
        for (const auto& t : triangulated(shape))
            expected += length(cross(shape.vertices[t[1]] - shape.vertices[t[0]],
                                     shape.vertices[t[2]] - shape.vertices[t[0]])) /
                        2;
        const double side = 1.25 * elementary::power_of_two(compiled->scale);
        EXPECT_NEAR(area, expected * side * side, 1e-5 * area) << platonic_name(kind);
    }
}

/// A sheet of long strips, turned: boxes of such triangles lie on top of one another.
TrianglesObject strips(double z, double angle, int count) {
    TrianglesObject mesh;
    const double c = elementary::cos(angle), s = elementary::sin(angle);
    for (int i = 0; i <= count; ++i)
        for (const double y : {-3.0, 3.0}) {
            const double x = 6.0 * i / count - 3;
            mesh.vertices.push_back({c * x - s * y, s * x + c * y, z});
        }
    for (uint32_t i = 0; i < uint32_t(count); ++i) {
        mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
        mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    }
    return mesh;
}

/// Sheets of glass below a light: each is counted once, whatever the tree makes of its triangles.
TYPED_TEST(Native, ShadowsCountEachSheetOnce) {
    SceneDescription scene;
    const int opaque = test::add_material(scene), glass = test::add_material(scene, 0, 0.9);
    test::add_object(scene, strips(0, 0, 1), opaque);
    for (int i = 1; i <= 5; ++i) test::add_object(scene, strips(0.1 * i, 0.6 * i, 40), glass);
    test::add_light(scene, {0.1, 0.2, 1.5});
    scene.camera.position = {0.3, 0.2, 0.05};  // between the floor and the first sheet
    scene.camera.target = {0.9, 0.5, 0};
    scene.depth = 1;
    FrameSettings settings = frame_of(scene, 64, 64);
    const Pair films = render_both<TypeParam>(scene, settings);
    const std::vector<double> apart = differences(films);
    size_t lit = 0, seen = 0;
    for (size_t i = 0; i < apart.size(); ++i) {
        const PixelRecord& pixel = films.exact.pixels[i];
        lit += pixel.id == 1 && pixel.radiance[0] > 0;
        seen += apart[i] > 1e-3;  // a sheet more or less is a tenth of the light
    }
    EXPECT_GT(lit, apart.size() / 8);
    EXPECT_LE(seen, apart.size() / 500) << "rays through an edge";
}

RenderOptions parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "render");
    return parse_options(int(arguments.size()), arguments.data());
}

TEST(NativeOption, IsChosenAndRefused) {
    EXPECT_NE(help_text().find("--intersector"), std::string::npos);
    EXPECT_EQ(parse({"s"}).intersection, Intersection::exact);
    EXPECT_EQ(parse({"s", "--intersector", "exact", "--backend", "cuda"}).intersection, Intersection::exact);
    EXPECT_EQ(parse({"s", "--intersector", "native"}).intersection, Intersection::native);
    EXPECT_ERROR(parse({"s", "--intersector", "nativ"}), ExitCode::usage,
                 "--intersector nativ: must be exact or native; did you mean 'native'?");
    EXPECT_ERROR(parse({"s", "--intersector", "native", "--backend", "cuda"}), ExitCode::usage,
                 "--intersector native: Embree's own triangles, and --backend is cuda; leave one of the two out");
    EXPECT_ERROR(
        parse({"s", "--intersector", "native", "--pixel", "1,2"}), ExitCode::usage,
        "--pixel 1,2: --intersector has no place here: the rays of the exact image are followed; leave it out");
}

/// In the header, so that --resume takes no image of one for the other's; those of exact say what they always said.
TEST(NativeOption, IsInTheHeader) {
    CameraFrame camera{};
    camera.camera.forward = {0, 1, 0};
    camera.camera.right = {1, 0, 0};
    camera.camera.up = {0, 0, 1};
    const auto attributes = [&](const auto&... intersection) {
        return header_attributes("abc", FrameSettings(), Precision::single_, camera, intersection...);
    };
    LayeredPicture exact, native;
    exact.attributes = attributes(Intersection::exact);
    native.attributes = attributes(Intersection::native);
    EXPECT_EQ(exact.attributes.count("cistula:intersector"), 0u);
    EXPECT_EQ(exact.attributes, attributes());
    EXPECT_EQ(std::get<std::string>(native.attributes.at("cistula:intersector")), "native");
    EXPECT_EQ(native.attributes.size(), exact.attributes.size() + 1);
    EXPECT_FALSE(is_same_image(exact, native));
    EXPECT_FALSE(is_same_image(native, exact));
}

}  // namespace
