// Compiles a scene and renders it: every library is linked, with all that it needs. Pictures named in the arguments are
// written and read: the module for them is found.
#include <cstdio>
#include <exception>
#include <memory>

#include "backend_embree/embree/embree_renderer.h"
#include "image/picture/picture_io.h"
#include "scene/compile/compiled_scene.h"
#include "scene/description/camera_path.h"

int main(int argc, char** argv) try {
    cistula::SceneDescription description;
    description.materials.emplace_back();
    cistula::ObjectDescription cube;
    cube.material = 0;
    cube.shape = cistula::SolidObject{.solid = cistula::PlatonicSolid::cube};
    description.objects.push_back(cube);
    description.lights.push_back({.position = {3, -4, 5}});

    const std::shared_ptr<const cistula::CompiledScene<float>> scene = cistula::compile_scene<float>(description);
    const auto renderer = cistula::make_embree_renderer<float>(scene);
    cistula::FrameSettings settings;
    settings.set_size(32, 24);
    cistula::Film film;
    cistula::RenderProgress progress;
    if (!renderer->render(cistula::camera_at(description.camera, 0), settings, film, progress)) return 1;

    const cistula::PixelRecord& center = film.pixels.at(12 * 32 + 16);
    const cistula::PixelRecord& corner = film.pixels.at(0);
    if (center.id != 1 || corner.id != 0) {
        std::fprintf(stderr, "id %d in the middle, %d in the corner\n", center.id, corner.id);
        return 1;
    }
    for (int i = 1; i < argc; ++i) {
        cistula::write_preview(argv[i], {2, 1, {glm::vec3(0), glm::vec3(1)}});
        if (cistula::read_texture(argv[i]).texels.at(1) != glm::vec3(1)) return 1;
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
