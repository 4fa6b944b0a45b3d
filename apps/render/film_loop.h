// The frames of a film: rendered one after the other, each written while the next ones render.
#pragma once

#include <string>
#include <vector>

#include "frame_writer.h"
#include "options.h"
#include "output_name.h"
#include "scene/renderer.h"
#include "stats.h"

namespace cistula {

/// All that the frames have in common.
struct FilmJob {
    const RenderOptions& options;
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
WriterLimits writer_limits(const RenderOptions& options);

/// What the flags of a film mean, for a message.
std::string describe_flags(uint32_t flags);

}  // namespace cistula
