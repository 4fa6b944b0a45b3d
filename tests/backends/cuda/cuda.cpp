// The CUDA backend against the CPU's: the same integers, however a frame is cut into parts, devices and split trees.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

#include "backend_cuda/host/cuda_renderer.h"
#include "backend_embree/embree/embree_renderer.h"
#include "scene/description/without_effect.h"
#include "testing/support/contacts/contact_search.h"
#include "testing/support/endless_scene.h"
#include "testing/support/expect_error.h"
#include "testing/support/golden.h"
#include "testing/support/gpu.h"
#include "testing/support/scene.h"
#include "testing/support/shipped_scenes.h"
#include "testing/support/stopping.h"
#include "verify/scenes/generated_scene.h"

using namespace cistula;

namespace {

/// Neither mirrored nor transparent: no ray is sent on, and there is nothing for a ledger.
SceneDescription dull(const SceneDescription& scene) {
    return without_effect(without_effect(scene, effect_transmission).value(), effect_reflection).value();
}

/// What must be equal; the rays too, which no pixel's hash has by kind.
struct Image {
    std::string hash;
    uint64_t primary, reflected, transmitted, shadow;
    uint32_t flags;
    bool operator==(const Image&) const = default;
};
void PrintTo(const Image& image, std::ostream* out) {
    *out << image.hash << ", rays " << image.primary << " " << image.reflected << " " << image.transmitted << " "
         << image.shadow << ", flags " << image.flags;
}
Image image_of(const Film& film) {
    return {record_hash(film),     film.rays.primary, film.rays.reflected,
            film.rays.transmitted, film.rays.shadow,  film.flags};
}
Image render(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings, int frame = 0) {
    Film film;
    RenderProgress progress;
    EXPECT_TRUE(renderer.render(camera_at(scene.camera, frame), settings, film, progress));
    EXPECT_EQ(progress.pixels_done, film.pixels.size());
    EXPECT_EQ(progress.rays, film.rays.total());
    return image_of(film);
}

template <class Real>
class Cuda : public ::testing::Test {
  protected:
    static std::shared_ptr<const CompiledScene<Real>> compiled(const SceneDescription& scene) {
        return compile_scene<Real>(scene);
    }
    /// On the CPU.
    static Image expected(const SceneDescription& scene, const FrameSettings& settings, int frame = 0) {
        return render(*make_embree_renderer<Real>(compiled(scene)), scene, settings, frame);
    }
    static std::unique_ptr<Renderer> gpu(const SceneDescription& scene, const CudaOptions& options = {}) {
        return make_cuda_renderer<Real>(compiled(scene), options);
    }
};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Cuda, Reals);

TYPED_TEST(Cuda, GoldenScenesAreEqual) {
    CISTULA_NEEDS_GPU();
    for (const std::string& name : golden::scene_names(test::scene_folder)) {
        const SceneDescription scene = test::shipped_scene(name);
        const FrameSettings settings = golden::settings_for(scene);
        EXPECT_EQ(render(*this->gpu(scene), scene, settings), this->expected(scene, settings)) << name;
    }
}

TYPED_TEST(Cuda, AdaptiveFramesAreEqual) {
    CISTULA_NEEDS_GPU();
    std::vector<SceneDescription> all = {test::shipped_scene("benchmark"), dull(test::shipped_scene("benchmark")),
                                         without_effect(test::shipped_scene("benchmark"), effect_transmission).value(),
                                         test::shipped_scene("glass"), test::shipped_scene("mesh")};
    for (uint64_t seed = 3; seed < generated_scene_count; seed += 31)
        all.push_back(generated_scene(seed, test::scene_folder));
    for (const SceneDescription& scene : all) {
        FrameSettings settings = golden::settings_for(scene);
        settings.full_width = 100;  // no multiple of a tile
        settings.full_height = 57;
        settings.crop = {3, 5, 90, 50};
        settings.depth = std::min(scene.depth, 6);
        for (const double target : {0.1, 0.01}) {
            settings.target_error = target;
            settings.max_samples = target == 0.1 ? 256 : 40;
            CudaOptions options;
            for (const bool always_tree : {false, true}) {
                options.always_tree = always_tree;
                EXPECT_EQ(render(*this->gpu(scene, options), scene, settings), this->expected(scene, settings))
                    << scene.source << ", target " << target;
            }
        }
    }
}

TYPED_TEST(Cuda, RaysAreAnsweredAlike) {
    CISTULA_NEEDS_GPU();
    size_t met = 0, dimmed = 0;
    for (const char* name : {"platonic", "glass", "mesh", "hard/media-meshes", "hard/lights-on-edges"}) {
        const SceneDescription description = test::shipped_scene(name);
        const std::shared_ptr<const CompiledScene<TypeParam>> scene = this->compiled(description);
        const auto gpu = make_cuda_renderer<TypeParam>(scene), cpu = make_embree_renderer<TypeParam>(scene);
        std::vector<glm::dvec3> origins, directions, ends;
        const double size = std::ldexp(1.0, 1 - scene->scale);
        uint32_t state = 1;
        const auto coordinate = [&] { return std::ldexp(int32_t(state = state * 1664525u + 1013904223u), -31) * size; };
        for (size_t i = 0; i < 50000; ++i) {
            const glm::dvec3 from(coordinate(), coordinate(), coordinate()),
                to(coordinate(), coordinate(), coordinate());
            origins.push_back(scene->center + (i % 8 == 0 ? 1e3 : 0.6) * from);
            directions.push_back(scene->center + 0.5 * to - origins.back());
            ends.push_back(description.lights.empty() || i % 2 == 0
                               ? origins.back() + 1.5 * directions.back()
                               : description.lights[i % description.lights.size()].position);
        }
        const RayHits here = cpu->intersect(origins, directions), there = gpu->intersect(origins, directions);
        EXPECT_EQ(there.distance, here.distance) << name;
        EXPECT_EQ(there.object, here.object) << name;
        EXPECT_EQ(there.material, here.material) << name;
        EXPECT_EQ(there.face, here.face) << name;
        EXPECT_EQ(there.crossing, here.crossing) << name;
        EXPECT_EQ(there.point, here.point) << name;
        EXPECT_EQ(there.normal, here.normal) << name;
        EXPECT_EQ(there.uv, here.uv) << name;
        const std::vector<glm::dvec3> shares = cpu->transmittance(origins, ends);
        EXPECT_EQ(gpu->transmittance(origins, ends), shares) << name;
        for (const int32_t object : here.object) met += object >= 0;
        for (const glm::dvec3& share : shares) dimmed += share.x > 0 && share.x < 1;
    }
    EXPECT_GT(met, 50000u);
    EXPECT_GT(dimmed, 5000u);
}

TYPED_TEST(Cuda, ScenesWithContactsAreEqualWhateverThePath) {
    CISTULA_NEEDS_GPU();
    for (uint64_t seed = 0; seed < test::contact_scene_count; ++seed) {
        const SceneDescription scene = test::ContactSearch(seed).scene();
        const FrameSettings settings = generated_settings(scene);
        const Image expected = this->expected(scene, settings);
        for (const bool always_tree : {false, true}) {
            CudaOptions options;
            options.always_tree = always_tree;
            EXPECT_EQ(render(*this->gpu(scene, options), scene, settings), expected)
                << "seed " << seed << (always_tree ? ", tree" : "");
        }
    }
}

TYPED_TEST(Cuda, GeneratedScenesAreEqualWhateverThePath) {
    CISTULA_NEEDS_GPU();
    for (uint64_t seed = 5; seed < generated_scene_count; seed += 16) {
        const SceneDescription scene = generated_scene(seed, test::scene_folder);
        FrameSettings settings = generated_settings(scene);
        const Image expected = this->expected(scene, settings);
        for (const bool always_tree : {false, true}) {
            CudaOptions options;
            options.always_tree = always_tree;
            EXPECT_EQ(render(*this->gpu(scene, options), scene, settings), expected)
                << "seed " << seed << (always_tree ? ", tree" : "");
        }
        settings.effects = all_effects;
        EXPECT_EQ(render(*this->gpu(scene), scene, settings), expected) << "seed " << seed << " with all effects";
    }
}

TYPED_TEST(Cuda, AFrameInPartsIsTheSame) {
    CISTULA_NEEDS_GPU();
    for (const char* name : {"benchmark", "glass", "platonic"}) {  // mirrors show lights in the last
        const SceneDescription scene = test::shipped_scene(name);
        const FrameSettings settings = golden::settings_for(scene);
        CudaOptions options;
        options.memory_limit = size_t{4} << 20;
        const auto parts = this->gpu(scene, options), whole = this->gpu(scene);
        EXPECT_EQ(render(*parts, scene, settings), this->expected(scene, settings)) << name;
        ASSERT_EQ(parts->notes().size(), 1u) << name;
        EXPECT_NE(parts->notes()[0].find("memory is short"), std::string::npos) << parts->notes()[0];
        render(*whole, scene, settings);
        EXPECT_TRUE(whole->notes().empty()) << name;
        options.memory_limit = 1000;
        try {
            render(*this->gpu(scene, options), scene, settings);
            ADD_FAILURE() << "a row fits into 1000 bytes";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::device) << error.what();
        }
    }
}

TYPED_TEST(Cuda, ACropIsTheSame) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("platonic");
    FrameSettings settings = golden::settings_for(scene);
    for (const PixelRect crop : {PixelRect{37, 21, 101, 59}, {0, 179, 320, 1}, {319, 0, 1, 180}, {160, 90, 1, 1}}) {
        settings.crop = crop;
        EXPECT_EQ(render(*this->gpu(scene), scene, settings), this->expected(scene, settings))
            << crop.width << "x" << crop.height << "+" << crop.x << "+" << crop.y;
    }
}

TYPED_TEST(Cuda, SeveralSharesOfOneFrameAreTheSame) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("platonic");
    const FrameSettings settings = golden::settings_for(scene);
    const Image expected = this->expected(scene, settings);
    // One GPU may have several shares, so the interleaving is tested where there is only one.
    std::vector<std::vector<int>> choices = {{0, 0}, {0, 0, 0}};
    std::vector<int> all;
    for (const CudaDevice& device : list_cuda_devices())
        if (device.obstacle.empty()) all.push_back(device.index);
    if (all.size() > 1) choices.push_back(all);
    for (const std::vector<int>& devices : choices)
        for (const size_t limit : {size_t{0}, size_t{2} << 20}) {
            CudaOptions options;
            options.devices = devices;
            options.memory_limit = limit;
            EXPECT_EQ(render(*this->gpu(scene, options), scene, settings), expected)
                << devices.size() << " shares, limit " << limit;
        }
}

TYPED_TEST(Cuda, FramesOfAFilmAreTheSameWhicheverDeviceHasThem) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("seed");
    const FrameSettings settings = golden::settings_for(scene);
    std::vector<int> all;
    for (const CudaDevice& device : list_cuda_devices())
        if (device.obstacle.empty()) all.push_back(device.index);
    for (const std::vector<int>& devices : std::vector<std::vector<int>>{{0}, {0, 0}, {0, 0, 0}, all})
        for (const size_t limit : {size_t{0}, size_t{2} << 20}) {  // of one part, and of several
            CudaOptions options;
            options.devices = devices;
            options.memory_limit = limit;
            const auto renderer = this->gpu(scene, options);
            constexpr int frames = 9;
            for (int frame = 0, announced = 0; frame < frames; ++frame) {
                while (announced < std::min(frame + int(renderer->frames_ahead()), frames - 1))
                    renderer->expect(camera_at(scene.camera, ++announced), settings);
                EXPECT_EQ(render(*renderer, scene, settings, frame), this->expected(scene, settings, frame))
                    << "frame " << frame << ", " << devices.size() << " shares, limit " << limit;
            }
        }
}

TYPED_TEST(Cuda, WhatWasAnnouncedNeverShows) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("seed");
    FrameSettings settings = golden::settings_for(scene), other = settings;
    other.depth = 2;
    const auto renderer = this->gpu(scene);
    const auto announce = [&](int frame, const FrameSettings& s) {
        renderer->expect(camera_at(scene.camera, frame), s);
    };
    const auto check = [&](int frame, const FrameSettings& s) {
        EXPECT_EQ(render(*renderer, scene, s, frame), this->expected(scene, s, frame)) << "frame " << frame;
    };
    announce(1, settings);
    check(0, settings);
    announce(2, settings);
    check(1, settings);  // as announced
    announce(4, other);
    check(9, settings);  // another frame than announced
    check(4, settings);  // other settings than announced
    announce(5, settings);
    check(4, other);
    settings.crop = {10, 10, 50, 40};
    check(5, settings);  // another crop
}

TYPED_TEST(Cuda, StopsInTheMiddleAndGoesOnAfterwards) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("benchmark");
    FrameSettings large = golden::settings_for(scene);
    large.set_size(1920, 1080);
    large.supersample = 8;
    CudaOptions options;
    options.memory_limit = size_t{16} << 20;  // many parts
    const auto renderer = this->gpu(scene, options);
    Film film;
    RenderProgress progress;
    std::atomic<bool> done{false};
    std::thread watcher([&] {
        while (progress.pixels_done == 0 && !done) std::this_thread::yield();
        progress.stop = true;
    });
    renderer->expect(camera_at(scene.camera, 0), large);  // begun or not, it must not get into the way
    EXPECT_FALSE(renderer->render(camera_at(scene.camera, 0), large, film, progress));
    done = true;
    watcher.join();
    EXPECT_GT(progress.pixels_done, 0u);
    EXPECT_LT(progress.pixels_done, 1920u * 1080u);
    const FrameSettings settings = golden::settings_for(scene);
    EXPECT_EQ(render(*renderer, scene, settings), this->expected(scene, settings));

    RenderProgress stopped;
    stopped.stop = true;
    EXPECT_FALSE(renderer->render(camera_at(scene.camera, 0), settings, film, stopped));
    EXPECT_EQ(render(*renderer, scene, settings), this->expected(scene, settings));
}

/// Stops a frame that would take years, twice, and then renders one that does not.
template <class Expected>
void check_endless(Renderer& renderer, const SceneDescription& scene, FrameSettings settings, const Expected& expected,
                   const std::string& where) {
    for (const double after : {0.3, 0.0}) {
        renderer.expect(camera_at(scene.camera, 1), settings);  // begun behind the first, it must end too
        const test::Stopped stopped = test::render_stopped(renderer, camera_at(scene.camera, 0), settings, after);
        EXPECT_FALSE(stopped.whole) << where;
        EXPECT_LT(stopped.seconds, 5) << where;
    }
    settings.target_error = 0;
    settings.supersample = 1;
    settings.depth = 2;
    EXPECT_EQ(render(renderer, scene, settings), expected(scene, settings)) << where;
}

TYPED_TEST(Cuda, StopsWithinAnEndlessFrame) {
    CISTULA_NEEDS_GPU();
    const auto expected = [](const SceneDescription& scene, const FrameSettings& settings) {
        return TestFixture::expected(scene, settings);
    };
    struct Case {
        int supersample = 1;
        double target_error = 0;
        std::vector<int> devices = {0};
    };
    const std::vector<Case> cases = {{}, {4}, {1, 1e-6}, {1, 0, {0, 0}}};  // the third is adaptive
    // By a tree, and by a plain loop.
    for (const SceneDescription& scene : {test::shipped_scene("hard/furnace"), test::room_of_mirrors()})
        for (const Case& one : cases) {
            CudaOptions options;
            options.devices = one.devices;
            FrameSettings settings = test::endless_settings(96, 54);
            if (one.target_error > 0) settings = test::endless_settings(1920, 1080);
            settings.supersample = one.supersample;
            settings.target_error = one.target_error;
            check_endless(*this->gpu(scene, options), scene, settings, expected,
                          scene.source + ", samples " + std::to_string(one.supersample) +
                              (one.target_error > 0 ? ", adaptive" : "") + ", shares " +
                              std::to_string(one.devices.size()));
        }
}

TYPED_TEST(Cuda, GoesAwayWithAFrameUnderWay) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::room_of_mirrors();
    FrameSettings settings = test::endless_settings(96, 54);
    settings.depth = 40;  // less than a second
    const auto renderer = this->gpu(scene);
    renderer->expect(camera_at(scene.camera, 0), settings);
    render(*renderer, scene, settings);  // leaves another one under way
}

TYPED_TEST(Cuda, RefusesDevicesThatAreNotThere) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("benchmark");
    const std::string last = std::to_string(list_cuda_devices().size() - 1);
    for (const int index : {4096, -1}) {
        CudaOptions options;
        options.devices = {0, index};
        EXPECT_ERROR(this->gpu(scene, options), ExitCode::device,
                     "--device " + std::to_string(index) + ": there is no such GPU; this machine has 0 to " + last);
    }
}

TYPED_TEST(Cuda, FramesLeaveNothingOfTheOneBefore) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("benchmark");
    FrameSettings settings = golden::settings_for(scene);
    settings.crop = {3, 5, settings.full_width - 10, settings.full_height - 13};  // the last strip is not whole
    const auto renderer = this->gpu(scene);
    Film film;
    for (const double target : {0.0, 0.02}) {
        settings.target_error = target;
        for (const int frame : {0, 20, 40, 0}) {  // other pixels show background
            RenderProgress progress;
            ASSERT_TRUE(renderer->render(camera_at(scene.camera, frame), settings, film, progress));
            EXPECT_EQ(image_of(film), this->expected(scene, settings, frame)) << "frame " << frame;
        }
    }
}

TYPED_TEST(Cuda, ManyVisibleLightsAreEqual) {
    CISTULA_NEEDS_GPU();
    SceneDescription scene = test::shipped_scene("benchmark");
    const FrameSettings settings = golden::settings_for(scene);
    for (const int light_count : {10, 90}) {  // blocks know what they show by an outline of each, or know nothing
        test::add_visible_lights(scene, light_count);
        EXPECT_EQ(render(*this->gpu(scene), scene, settings), this->expected(scene, settings)) << light_count;
    }
}

TYPED_TEST(Cuda, BackgroundAloneTakesNoKernel) {
    CISTULA_NEEDS_GPU();
    SceneDescription scene = test::shipped_scene("benchmark");
    scene.background = {0.25, 0.5, 0.125};
    const auto renderer = this->gpu(scene);
    FrameSettings settings = golden::settings_for(scene);
    settings.supersample = 3;
    scene.camera = CameraDescription();
    scene.camera.position = {30, 0, 0};
    scene.camera.target = {60, 0, 0};
    EXPECT_EQ(render(*renderer, scene, settings), this->expected(scene, settings));
    EXPECT_EQ(renderer->times().kernel, 0);
    scene.camera.target = {0, 0, 0};
    EXPECT_EQ(render(*renderer, scene, settings), this->expected(scene, settings));
    EXPECT_GT(renderer->times().kernel, 0);
}

TYPED_TEST(Cuda, LargeFramesAreEqual) {
    CISTULA_NEEDS_GPU();
    // Their warps take every other two pixels; the widths leave the last block whole, even and odd.
    FrameSettings settings = golden::settings_for(test::shipped_scene("benchmark"));
    SceneDescription lit = test::shipped_scene("benchmark");
    test::add_edge_lights(lit, 2);
    for (const SceneDescription& scene :
         {test::shipped_scene("benchmark"), dull(test::shipped_scene("benchmark")), lit})
        for (const int width : {1040, 1030, 1029}) {
            settings.set_size(width, 516);
            EXPECT_EQ(render(*this->gpu(scene), scene, settings), this->expected(scene, settings)) << width;
        }
}

TYPED_TEST(Cuda, FramesWithoutALedgerAreEqual) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = dull(test::shipped_scene("benchmark"));
    CudaOptions options;
    options.memory_limit = size_t{1} << 20;
    for (const int k : {1, 2, 3}) {
        FrameSettings settings = golden::settings_for(scene);
        settings.supersample = k;
        settings.crop = {1, 2, 237, 129};
        const Image expected = this->expected(scene, settings);
        EXPECT_EQ(render(*this->gpu(scene, options), scene, settings), expected) << k << ", in parts";
        const auto renderer = this->gpu(scene);
        Film film;
        for (int turn = 0; turn < 2; ++turn) {
            const PixelPlanes planes = film.pixels.planes();
            const size_t pixels = film.pixels.size();
            if (pixels != 0) {
                std::memset(planes.radiance, 0x5a, pixels * sizeof(PixelRadiance));
                std::memset(planes.losses, 0x5a, pixels * sizeof(PixelLosses));
                std::memset(planes.sights, 0x5a, pixels * sizeof(PixelSight));
            }
            RenderProgress progress;
            ASSERT_TRUE(renderer->render(camera_at(scene.camera, 0), settings, film, progress));
            EXPECT_EQ(image_of(film), expected) << k;
        }
        settings.effects = all_effects;  // the same renderer, whose records have a ledger then
        EXPECT_EQ(render(*renderer, scene, settings), expected) << k;
    }
}

TYPED_TEST(Cuda, FilmsKeepWhatIsAskedFor) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("platonic");
    const std::shared_ptr<const CompiledScene<TypeParam>> compiled = this->compiled(scene);
    const auto cpu = make_embree_renderer<TypeParam>(compiled);
    const auto gpu = this->gpu(scene);
    for (const int k : {1, 2})
        for (const double target : {0.0, 0.05})
            for (const KeptParts& parts :
                 {KeptParts{}, KeptParts{false, false}, KeptParts{true, false}, KeptParts{false, true}}) {
                FrameSettings settings = golden::settings_for(scene);
                settings.set_size(237, 129);
                settings.supersample = k;
                settings.target_error = target;
                settings.parts = parts;
                const FilmDifference difference = film_difference(golden::render_with(*gpu, scene, settings),
                                                                  golden::render_with(*cpu, scene, settings));
                EXPECT_EQ(difference.differing, 0u) << k << ", " << target << ", " << parts.bytes() << " bytes";
            }
}

TYPED_TEST(Cuda, SharesOfAPixelsSamplesAddUp) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("platonic");
    for (const int k : {2, 3, 5}) {
        FrameSettings settings = golden::settings_for(scene);
        settings.supersample = k;
        settings.crop = {1, 2, 37, 29};
        EXPECT_EQ(render(*this->gpu(scene), scene, settings), this->expected(scene, settings)) << k;
    }
}

TYPED_TEST(Cuda, SaysWhereTheTimeWent) {
    CISTULA_NEEDS_GPU();
    const SceneDescription scene = test::shipped_scene("benchmark");
    const auto renderer = this->gpu(scene);
    render(*renderer, scene, golden::settings_for(scene));
    EXPECT_GT(renderer->times().kernel, 0);
    EXPECT_GT(renderer->times().transfer, 0);
    EXPECT_GT(renderer->memory(), 0u);
    EXPECT_EQ(renderer->intersector(), "cuda");
}

}  // namespace
