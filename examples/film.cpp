// Renders those frames of a film that are not there yet: after an interruption, the same command goes on.
// usage: film SCENE.json NAME.####.exr FRAMES, such as 0-9
#include <cistula.h>

#include <cstdio>

using namespace cistula;

struct Teller : FilmEvents {
    void kept(int, const std::string& file) override { std::printf("%s: kept\n", file.c_str()); }
    void written(const FrameStats& frame) override {
        std::printf("%s: %.3f s\n", frame.file.c_str(), frame.render_seconds);
    }
    void warning(const std::string& line) override { std::fprintf(stderr, "warning: %s\n", line.c_str()); }
};

int main(int argc, char** argv) try {
    if (argc != 4) {
        std::fputs("usage: film SCENE.json NAME.####.exr FRAMES\n", stderr);
        return 2;
    }
    RenderRequest request;
    request.scene = argv[1];
    request.resume = true;
    const SceneDescription description = read_scene(request);
    const FrameSettings settings = frame_settings(request, description);
    const OutputName images(argv[2], "NAME"), no_previews;
    const std::vector<int> frames = parse_frames(argv[3]);
    make_directories(images, frames);

    const Scene scene(description);
    const std::unique_ptr<Renderer> renderer = make_renderer(Backend::embree, scene, {});
    Teller teller;
    FilmJob film{request,     description, scene.hashes(), settings,         images,
                 no_previews, frames,      teller,         scene.precision()};
    film.layer_names = scene.layer_names();
    RenderProgress progress;  // setting progress.stop ends it after the frames in work
    RunStats stats;
    render_film(film, *renderer, progress, stats);
} catch (const std::exception& error) {
    std::fprintf(stderr, "film: %s\n", error.what());
    return 1;
}
