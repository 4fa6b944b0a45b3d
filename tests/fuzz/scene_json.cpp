// Scene files, JSON or not, to the arrays of a scene that names no other files.
#include "scene/readers/read_scene.h"
#include "scene_checks.h"
#include "target.h"

FUZZ_TARGET(scene_json) {
    using namespace cistula;
    try {
        fuzz::check_scene(read_scene_text(std::string(reinterpret_cast<const char*>(data), size), "a.json", ""));
    } catch (const Error& error) {
        fuzz::check_error(error, ErrorKind::scene);
    }
    return 0;
}
