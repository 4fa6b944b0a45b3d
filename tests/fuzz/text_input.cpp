// The text input, in either order of its parts.
#include "scene/readers/scene_formats.h"
#include "scene_checks.h"
#include "target.h"

FUZZ_TARGET(text_input) {
    using namespace cistula;
    try {
        SceneDescription scene = read_text_input(std::string(reinterpret_cast<const char*>(data), size), "a.txt", "");
        fuzz::require(scene.objects.size() == 4 && scene.textures.size() == 1);
        fuzz::require(scene.film.output.find('%') != std::string::npos);
        fuzz::require(scene.film.output.find('\0') == std::string::npos);
        scene.textures[0].file.clear();  // a checker, which needs no file
        fuzz::check_scene(scene);
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::scene);
    }
    return 0;
}
