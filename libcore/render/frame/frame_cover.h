// The pixels of a frame that can show anything but background: those inside the outlines of the scene's hulls.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "cistula/transport/pixel.h"
#include "render/record/film.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// Columns [begin, end) of a rectangle.
struct PixelRun {
    int begin = 0;
    int end = 0;

    bool operator==(const PixelRun&) const = default;
};

/// Columns whose pixels may show something, for each band of rows of a frame's rectangle. Conservative: hulls are
/// enlarged by far more than rounding moves a ray or a face (a few u M). All other pixels need no ray.
class FrameCover {
  public:
    static constexpr int band_rows = 4;

    /// A cover of no pixels.
    explicit FrameCover(const PixelRect& rect)
        : rect_(rect), bands_(size_t((rect.height + band_rows - 1) / band_rows)) {}

    const PixelRect& rect() const { return rect_; }
    /// Number of covered pixels, rounded up to whole bands.
    size_t pixels() const;

    /// The runs of a row, ascending and disjoint; `row` counts from the top of the rectangle.
    std::span<const PixelRun> runs(int row) const { return bands_[size_t(row / band_rows)]; }

    /// The cover by one hull: one run, possibly empty, for each of a range of bands.
    struct Outline {
        static constexpr size_t all = ~size_t{0};

        size_t hull;  // the hull's number, or `all` for everything in the scene
        int first_band;
        std::vector<PixelRun> runs;

        /// The run of a row of the rectangle; empty outside the bands.
        PixelRun run(int row) const {
            const int band = row / band_rows - first_band;
            return band < 0 || band >= int(runs.size()) ? PixelRun() : runs[size_t(band)];
        }
    };
    const std::vector<Outline>& outlines() const { return outlines_; }

    /// Calls visit(begin, end, covered) for the columns [from, to) of a row, from left to right.
    template <class Visit>
    void for_each_part(int row, int from, int to, const Visit& visit) const {
        for (const PixelRun& run : runs(row)) {
            const int begin = std::clamp(run.begin, from, to);
            const int end = std::clamp(run.end, from, to);
            if (begin > from) visit(from, begin, false);
            if (end > begin) visit(begin, end, true);
            from = std::max(from, end);
        }
        if (to > from) visit(from, to, false);
    }

    /// Covers the whole rectangle, for hull `number` that contains the camera.
    void add_all(size_t number);
    /// Covers the outline of hull `number`; `extent`: the scene's M.
    void add(size_t number, const Hull& hull, double extent, const FrameView& frame);

  private:
    struct Point {
        double x, y;  // in pixels from the rectangle's top left corner
    };
    std::optional<std::vector<Point>> projected(const Hull& hull, double extent, const FrameView& frame) const;
    Outline filled(size_t number, const std::vector<Point>& corners) const;
    void add(Outline outline);

    PixelRect rect_;
    std::vector<std::vector<PixelRun>> bands_;
    std::vector<Outline> outlines_;
};

}  // namespace cistula
