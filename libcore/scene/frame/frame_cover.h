// Which pixels of a frame can show anything but background: none outside the outlines of the scene's hulls.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "cistula/transport/pixel.h"
#include "scene/compile/hull.h"
#include "scene/film/film.h"

namespace cistula {

/// Columns [begin, end) of a rectangle.
struct PixelRun {
    int begin = 0, end = 0;

    bool operator==(const PixelRun&) const = default;
};

/// By bands of rows of a frame's rectangle, the columns whose pixels may show something. Conservative: hulls are grown
/// by far more than rounding moves a ray or a face (some u M). No ray is needed anywhere else.
class FrameCover {
  public:
    static constexpr int band_rows = 4;

    /// Covers nothing.
    explicit FrameCover(const PixelRect& rect)
        : rect_(rect), bands_(size_t((rect.height + band_rows - 1) / band_rows)) {}

    const PixelRect& rect() const { return rect_; }
    /// Pixels of its bands, whole ones.
    size_t pixels() const;

    /// Ascending and apart; `row` counts from the top of the rectangle.
    std::span<const PixelRun> runs(int row) const { return bands_[size_t(row / band_rows)]; }

    /// The outline of one hull: a run, maybe empty, for each of some bands.
    struct Outline {
        static constexpr size_t all = ~size_t{0};

        size_t hull;  // its number, or all: it holds whatever the scene has
        int first_band;
        std::vector<PixelRun> runs;

        /// The run in a row of the rectangle; empty beyond the bands.
        PixelRun run(int row) const {
            const int band = row / band_rows - first_band;
            return band < 0 || band >= int(runs.size()) ? PixelRun() : runs[size_t(band)];
        }
    };
    const std::vector<Outline>& outlines() const { return outlines_; }

    /// visit(begin, end, covered) for all columns from `from` to `to` of a row, from left to right.
    template <class Visit>
    void for_each_part(int row, int from, int to, const Visit& visit) const {
        for (const PixelRun& run : runs(row)) {
            const int begin = std::clamp(run.begin, from, to), end = std::clamp(run.end, from, to);
            if (begin > from) visit(from, begin, false);
            if (end > begin) visit(begin, end, true);
            from = std::max(from, end);
        }
        if (to > from) visit(from, to, false);
    }

    /// Covers everything, for a hull that holds the camera.
    void add_all(size_t number);
    /// Covers what hull `number` may show; `extent`: the scene's M.
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
