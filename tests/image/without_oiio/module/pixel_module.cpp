// A shared object with the static libraries in it, as a program's plug-in or a module of Python is.
#include <cistula.h>

#include <algorithm>

#include "backend_embree/embree/embree_renderer.h"
#include "image/reader/reader_process.h"

using namespace cistula;

/// Puts the hash of a scene's first frame in 8 x 6 pixels, and the reader of pictures that the object finds, into
/// `out`.
extern "C" __attribute__((visibility("default"))) void render_pixels(const char* scene_file, char* out, size_t size) {
    std::string text;
    try {
        const SceneDescription scene = read_scene(scene_file);
        FrameSettings settings = frame_settings(scene);
        settings.set_size(8, 6);
        Film film;
        RenderProgress progress;
        make_embree_renderer<float>(compile_scene<float>(scene))
            ->render(camera_at(scene.camera, 0), settings, film, progress);
        text = film_hash(film) + " " + reader_path("tests");
    } catch (const std::exception& error) {
        text = error.what();
    }
    *std::copy_n(text.data(), std::min(text.size(), size - 1), out) = 0;
}
