// The frame that a program and a shared object render alike.
#pragma once

#include <string>

#include "backend_embree/embree/embree_renderer.h"
#include "render/record/film_picture.h"
#include "render/renderer.h"
#include "scene/readers/read_scene.h"

namespace cistula::test {

/// The hash of a scene's first frame in 8 x 6 pixels.
inline std::string small_frame_hash(const std::string& scene_file) {
    const SceneDescription scene = read_scene(scene_file);
    FrameSettings settings = frame_settings(scene);
    settings.set_size(8, 6);
    Film film;
    RenderProgress progress;
    make_embree_renderer<float>(compile_scene<float>(scene))
        ->render(camera_at(scene.camera, 0), settings, film, progress);
    return film_hash(film);
}

}  // namespace cistula::test
