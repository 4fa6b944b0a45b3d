// Whatever mode the caller's thread rounds in, images are the same, and the thread has that mode again afterwards, also
// where a call throws.
#include <gtest/gtest.h>
#include <immintrin.h>

#include <functional>
#include <string>

#include "backend_embree/embree/embree_renderer.h"
#include "base/error.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "testing/support/shipped_scenes.h"
#include "verify/reference_renderers.h"

using namespace cistula;

namespace {

constexpr unsigned sticky = 0x3f;     // what operations leave behind, whatever the mode
constexpr unsigned former = 0x1f80;   // to nearest
constexpr unsigned foreign = 0xffc0;  // toward zero, subnormal numbers flushed

/// What `call` returns or throws, called in a mode that it must leave as it is.
std::string called_in(unsigned mode, const std::function<std::string()>& call) {
    std::string result;
    _mm_setcsr(mode);
    try {
        result = call();
    } catch (const std::exception& error) {
        result = error.what();
    }
    const unsigned left = _mm_getcsr();
    _mm_setcsr(former);
    EXPECT_EQ(left & ~sticky, mode & ~sticky);
    return result;
}

TEST(ControlRegister, IsAsItWasAndChangesNothing) {
    const SceneDescription description = test::shipped_scene("glass");
    FrameSettings settings = frame_settings(description), wrong = settings;
    settings.set_size(64, 36);
    wrong.depth = 5000;
    const CameraFrame camera = camera_at(description.camera, 0);
    const glm::dvec3 from = camera.camera.position, ahead = camera.camera.forward, aside = camera.camera.right;
    const std::shared_ptr<CompiledScene<float>> scene = compile_scene<float>(description);
    build_primitive_tree(*scene);
    const auto rendered = [&](Renderer& renderer, const FrameSettings& of) {
        Film film;
        RenderProgress progress;
        renderer.render(camera, of, film, progress);
        return film_hash(film) + std::to_string(to_layers(film, {}).channels[0].values[1000]);
    };
    const auto embree = make_embree_renderer<float>(scene);
    const std::function<std::string()> calls[] = {
        [&] { return compile_scene<float>(description)->hashes.of(0); },
        [&] { return rendered(*make_embree_renderer<float>(scene), settings); },
        [&] { return rendered(*make_embree_renderer<float>(scene, {.always_tree = true}), settings); },
        [&] { return rendered(*make_host_renderer<float>(scene, HostIntersector::bvh), settings); },
        [&] { return rendered(*embree, wrong); },
        [&] { return film_hash(embree->pixel_tree(camera, settings, 30, 20).film); },
        [&] { return film_hash(embree->pixel_tree(camera, wrong, 30, 20).film); },
        [&] {
            return std::to_string(embree->intersect({&from, 1}, {&ahead, 1}).distance[0]);
        },
        [&] {
            return std::to_string(embree->transmittance({&from, 1}, {&aside, 1})[0].x);
        },
        [&]() -> std::string {
            const glm::dvec3 none(0);
            embree->intersect({&from, 1}, {&none, 1});
            return "";
        },
    };
    int number = 0;
    for (const auto& call : calls) {
        const std::string expected = called_in(former, call);
        EXPECT_FALSE(expected.empty()) << number;
        EXPECT_EQ(called_in(foreign, call), expected) << number;
        ++number;
    }
}

}  // namespace
