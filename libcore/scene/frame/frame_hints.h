// Precomputed hints for a frame: which pixels may show something, and the result of all others.
#pragma once

#include "scene/compile/compiled_scene.h"
#include "scene/film/renderer.h"
#include "scene/frame/frame_cover.h"

namespace cistula {

/// The result for a pixel that shows only background.
struct BackgroundPixel {
    PixelRecord record;
    PixelWork work;

    /// Adds the ray counts and flags of `pixels` such pixels.
    void count(uint64_t pixels, RayCounts& rays, uint32_t& flags) const {
        if (pixels == 0) return;
        rays.primary += pixels * work.rays.primary;
        flags |= work.flags;
    }
};

/// Hints for a frame; `cover` is over settings.crop.
struct FrameHints {
    FrameCover cover;
    BackgroundPixel background;
};
template <class Real>
FrameHints frame_hints(const CompiledScene<Real>& scene, const FrameView& frame, const FrameSettings& settings);

}  // namespace cistula
