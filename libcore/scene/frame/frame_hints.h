// Where a frame may show something, and what is everywhere else.
#pragma once

#include "scene/compile/compiled_scene.h"
#include "scene/film/renderer.h"
#include "scene/frame/frame_cover.h"

namespace cistula {

/// What rendering leaves of a pixel that shows background alone.
struct BackgroundPixel {
    PixelRecord record;
    PixelWork work;

    /// Adds what so many of them count.
    void count(uint64_t pixels, RayCounts& rays, uint32_t& flags) const {
        if (pixels == 0) return;
        rays.primary += pixels * work.rays.primary;
        flags |= work.flags;
    }
};

/// `cover` is over settings.crop.
struct FrameHints {
    FrameCover cover;
    BackgroundPixel background;
};
template <class Real>
FrameHints frame_hints(const CompiledScene<Real>& scene, const FrameView& frame, const FrameSettings& settings);

}  // namespace cistula
