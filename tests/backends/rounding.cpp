// The floating-point mode of whoever calls a renderer is not the image's.
#include <gtest/gtest.h>
#include <immintrin.h>

#include "testing/support/golden.h"

using namespace cistula;

namespace {

constexpr unsigned int upward_flushing = 0xdfc0;  // MXCSR: round up, flush to zero, denormals are zero

TEST(Rounding, OfTheCallerLeavesTheImageAlone) {
    const SceneDescription scene = read_scene(CISTULA_SOURCE_DIR "/scenes/glass.json");
    FrameSettings settings = golden::settings_for(scene);
    settings.set_size(40, 30);
    const std::shared_ptr<const CompiledScene<float>> compiled = compile_scene<float>(scene);
    const auto hash = [&](unsigned int mode) {
        const auto renderer = make_embree_renderer<float>(compiled);
        const CameraFrame camera = camera_at(scene.camera, 0);
        const unsigned int before = _mm_getcsr();
        Film film;
        RenderProgress progress;
        _mm_setcsr(mode);
        renderer->render(camera, settings, film, progress);
        _mm_setcsr(before);
        return film_hash(film);
    };
    EXPECT_EQ(hash(upward_flushing), hash(_mm_getcsr()));
}

}  // namespace
