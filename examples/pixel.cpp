// Prints the ray trees of a pixel of a scene's first frame as JSON.
// usage: pixel SCENE.json X Y, from the top left
#include <cistula.h>

#include <cstdio>

using namespace cistula;

int main(int argc, char** argv) try {
    if (argc != 4) {
        std::fputs("usage: pixel SCENE.json X Y\n", stderr);
        return 2;
    }
    const int x = std::stoi(argv[2]);
    const int y = std::stoi(argv[3]);
    const SceneDescription description = read_scene(argv[1]);
    const Scene scene(description);
    const std::unique_ptr<Renderer> renderer = make_embree_renderer(scene);
    const FrameSettings settings = frame_settings(description);
    const CameraFrame camera = camera_at(description.camera, 0);
    PixelTree tree = renderer->pixel_tree(camera, settings, x, y);  // many may be asked for
    const std::string flaws = describe_flags(tree.film.flags, tree.crowd);
    const PixelReport report{x,        y,      scene.precision(), description.source,   scene.names(),
                             settings, camera, std::move(tree),   scene.hashes().of(0), flaws};
    std::fputs(pixel_json(report).c_str(), stdout);
} catch (const std::exception& error) {
    std::fprintf(stderr, "pixel: %s\n", error.what());
    return 1;
}
