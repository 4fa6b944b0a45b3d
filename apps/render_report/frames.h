// Rendering and timing of single frames of one scene: every frame of the report goes through here.
#pragma once

#include "progress.h"
#include "renderers.h"
#include "scene/camera_path.h"
#include "scene/film.h"

namespace cistula::report {

class Frames {
  public:
    Frames(const SceneDescription& scene, const Machine& machine, int width, int height, Progress& progress);

    /// Seconds of wall clock. Throws Error: interrupted after Ctrl-C, failed where the frame cannot be trusted.
    double render(const Setting& setting, Film& film, uint32_t effects = 0);
    double render(Renderer& renderer, const FrameSettings& settings, Film& film);

    /// Milliseconds of the frame just rendered: of its kernels where the renderer tells, else all `seconds`.
    double kernel_ms(const Setting& setting, double seconds);

    Renderers renderers;
    const SceneDescription& scene;
    const CameraFrame camera;
    const int width, height;
    Progress& progress;
};

/// Throws Error (interrupted) if Ctrl-C was pressed.
void check_interrupt(const Progress& progress);

}  // namespace cistula::report
