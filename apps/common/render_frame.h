// One frame of a film, with tables of objects as large as it needs.
#pragma once

#include "scene/film/renderer.h"

namespace cistula {

/// Renders a frame; again with larger tables of objects where a pixel shows more than they hold, which the settings
/// then keep for the next frame. False if it was stopped; the film is then incomplete.
bool render_frame(Renderer& renderer, const CameraFrame& camera, FrameSettings& settings, Film& film,
                  RenderProgress& progress);

}  // namespace cistula
