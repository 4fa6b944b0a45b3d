// Rendering and timing of single frames of one scene; all frames of the report are rendered here.
#pragma once

#include <limits>
#include <optional>

#include "apps/common/step_progress.h"
#include "render/record/film.h"
#include "renderers.h"
#include "scene/description/camera_path.h"

namespace cistula::report {

/// Time limits of a frame, since ray trees may be endless.
struct FrameLimit {
    double whole = std::numeric_limits<double>::infinity();  // seconds of wall clock
    double still = std::numeric_limits<double>::infinity();  // seconds of wall clock in which no pixel is completed
};

class Frames {
  public:
    Frames(const SceneDescription& scene, const Machine& machine, int width, int height, StepProgress& progress);

    /// Renders a frame and returns the wall time in seconds. Throws Error: `interrupted` after Ctrl-C, `failed` if the
    /// frame is unreliable.
    double render(const Setting& setting, Film& film, uint32_t effects = 0);
    double render(Renderer& renderer, const FrameSettings& settings, Film& film);
    /// Renders a frame and returns the wall time in seconds, or nothing if a limit was exceeded.
    std::optional<double> render_within(const FrameLimit& limit, const Setting& setting, Film& film);

    /// Time of the last frame in milliseconds: of its kernels if the renderer measures them, else all `seconds`.
    double kernel_ms(const Setting& setting, double seconds);

    Renderers renderers;
    const SceneDescription& scene;
    const CameraFrame camera;
    const int width, height;
    StepProgress& progress;

  private:
    void begin();
    void check(const Film& film) const;
};

/// Throws Error (interrupted) if Ctrl-C was pressed.
void check_interrupt(const StepProgress& progress);

}  // namespace cistula::report
