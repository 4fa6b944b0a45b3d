#include "render/frame_settings.h"

namespace cistula {

FrameSettings frame_settings(const SceneDescription& scene) {
    FrameSettings settings;
    settings.set_size(scene.film.width, scene.film.height);
    settings.supersample = scene.film.supersample;
    settings.depth = scene.depth;
    settings.cutoff = scene.cutoff;
    return settings;
}

}  // namespace cistula
