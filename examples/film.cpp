// Renders those frames of a film that are not there yet: after an interruption, the same command goes on.
// usage: film SCENE.json NAME.####.exr FRAMES, such as 0-9
#include <cistula.h>

#include <cstdio>

using namespace cistula;

struct Teller : SequenceEvents {
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
    request.output = argv[2];
    request.frames = parse_frames(argv[3]);
    request.resume = true;
    Teller teller;
    RenderProgress progress;  // setting progress.stop ends it after the frames in work
    render_sequence(request, teller, progress);
} catch (const std::exception& error) {
    std::fprintf(stderr, "film: %s\n", error.what());
    return 1;
}
