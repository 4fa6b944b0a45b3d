// The frames of a film: rendered one after the other, each written while the next ones render.
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

/// All that the frames have in common.
struct FilmJob {
    const FilmOptions& options;
    const SceneDescription& scene;
    const std::string& scene_hash;
    const FrameSettings& settings;
    const OutputName& output;
    const OutputName& preview;  // empty text: none
    const std::vector<int>& frames;
};

/// Renders and writes. Fills stats.frames. Throws Error: failed where a frame's flags say that it cannot be trusted
/// (its file is not written), file where one cannot be written, interrupted where progress.stop was set from outside
/// (frames finished by then are whole).
void render_film(const FilmJob& job, Renderer& renderer, RenderProgress& progress, RunStats& stats);

/// What may be on its way to files while frames render.
WriterLimits writer_limits(const FilmOptions& options);

}  // namespace cistula
