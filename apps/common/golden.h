// The golden images: what they are rendered with. Shared by make_golden, the tests and render-compare.
#pragma once

#include "scene/camera_path.h"
#include "scene/description.h"
#include "scene/film_picture.h"
#include "scene/renderer.h"

namespace cistula::golden {

inline constexpr int width = 320, height = 180;

inline FrameSettings settings_for(const SceneDescription& scene) {
    FrameSettings settings;
    settings.full_width = width;
    settings.full_height = height;
    settings.crop = {0, 0, width, height};
    settings.depth = scene.depth;
    settings.cutoff = scene.cutoff;
    return settings;
}

inline OutputChannels channels() {
    OutputChannels channels;
    channels.error = channels.id = channels.z = channels.normal = true;
    return channels;
}

inline Film render_with(Renderer& renderer, const SceneDescription& description, const FrameSettings& settings) {
    Film film;
    RenderProgress progress;
    renderer.render(camera_at(description.camera, 0), settings, film, progress);
    return film;
}

}  // namespace cistula::golden
