// Renders the first frame of a scene as `render` does: the same file, byte for byte.
// usage: example SCENE.json FILE.exr FILE.png
#include <cistula.h>

#include <backend_embree/embree/embree_renderer.h>

#include <cstdio>

using namespace cistula;

template <class Real>
void render(SceneSource source, Precision precision, const char* exr, const char* png) {
    const SceneDescription& scene = *source.description;

    // Compile.
    const std::shared_ptr<const CompiledScene<Real>> compiled = compile_scene<Real>(std::move(source));
    for (const std::string& warning : compiled->warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());

    // Render.
    const std::unique_ptr<Renderer> renderer = make_embree_renderer<Real>(compiled);
    const FrameSettings settings = frame_settings(scene);
    const CameraFrame camera = camera_at(scene.camera, 0);
    Film film;
    RenderProgress progress;
    renderer->render(camera, settings, film, progress);
    if (film.flags != 0) throw Error(ExitCode::failed, scene.source + ": the frame cannot be trusted");

    // Save.
    LayeredPicture picture = to_layers(film, {});
    picture.attributes.merge(header_attributes(compiled->hashes, settings, precision, camera));
    add_film_attributes(scene.film, picture.attributes);
    write_exr(exr, picture);
    write_preview(png, to_color(film));
}

int main(int argc, char** argv) try {
    if (argc != 4) {
        std::fputs("usage: example SCENE.json FILE.exr FILE.png\n", stderr);
        return 2;
    }
    // Read: the scene, then the meshes that it names.
    const SceneDescription scene = read_scene(argv[1]);
    SceneSource source = gather_scene(scene);

    // Float, or double where a part of the scene is too small for it.
    const PrecisionChoice choice = choose_precision({}, smallest_part(source));
    if (!choice.note.empty()) std::fprintf(stderr, "%s\n", choice.note.c_str());
    if (choice.precision == Precision::double_)
        render<double>(std::move(source), choice.precision, argv[2], argv[3]);
    else
        render<float>(std::move(source), choice.precision, argv[2], argv[3]);
} catch (const Error& error) {
    std::fprintf(stderr, "example: %s\n", error.what());
    return static_cast<int>(error.code());
} catch (const std::exception& error) {
    std::fprintf(stderr, "example: %s\n", error.what());
    return 1;
}
