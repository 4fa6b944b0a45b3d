// Which pixels may show a solid in a mirror: what takes longest there is worth beginning with.
#pragma once

#include "scene/compiled_scene.h"
#include "scene/frame_cover.h"

namespace cistula {

/// The outlines of convex solids as the plane of each sheet that mirrors shows them to the camera, by the solids'
/// numbers; of a sheet that is not flat, as its first triangle's does. They go on beyond the sheet, and nothing hides
/// them. None in scenes of more than a SmallScene holds. `rect`: of the frame.
template <class Real>
FrameCover mirrored_cover(const CompiledScene<Real>& scene, const FrameView& frame, const PixelRect& rect);

}  // namespace cistula
