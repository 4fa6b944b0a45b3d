// A shared object with the static libraries in it, as a program's plug-in or a module of Python is.
#include <cistula.h>

#include <algorithm>

#include "../small_frame.h"
#include "image/reader/reader_process.h"

using namespace cistula;

/// Puts the hash of a scene's first frame in 8 x 6 pixels, and the reader of pictures that the object finds, into
/// `out`.
extern "C" __attribute__((visibility("default"))) void render_pixels(const char* scene_file, char* out, size_t size) {
    std::string text;
    try {
        text = test::small_frame_hash(scene_file) + " " + reader_path("tests");
    } catch (const std::exception& error) {
        text = error.what();
    }
    *std::copy_n(text.data(), std::min(text.size(), size - 1), out) = 0;
}
