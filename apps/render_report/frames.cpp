#include "frames.h"

#include <fmt/format.h>

#include "apps/render/film_loop.h"
#include "apps/render/stats.h"
#include "scene/error.h"

namespace cistula::report {

Frames::Frames(const SceneDescription& description, const Machine& machine, int frame_width, int frame_height,
               Progress& watched)
    : renderers(description, machine),
      scene(description),
      camera(camera_at(description.camera, 0)),
      width(frame_width),
      height(frame_height),
      progress(watched) {}

void check_interrupt(const Progress& progress) {
    if (progress.render.stop) throw Error(ExitCode::interrupted, "interrupted; nothing was written");
}

double Frames::render(const Setting& setting, Film& film, uint32_t effects) {
    FrameSettings settings = frame_settings(setting, width, height);
    settings.effects = effects;
    return render(renderers.of(setting), settings, film);
}

double Frames::kernel_ms(const Setting& setting, double seconds) {
    const double kernel = renderers.of(setting).times().kernel;
    return 1e3 * (kernel > 0 ? kernel : seconds);
}

double Frames::render(Renderer& renderer, const FrameSettings& settings, Film& film) {
    check_interrupt(progress);
    progress.render.pixels_done = 0;
    progress.render.rays = 0;
    const double seconds = seconds_of([&] { renderer.render(camera, settings, film, progress.render); });
    check_interrupt(progress);
    if (film.flags != 0)
        throw Error(ExitCode::failed,
                    fmt::format("{}: a frame cannot be trusted: {}", scene.source, describe_flags(film.flags)));
    return seconds;
}

}  // namespace cistula::report
