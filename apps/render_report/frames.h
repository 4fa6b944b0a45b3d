// Rendering and timing of single frames of one scene: every frame of the report goes through here.
#pragma once

#include <limits>
#include <optional>

#include "apps/common/step_progress.h"
#include "renderers.h"
#include "scene/description/camera_path.h"
#include "scene/film/film.h"

namespace cistula::report {

/// Frames that take longer are stopped: ray trees may be endless.
struct FrameLimit {
    double whole = std::numeric_limits<double>::infinity();  // seconds of wall clock
    double still = std::numeric_limits<double>::infinity();  // the same, in which no pixel is done
};

class Frames {
  public:
    Frames(const SceneDescription& scene, const Machine& machine, int width, int height, StepProgress& progress);

    /// Seconds of wall clock. Throws Error: interrupted after Ctrl-C, failed where the frame cannot be trusted.
    double render(const Setting& setting, Film& film, uint32_t effects = 0);
    double render(Renderer& renderer, const FrameSettings& settings, Film& film);
    /// The seconds of render(), or nothing where the limit was passed.
    std::optional<double> render_within(const FrameLimit& limit, const Setting& setting, Film& film);

    /// Milliseconds of the frame just rendered: of its kernels where the renderer tells, else all `seconds`.
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
