// How long the tiles of a film take, estimated from small frames.
#pragma once

#include "apps/common/step_progress.h"
#include "plan.h"
#include "render/picture_size.h"
#include "render/renderer.h"
#include "scene/description/description.h"

namespace cistula {

/// Renders frames with a sixteenth of the pixels, a sample each (with a target error as many as it wants), at most 64
/// of the film, and counts the rays of each tile; a ray takes as long as one of these did on average. Throws Error
/// (interrupted).
MeasuredFrames measure_tiles(Renderer& renderer, const SceneDescription& scene, const FrameSettings& settings,
                             const std::vector<int>& frames, const TileGrid& grid, StepProgress& progress);

/// The settings of a small frame, of the same part of the picture.
FrameSettings small_settings(const FrameSettings& settings);

/// The rays of a small frame's pixels, by the tiles of the frame that it stands for.
std::vector<double> rays_of_tiles(const Film& small, const FrameSettings& settings, const TileGrid& grid);

}  // namespace cistula
