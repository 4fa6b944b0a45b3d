// Precomputed hints for a frame: which pixels may show something, and the result of all others.
#pragma once

#include "render/frame/frame_cover.h"
#include "render/renderer.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// The result for a pixel that shows only background.
struct BackgroundPixel {
    PixelRecord record;
    PixelWork work;
    uint64_t units = 0;  // units_lost

    /// Counts `pixels` such pixels.
    void count(uint64_t pixels, FrameCounts& counts) const {
        if (pixels == 0) return;
        counts.rays.primary += pixels * work.rays.primary;
        counts.flags |= work.flags;
        counts.totals.add(record, units, pixels);
    }
};

/// Hints for a frame; `cover` is over settings.crop.
struct FrameHints {
    FrameCover cover;
    BackgroundPixel background, checked;  // checked: with a target error, of pixels that are
    bool adaptive = false;

    /// Writes `count` pixels of a row, from (x, y) of the frame on, that show only background. `first`: the film's
    /// number of the first of them.
    void fill(const PixelWriter& writer, int x, int y, int count, size_t first, FrameCounts& counts) const {
        int checks = 0;
        for (int begin = 0, end = 0; begin < count; begin = ++end) {
            while (end < count && !(adaptive && is_checked(x + end, y))) ++end;
            writer.fill(first + size_t(begin), size_t(end - begin), background.record);
            if (end == count) break;
            writer.put(first + size_t(end), checked.record);
            ++checks;
        }
        background.count(uint64_t(count - checks), counts);
        checked.count(uint64_t(checks), counts);
    }
};
template <class Real>
FrameHints frame_hints(const CompiledScene<Real>& scene, const FrameView& frame, const FrameSettings& settings);

}  // namespace cistula
