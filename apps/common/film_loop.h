// The frame loop of a film: frames are rendered one after the other, and each is written while the next ones render.
#pragma once

#include <string>
#include <vector>

#include "apps/common/film_options.h"
#include "apps/common/frame_writer.h"
#include "apps/common/output_name.h"
#include "apps/common/stats.h"
#include "scene/description/description.h"
#include "scene/film/renderer.h"

namespace cistula {

/// The parameters shared by all frames.
struct FilmJob {
    const FilmOptions& options;
    const SceneDescription& scene;
    const std::string& scene_hash;
    const FrameSettings& settings;
    const OutputName& output;
    const OutputName& preview;  // empty text: none
    const std::vector<int>& frames;
};

/// Renders and writes all frames, and fills stats.frames. Throws Error: `failed` if a frame's flags make it unreliable
/// (its file is not written), `file` if a file cannot be written, `interrupted` if progress.stop was set from outside
/// (frames finished by then are complete).
void render_film(const FilmJob& job, Renderer& renderer, RenderProgress& progress, RunStats& stats);

/// Limits for frames being written while others render.
WriterLimits writer_limits(const FilmOptions& options);

}  // namespace cistula
