// The static libraries linked into a shared object, which renders and finds the reader of pictures beside itself.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <string>

#include "small_frame.h"
#include "testing/support/shipped_scenes.h"

namespace cistula {
namespace {

TEST(SharedObject, RendersAndFindsItsReaderBesideItself) {
    const std::string folder = CISTULA_MODULE_FOLDER;
    void* const module = dlopen((folder + "/" + CISTULA_PIXEL_MODULE).c_str(), RTLD_NOW | RTLD_LOCAL);
    ASSERT_NE(module, nullptr) << dlerror();
    auto* const render_pixels = reinterpret_cast<void (*)(const char*, char*, size_t)>(dlsym(module, "render_pixels"));
    ASSERT_NE(render_pixels, nullptr) << dlerror();
    EXPECT_EQ(dlsym(module, "_ZN7cistula9film_hashB5cxx11ERKNS_4FilmE"), nullptr) << "libraries' symbols are its own";
    const std::string file = test::scene_folder + "/glass.json";
    char text[4096];
    render_pixels(file.c_str(), text, sizeof text);

    EXPECT_EQ(text, test::small_frame_hash(file) + " " + folder + "/cistula-read-picture");
}

}  // namespace
}  // namespace cistula
