// Precomputed hints for a frame: which pixels may show something, and the result of all others.
#pragma once

#include "scene/compile/compiled_scene.h"
#include "scene/film/put_pixels.h"
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
    BackgroundPixel background, checked;  // checked: with a target error, of pixels that are
    bool adaptive = false;

    /// Writes `count` pixels of a row, from (x, y) of the frame on, that show only background.
    void fill(const PixelWriter& writer, int x, int y, int count, PixelRecord* to, RayCounts& rays,
              uint32_t& flags) const {
        int checks = 0;
        for (int begin = 0, end = 0; begin < count; begin = ++end) {
            while (end < count && !(adaptive && is_checked(x + end, y))) ++end;
            writer.fill(to + begin, size_t(end - begin), background.record);
            if (end == count) break;
            writer.fill(to + end, 1, checked.record);
            ++checks;
        }
        background.count(uint64_t(count - checks), rays, flags);
        checked.count(uint64_t(checks), rays, flags);
    }
};
template <class Real>
FrameHints frame_hints(const CompiledScene<Real>& scene, const FrameView& frame, const FrameSettings& settings);

}  // namespace cistula
