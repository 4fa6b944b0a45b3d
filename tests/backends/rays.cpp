// Questions about rays: every renderer answers them with the same bits, and as frames are rendered.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "backend_embree/embree/embree_renderer.h"
#include "base/error.h"
#include "render/renderer.h"
#include "testing/support/shipped_scenes.h"
#include "verify/reference_renderers.h"

using namespace cistula;
using glm::dvec3;

namespace {

struct Pairs {
    std::vector<dvec3> from, to;

    void add(const dvec3& start, const dvec3& end) {
        from.push_back(start);
        to.push_back(end);
    }
};

class Random {
  public:
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    dvec3 in_cube(double half) { return {between(-half, half), between(-half, half), between(-half, half)}; }

  private:
    std::mt19937_64 engine_{5};
};

/// Rays from all over a scene and from far away, and the camera's own.
template <class Real>
Pairs rays_through(const CompiledScene<Real>& scene, const CameraFrame& camera, int count) {
    Random random;
    const double size = std::ldexp(1.0, 1 - scene.scale);
    Pairs rays;
    for (int i = 0; i < count; ++i) {
        const dvec3 toward = scene.center + random.in_cube(0.7 * size);
        const dvec3 from = i % 3 == 0   ? camera.camera.position
                           : i % 3 == 1 ? scene.center + random.in_cube(0.5 * size)
                                        : scene.center + random.in_cube(i % 2 == 0 ? 3 * size : 1e4 * size);
        rays.add(from, toward - from);
    }
    return rays;
}

bool same(const dvec3& a, const dvec3& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}
bool same(const RayHits& a, size_t i, const RayHits& b, size_t j) {
    return a.distance[i] == b.distance[j] && a.object[i] == b.object[j] && a.material[i] == b.material[j] &&
           a.face[i] == b.face[j] && a.crossing[i] == b.crossing[j] && same(a.point[i], b.point[j]) &&
           same(a.normal[i], b.normal[j]) && a.uv[i] == b.uv[j];
}

template <class Real>
class RayQueries : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(RayQueries, Precisions);

const std::vector<std::string> scenes = {"platonic",
                                         "glass",
                                         "infinity",
                                         "seed",
                                         "mesh",
                                         "hard/glass-on-floor",
                                         "hard/media-meshes",
                                         "hard/nested-shells",
                                         "hard/lights-on-edges",
                                         "hard/face-planes",
                                         "hard/doubled"};

TYPED_TEST(RayQueries, EveryRendererGivesTheSameBits) {
    using Real = TypeParam;
    size_t met = 0, inside = 0, dimmed = 0, in_lanes = 0;
    for (const std::string& name : scenes) {
        SCOPED_TRACE(name);
        const SceneDescription description = test::shipped_scene(name);
        const std::shared_ptr<CompiledScene<Real>> scene = compile_scene<Real>(description);
        build_primitive_tree(*scene);
        const CameraFrame camera = camera_at(description.camera, 0);
        const Pairs rays = rays_through(*scene, camera, 6000);
        Pairs segments;
        for (size_t i = 0; i < rays.from.size(); ++i) {
            const bool to_light = i % 2 == 0 && !description.lights.empty();
            segments.add(rays.from[i], to_light ? description.lights[i / 2 % description.lights.size()].position
                                                : rays.from[i] + 1.5 * rays.to[i]);
        }
        const auto first = make_embree_renderer<Real>(scene);
        const RayHits expected = first->intersect(rays.from, rays.to);
        const std::vector<dvec3> shares = first->transmittance(segments.from, segments.to);
        for (size_t i = 0; i < rays.from.size(); ++i) {
            met += expected.object[i] >= 0;
            inside += expected.crossing[i] == CrossingKind::leave;
            dimmed += shares[i].x > 0 && shares[i].x < 1;
        }
        std::vector<std::unique_ptr<Renderer>> others;
        others.push_back(make_embree_renderer<Real>(scene, {.always_tree = true}));
        others.push_back(make_host_renderer<Real>(scene, HostIntersector::bvh));
        others.push_back(make_host_renderer<Real>(scene, HostIntersector::brute));
        for (const auto& other : others) {
            const RayHits hits = other->intersect(rays.from, rays.to);
            const std::vector<dvec3> passed = other->transmittance(segments.from, segments.to);
            size_t wrong = 0, dimmed_otherwise = 0;
            for (size_t i = 0; i < rays.from.size(); ++i) {
                wrong += !same(hits, i, expected, i);
                dimmed_otherwise += !same(passed[i], shares[i]);
            }
            EXPECT_EQ(wrong, 0u) << other->intersector();
            EXPECT_EQ(dimmed_otherwise, 0u) << other->intersector();
        }
        Film film;
        RenderProgress progress;
        FrameSettings settings = frame_settings(description);
        settings.set_size(8, 8);
        first->render(camera, settings, film, progress);
        in_lanes += first->lanes() > 1;
        // One by one.
        for (size_t i = 0; i < rays.from.size(); i += 97) {
            const std::span<const dvec3> from(&rays.from[i], 1), to(&rays.to[i], 1), end(&segments.to[i], 1);
            EXPECT_TRUE(same(first->intersect(from, to), 0, expected, i)) << i;
            EXPECT_TRUE(same(first->transmittance(from, end)[0], shares[i])) << i;
        }
    }
    EXPECT_GT(met, 10000u);
    EXPECT_GT(inside, 200u);
    EXPECT_GT(dimmed, 1000u);
    EXPECT_GT(in_lanes, 5u);
}

TEST(RayQueries, FloatAndDoubleAgree) {
    for (const std::string& name : scenes) {
        SCOPED_TRACE(name);
        const SceneDescription description = test::shipped_scene(name);
        const std::shared_ptr<const CompiledScene<float>> narrow = compile_scene<float>(description);
        const std::shared_ptr<const CompiledScene<double>> wide = compile_scene<double>(description);
        const double size = std::ldexp(1.0, 1 - wide->scale);
        const Pairs rays = rays_through(*wide, camera_at(description.camera, 0), 4000);
        const RayHits a = make_embree_renderer<float>(narrow)->intersect(rays.from, rays.to);
        const RayHits b = make_embree_renderer<double>(wide)->intersect(rays.from, rays.to);
        size_t apart = 0;
        for (size_t i = 0; i < rays.from.size(); ++i) {
            const bool one = a.object[i] == b.object[i] && a.face[i] == b.face[i] && a.crossing[i] == b.crossing[i];
            apart += !one || (a.object[i] >= 0 && !(length(a.point[i] - b.point[i]) < 1e-4 * size));
        }
        EXPECT_LT(apart, rays.from.size() / 100);
    }
}

/// A first hit tells what the pixel's tree tells of its primary ray, and light passes as its surfaces say.
TYPED_TEST(RayQueries, TellWhatFramesShow) {
    using Real = TypeParam;
    size_t compared = 0, lights = 0, apart = 0;
    for (const char* name : {"platonic", "glass", "mesh", "hard/media-meshes", "hard/same-glass"}) {
        SCOPED_TRACE(name);
        const SceneDescription description = test::shipped_scene(name);
        const std::shared_ptr<const CompiledScene<Real>> scene = compile_scene<Real>(description);
        const auto renderer = make_embree_renderer<Real>(scene);
        FrameSettings settings = frame_settings(description);
        settings.set_size(160, 90);
        settings.supersample = 1;
        const CameraFrame camera = camera_at(description.camera, 0);
        const double size = std::ldexp(1.0, 1 - scene->scale);
        const double near = 256 * double(RealTraits<Real>::unit) * size;
        for (int y = 5; y < 90; y += 11)
            for (int x = 3; x < 160; x += 17) {
                const PixelTree tree = renderer->pixel_tree(camera, settings, x, y);
                const PixelBranch& primary = tree.samples[0].branches[0];
                if (primary.end != BranchEnd::surface || !primary.passed.empty()) continue;
                if (!primary.surface.also.empty()) continue;  // a place that shading resolves
                const RayHits hits = renderer->intersect({&primary.origin, 1}, {&primary.direction, 1});
                const PixelSurface& surface = primary.surface;
                ASSERT_EQ(hits.object[0], int(surface.solid)) << x << ',' << y;
                EXPECT_EQ(hits.face[0], int(surface.face));
                EXPECT_EQ(hits.material[0], int(surface.material));
                EXPECT_EQ(hits.crossing[0], surface.crossing);
                EXPECT_EQ(hits.names->objects[surface.solid], scene->solid_names[surface.solid]);
                EXPECT_NEAR(hits.distance[0], primary.distance, near);
                EXPECT_LT(length(hits.point[0] - surface.point), near);
                const dvec3 normal = surface.face_normal.value_or(surface.normal);
                EXPECT_LT(length(hits.normal[0] - normal), 1e-6);
                ++compared;
                const dvec3 from = surface.point + 1e-5 * size * normal;
                for (const LightContribution& light : surface.lights) {
                    if (light.fate != LightFate::adds && light.fate != LightFate::shadow) continue;
                    const dvec3& to = description.lights[light.light].position;
                    const dvec3 share = renderer->transmittance({&from, 1}, {&to, 1})[0];
                    ++lights;
                    apart += !(length(share - light.arrives) < 1e-4);
                }
            }
    }
    EXPECT_GT(compared, 150u);
    EXPECT_GT(lights, 300u);
    EXPECT_LE(apart, lights / 200);
}

SceneDescription one_cube(const std::string& object) {
    return read_scene_text(
        R"({"materials": {"clear": {"transmission": 0.5, "reflection": 0.1}}, "lights": [{"position": [5, 5, 5]}],
        "objects": [)" +
            object + "]}",
        "test", "");
}

TYPED_TEST(RayQueries, EdgesAndVerticesLeakNothing) {
    using Real = TypeParam;
    const std::string mesh =
        R"({"triangles": {"vertices": [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]],
        "indices": [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,1,5],[0,5,4],[2,3,7],[2,7,6],[1,2,6],[1,6,5],[0,4,7],[0,7,3]]}, "keep_triangles": true,
        "material": "clear"})";
    const std::string solid = R"({"solid": "cube", "radius": 1.7320508075688772, "material": "clear"})";
    for (const std::string& object : {mesh, solid}) {
        const auto renderer = make_embree_renderer<Real>(compile_scene<Real>(one_cube(object)));
        Random random;
        Pairs outward, inward;
        for (int i = 0; i < 3000; ++i) {
            dvec3 on(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);  // a corner, or a point of an edge
            if (i % 2 == 0) on[i % 3] = double(random.between(-1, 1));
            const dvec3 from = on + (0.1 + random.between(0, 3)) * on;
            inward.add(from, dvec3(0) - from + 1e-12 * random.in_cube(1));
            outward.add(0.5 * random.in_cube(1), on);
            outward.to.back() -= outward.from.back();
        }
        const RayHits entered = renderer->intersect(inward.from, inward.to);
        const RayHits left = renderer->intersect(outward.from, outward.to);
        for (size_t i = 0; i < 3000; ++i) {
            ASSERT_EQ(entered.object[i], 0) << object << ", ray " << i;
            EXPECT_EQ(entered.crossing[i], CrossingKind::enter);
            ASSERT_EQ(left.object[i], 0) << object << ", ray " << i;
            EXPECT_EQ(left.crossing[i], CrossingKind::leave);
            EXPECT_NEAR(left.distance[i], length(outward.to[i]), 1e-5);
            EXPECT_LT(dot(left.normal[i], outward.to[i]), 0) << "toward the origin";
        }
        // A line through a corner, and one through the body: two faces, or none.
        const std::vector<dvec3> from = {{3, 3, 3}, {3, 0.1, 0.2}, {3, 3, 0}, {0, 0, 0}, {2, 2, 2}},
                                 to = {{-3, -3, -3}, {-3, 0.1, 0.2}, {-3, 3, 0}, {3, 0.3, 0.1}, {2, 2, 2}};
        const std::vector<dvec3> shares = renderer->transmittance(from, to);
        const double expected[] = {0.25, 0.25, 1, 0.5, 1};
        for (size_t i = 0; i < from.size(); ++i) EXPECT_EQ(shares[i], dvec3(expected[i])) << object << ", " << i;
    }
}

TEST(RayQueries, ABadRayIsNamed) {
    const auto renderer = make_embree_renderer<float>(compile_scene<float>(test::shipped_scene("platonic")));
    const double nan = std::nan("");
    const auto message = [](const auto& ask) -> std::string {
        try {
            ask();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    const std::vector<dvec3> good(2000, dvec3(1, 2, 3));
    for (const dvec3& bad : {dvec3(0), dvec3(nan, 1, 1), dvec3(1, -1 / 0.0, 1), dvec3(1e-200, 0, 0)}) {
        std::vector<dvec3> directions = good;
        directions[7] = directions[1500] = bad;
        EXPECT_EQ(message([&] { renderer->intersect(good, directions); }),
                  "ray 7: needs an origin near the scene and a direction that is not 0, in finite numbers");
    }
    for (const dvec3& bad : {dvec3(nan, 1, 1), dvec3(1, 1e300, 1)}) {
        std::vector<dvec3> points = good;
        points[1999] = bad;
        EXPECT_NE(message([&] { renderer->intersect(points, good); }).find("ray 1999: "), std::string::npos);
        EXPECT_EQ(message([&] { renderer->transmittance(good, points); }),
                  "segment 1999: needs two ends near the scene, in finite numbers");
    }
    EXPECT_EQ(message([&] {
                  renderer->intersect(good, {good.data(), 5});
              }),
              "origins and directions of rays: there are 2000 and 5; must be as many");
    EXPECT_TRUE(renderer->intersect({}, {}).distance.empty());
    EXPECT_TRUE(renderer->transmittance({}, {}).empty());
}

}  // namespace
