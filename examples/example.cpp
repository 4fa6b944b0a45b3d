// Renders the first frame of a scene as `render` does: the same file, byte for byte.
// usage: example SCENE.json FILE.exr FILE.png
#include <cistula.h>

#include <cstdio>

using namespace cistula;

int main(int argc, char** argv) try {
    if (argc != 4) {
        std::fputs("usage: example SCENE.json FILE.exr FILE.png\n", stderr);
        return 2;
    }
    // Read, and compile: in float, or in double where a part of the scene is too small for that.
    const SceneDescription description = read_scene(argv[1]);
    const Scene scene(description);
    if (!scene.precision_note().empty()) std::fprintf(stderr, "%s\n", scene.precision_note().c_str());
    for (const std::string& warning : scene.warnings()) std::fprintf(stderr, "warning: %s\n", warning.c_str());

    // Render.
    const std::unique_ptr<Renderer> renderer = make_embree_renderer(scene);
    const FrameSettings settings = frame_settings(description);
    const CameraFrame camera = camera_at(description.camera, 0);
    Film film;
    RenderProgress progress;
    renderer->render(camera, settings, film, progress);
    if (film.flags != 0) throw Error(ErrorKind::failed, "the frame cannot be trusted");

    // Save.
    LayeredPicture picture = to_layers(film, {});
    picture.attributes.merge(
        header_attributes(film, description.film, scene.hashes(), settings, scene.precision(), camera));
    write_exr(argv[2], picture);
    write_preview(argv[3], to_color(film));
} catch (const std::exception& error) {
    std::fprintf(stderr, "example: %s\n", error.what());
    return 1;
}
