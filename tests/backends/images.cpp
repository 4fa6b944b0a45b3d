// What may never change an image: threads, tiles, instruction sets, control registers, trees, the order of lights,
// effects that a scene does not use, and solids that cannot be seen. And what truncation may take away: at most what
// the ledger says.
#include <gtest/gtest.h>
#include <immintrin.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <iostream>

#include "backend_embree/embree/embree_api.h"
#include "cistula/model/effects.h"
#include "cistula/numerics/fixed_sum.h"
#include "scene/compile/compiled_scene.h"
#include "scene/description/platonic.h"
#include "testing/support/golden.h"
#include "testing/support/shipped_scenes.h"
#include "verify/reference_renderers.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;

namespace {

FrameSettings small_frame(const SceneDescription& scene, int depth = 0) {
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(160, 90);
    if (depth > 0) settings.depth = depth;
    return settings;
}

template <class Real>
Film render(const SceneDescription& scene, const FrameSettings& settings, const EmbreeOptions& options = {}) {
    const auto renderer = make_embree_renderer<Real>(compile_scene<Real>(scene), options);
    return golden::render_with(*renderer, scene, settings);
}

/// 0 <= reference - image <= ledger of the image, per pixel and channel, in integers.
::testing::AssertionResult within_ledger(const Film& reference, const Film& image, double& used) {
    int64_t lost = 0, stated = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const PixelRecord &r = reference.pixels[i], &p = image.pixels[i];
            const int64_t loss = r.radiance[c] - p.radiance[c], ledger = p.pruned[c] + p.cut[c];
            if (loss < 0 || loss > ledger)
                return ::testing::AssertionFailure()
                       << "pixel " << i << " channel " << c << ": lost " << loss << ", ledger " << ledger;
            lost += loss >> 20;
            stated += ledger >> 20;
        }
    used = stated > 0 ? double(lost) / double(stated) : 1;
    return ::testing::AssertionSuccess();
}

struct InstructionSet {
    const char* config;
    bool here;  // whether this processor has it
    int lanes;  // of the widest packets of rays that Embree then handles natively
};

bool has_avx2() {
    return __builtin_cpu_supports("avx2");
}

/// All that Embree calls avx512.
bool has_avx512() {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512vl");
}

/// What a device made with this configuration says of itself: 4, 8 or 16 lanes; 0: none.
int widest_rays(const char* config) {
    const RTCDevice device = rtcNewDevice(config);
    if (!device) return 0;
    int lanes = 0;
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED)) lanes = 4;
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) lanes = 8;
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) lanes = 16;
    rtcReleaseDevice(device);
    return lanes;
}

/// Default exceptions masked, rounding down, results and operands that are subnormal flushed to zero.
constexpr unsigned disturbed_register = 0x1f80u | 0x2000u | 0x8000u | 0x0040u;
constexpr unsigned control_bits = 0xffc0u;  // all but the sticky flags

/// Sets this thread's control register for as long as it lives.
class ControlRegister {
  public:
    explicit ControlRegister(unsigned value) : before_(_mm_getcsr()) { _mm_setcsr(value); }
    ~ControlRegister() { _mm_setcsr(before_); }
    ControlRegister(const ControlRegister&) = delete;
    ControlRegister& operator=(const ControlRegister&) = delete;

  private:
    unsigned before_;
};

template <class Real>
constexpr double largest_share_apart = sizeof(Real) == 4 ? 0.002 : 0.0002;

template <class Real>
class Images : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Images, Reals);

TYPED_TEST(Images, ThreadsAndTilesChangeNothing) {
    const SceneDescription scene = test::shipped_scene("platonic");
    FrameSettings settings = small_frame(scene);
    const std::string expected = record_hash(render<TypeParam>(scene, settings));
    for (const size_t threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        for (const int tile : {1, 7, 16, 64}) {
            settings.tile = tile;
            EXPECT_EQ(record_hash(render<TypeParam>(scene, settings)), expected)
                << threads << " threads, tile " << tile;
        }
    }
}

TYPED_TEST(Images, KeepWhatIsAskedFor) {
    const SceneDescription scene = test::shipped_scene("platonic");
    const std::shared_ptr<CompiledScene<TypeParam>> compiled = compile_scene<TypeParam>(scene);
    build_primitive_tree(*compiled);
    FrameSettings settings = small_frame(scene, 3);
    settings.supersample = 2;
    for (const double cutoff : {0.0, 0.01})
        for (const auto& renderer : {make_embree_renderer<TypeParam>(compiled),
                                     make_host_renderer<TypeParam>(compiled, HostIntersector::bvh)}) {
            settings.cutoff = cutoff;
            settings.parts = {};
            Film whole = golden::render_with(*renderer, scene, settings);
            Film counted = whole;
            counted.totals = totals_of(whole);
            EXPECT_EQ(film_difference(whole, counted).differing, 0u);
            EXPECT_GT(counted.totals.cut[0].most, 0u);
            for (const KeptParts& parts : {KeptParts{false, false}, KeptParts{true, false}, KeptParts{false, true}}) {
                Film expected = whole;
                expected.pixels.begin(whole.pixels.size(), parts);
                for (size_t i = 0; i < whole.pixels.size(); ++i) expected.pixels.set(i, whole.pixels[i]);
                settings.parts = parts;
                EXPECT_EQ(film_difference(golden::render_with(*renderer, scene, settings), expected).differing, 0u);
                EXPECT_EQ(film_hash(expected), film_hash(whole));
            }
        }
    settings.cutoff = 0;
    settings.target_error = 0.1;
    settings.parts = {false, false};
    EXPECT_EQ(render<TypeParam>(scene, settings).pixels.parts(), KeptParts()) << "its report needs them";
}

TYPED_TEST(Images, InstructionSetsAndTreesChangeNothing) {
    const SceneDescription scene = test::shipped_scene("mesh");
    const FrameSettings settings = small_frame(scene, 4);
    const std::string expected = record_hash(render<TypeParam>(scene, settings));
    for (const InstructionSet& isa : {InstructionSet{"isa=sse2", true, 4}, InstructionSet{"isa=avx2", has_avx2(), 8},
                                      InstructionSet{"isa=avx512", has_avx512(), 16}}) {
        if (!isa.here) {
            std::cout << "[ skipped  ] " << isa.config << ": this processor lacks it\n";
            continue;
        }
        EXPECT_EQ(widest_rays(isa.config), isa.lanes) << "Embree did not take " << isa.config;
        EmbreeOptions options;
        options.device_config = isa.config;
        options.always_tree = true;
        EXPECT_EQ(record_hash(render<TypeParam>(scene, settings, options)), expected) << isa.config;
    }
    EmbreeOptions quick;
    quick.tree_quality = 0;
    EXPECT_EQ(record_hash(render<TypeParam>(scene, settings, quick)), expected);
    for (const int quality : {0, 1}) {
        auto compiled = compile_scene<TypeParam>(scene);
        build_primitive_tree(*compiled, quality);
        const auto renderer = make_host_renderer<TypeParam>(std::move(compiled), HostIntersector::bvh);
        EXPECT_EQ(record_hash(golden::render_with(*renderer, scene, settings)), expected) << "bvh " << quality;
    }
}

TYPED_TEST(Images, ATreeAndThePlainLoopAgree) {
    for (const char* name : {"benchmark", "glass"}) {
        const SceneDescription scene = test::shipped_scene(name);
        EmbreeOptions tree;
        tree.always_tree = true;
        const FrameSettings settings = small_frame(scene);
        EXPECT_EQ(record_hash(render<TypeParam>(scene, settings)),
                  record_hash(render<TypeParam>(scene, settings, tree)))
            << name;
    }
}

TYPED_TEST(Images, EffectsThatAreNotUsedChangeNothing) {
    for (const char* name : {"benchmark", "platonic", "infinity"}) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = small_frame(scene, 4);
        const std::string expected = record_hash(render<TypeParam>(scene, settings));
        for (const uint32_t mask : effect_masks) {
            settings.effects = mask;
            EXPECT_EQ(record_hash(render<TypeParam>(scene, settings)), expected) << name << ", mask " << mask;
        }
    }
}

TYPED_TEST(Images, TheOrderOfLightsChangesNothing) {
    SceneDescription scene = test::shipped_scene("benchmark");
    scene.lights.push_back(scene.lights[0]);
    scene.lights.back().position = {0.3, -4, 7};
    const FrameSettings settings = small_frame(scene);
    const std::string expected = record_hash(render<TypeParam>(scene, settings));
    std::reverse(scene.lights.begin(), scene.lights.end());
    EXPECT_EQ(record_hash(render<TypeParam>(scene, settings)), expected);
}

TYPED_TEST(Images, ACropIsThatPartOfTheFrame) {
    for (const char* name : {"glass", "platonic"}) {  // mirrors show lights in the latter
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings settings = small_frame(scene);
        const Film whole = render<TypeParam>(scene, settings);
        settings.crop = {41, 23, 30, 20};
        const Film part = render<TypeParam>(scene, settings);
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 30; ++x) {
                const PixelRecord& a = whole.pixels[size_t((23 + y) * 160 + 41 + x)];
                const PixelRecord& b = part.pixels[size_t(y * 30 + x)];
                ASSERT_EQ(std::memcmp(a.radiance, b.radiance, sizeof a.radiance), 0) << name << ": " << x << ", " << y;
                ASSERT_EQ(a.id, b.id);
                ASSERT_EQ(a.rays, b.rays);
            }
    }
}

/// A solid of index 1 that mirrors and tints nothing is not there, for convex solids and for meshes.
TYPED_TEST(Images, IndexOneIsInvisible) {
    SceneDescription scene = test::shipped_scene("glass");
    scene.frame = FrameOfReference{{0, 0, 1}, -4, 64.0};
    const FrameSettings settings = small_frame(scene, 5);
    const Film without = render<TypeParam>(scene, settings);
    MaterialDescription air;
    air.name = "air";
    air.transmission = 1;
    scene.materials.push_back(air);
    const int material = int(scene.materials.size()) - 1;
    TrianglesObject ring = torus(1.3, 0.55, 40, 24);
    for (glm::dvec3& p : ring.vertices) p += glm::dvec3{0.4, -0.3, 1.1};
    std::vector<std::pair<std::string, decltype(ObjectDescription::shape)>> shapes;
    for (const PlatonicSolid kind : {PlatonicSolid::icosahedron, PlatonicSolid::tetrahedron}) {
        SolidObject shape;
        shape.solid = kind;
        shape.center = {0.4, -0.3, 1.1};
        shape.radius = 1.7;
        shapes.emplace_back(std::string(platonic_name(kind)) + " of planes", shape);
        shapes.emplace_back(std::string(platonic_name(kind)) + " of triangles", triangulated_solid(shape));
    }
    shapes.emplace_back("torus", ring);
    const std::vector<ObjectDescription> objects = scene.objects;
    for (const auto& [name, shape] : shapes) {
        ObjectDescription object;
        object.name = "nothing";
        object.material = material;
        object.shape = shape;
        scene.objects = objects;
        scene.objects.insert(scene.objects.begin(), object);
        const Film with = render<TypeParam>(scene, settings);
        EXPECT_EQ(with.flags, 0u) << name;
        size_t differing = 0, first = with.pixels.size();
        for (size_t i = 0; i < with.pixels.size(); ++i)
            if (std::memcmp(with.pixels[i].radiance, without.pixels[i].radiance, sizeof with.pixels[i].radiance) != 0) {
                ++differing;
                first = std::min(first, i);
            }
        EXPECT_EQ(differing, 0u) << name << ", first at " << first % 160 << ", " << first / 160;
        scene.materials[size_t(material)].index = 1.25;  // it is in view
        EXPECT_NE(record_hash(render<TypeParam>(scene, settings)), record_hash(without)) << name;
        scene.materials[size_t(material)].index = 1;
    }
}

/// Whatever other code left in the control registers of the calling thread and of the workers.
TYPED_TEST(Images, ControlRegistersChangeNothing) {
    const auto read = [] {
        SceneDescription scene = test::shipped_scene("mesh");
        scene.frame = FrameOfReference{{0.1, -0.3, 0.7}, -4, 64.0};  // so that moving the camera to the frame rounds
        return scene;
    };
    const SceneDescription scene = read();
    const FrameSettings settings = small_frame(scene, 4);
    const CameraFrame camera = camera_at(scene.camera, 0);
    const std::string expected = record_hash(render<TypeParam>(scene, settings));
    const auto compiled = compile_scene<TypeParam>(scene);
    EmbreeOptions always_tree;
    always_tree.always_tree = true;
    const ControlRegister disturbed(disturbed_register);
    // Its workers take over the register of the thread that makes it.
    tbb::task_arena arena;
    arena.initialize();
    arena.execute([&] {
        const auto disturb = [&] {
            std::atomic<int> default_before{0};
            tbb::parallel_for(
                0, 256,
                [&](int) {
                    default_before += (_mm_getcsr() & control_bits) != disturbed_register;
                    _mm_setcsr(disturbed_register);
                },
                tbb::simple_partitioner());
            _mm_setcsr(disturbed_register);
            return default_before.load();
        };
        EXPECT_EQ(disturb(), 0) << "the arena does not hand its register down, so that this test shows less";
        const SceneDescription again = read();
        const auto compile = [&] {
            disturb();
            auto treed = compile_scene<TypeParam>(again);
            EXPECT_EQ(treed->hashes.of(0), compiled->hashes.of(0));
            build_primitive_tree(*treed, 1);
            EXPECT_EQ(_mm_getcsr() & control_bits, disturbed_register) << "the caller's mode is not its own any more";
            return treed;
        };
        const auto in_lanes = make_embree_renderer<TypeParam>(compile());
        const auto by_tree = make_embree_renderer<TypeParam>(compile(), always_tree);
        const auto host = make_host_renderer<TypeParam>(compile(), HostIntersector::bvh);
        for (Renderer* each : {in_lanes.get(), by_tree.get(), host.get()}) {
            disturb();
            Film film;
            RenderProgress progress;
            each->render(camera, settings, film, progress);
            EXPECT_EQ(each->lanes() > 1, each == in_lanes.get());
            EXPECT_EQ(film.flags, 0u);
            EXPECT_EQ(record_hash(film), expected) << each->intersector();
        }
    });
}

/// Solids as planes and as closed meshes go different ways through the code: to one picture, but for the rays that
/// rounding sends past an edge on the other side. Absorption in shadows counts however far the light is.
TYPED_TEST(Images, PlanesAndTrianglesShowTheSame) {
    for (const char* name : {"benchmark", "glass", "glass in the sun"}) {
        SceneDescription scene = test::shipped_scene(std::string(name).substr(0, std::string(name).find(' ')));
        if (std::string(name) == "glass in the sun") {
            scene.lights.resize(1);
            scene.lights[0].position *= 1e5;
            scene.lights[0].radius = 0;
            for (MaterialDescription& material : scene.materials)
                if (material.transmission > 0) material.index = 1, material.absorption = {0.1, 0.5, 1};
        }
        const FrameSettings settings = small_frame(scene);
        const Film planes = render<TypeParam>(scene, settings);
        for (ObjectDescription& object : scene.objects)
            if (const auto* solid = std::get_if<SolidObject>(&object.shape)) object.shape = triangulated_solid(*solid);
        const Film triangles = render<TypeParam>(scene, settings);
        EXPECT_EQ(triangles.flags, 0u);
        const ColorPicture a = to_color(planes), b = to_color(triangles);
        size_t apart = 0;
        for (size_t i = 0; i < a.texels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                if (std::abs(a.texels[i][c] - b.texels[i][c]) > 0.5f / 255) {
                    ++apart;
                    break;
                }
        EXPECT_LE(double(apart), largest_share_apart<TypeParam> * double(a.texels.size())) << name << ": " << apart;
    }
}

TYPED_TEST(Images, TruncationStaysWithinTheLedger) {
    for (const char* name : {"benchmark", "platonic", "glass", "infinity"}) {
        const SceneDescription scene = test::shipped_scene(name);
        FrameSettings whole = small_frame(scene, 16);
        whole.cutoff = 0;
        const Film reference = render<TypeParam>(scene, whole);
        for (const int depth : {1, 2, 4, 8}) {
            double used = 0;
            EXPECT_TRUE(within_ledger(reference, render<TypeParam>(scene, small_frame(scene, depth)), used))
                << name << " at depth " << depth;
        }
        FrameSettings budget = small_frame(scene, 16);
        for (const double cutoff : {1e-3, 0.02, 0.5}) {
            budget.cutoff = cutoff;
            const Film image = render<TypeParam>(scene, budget);
            double used = 0;
            EXPECT_TRUE(within_ledger(reference, image, used)) << name << " with cutoff " << cutoff;
            EXPECT_LT(image.rays.total(), reference.rays.total());
            // The budget itself holds too: pruned <= cutoff per pixel, in units of the sums.
            const double unit = fixed_scale(image.fixed_shift) / elementary::power_of_two(image.radiance_exponent);
            for (const PixelRecord& pixel : image.pixels)
                for (const int64_t pruned : pixel.pruned) ASSERT_LE(double(pruned), cutoff * unit * (1 + 1e-9) + 4096);
        }
    }
}

}  // namespace
