// The rules of adaptive sampling. Each decides whether a cell of the sample lattice is split instead of being
// represented by its corners. docs/decisions/0035-fewer-adaptive-rules.md tells what each gains, and which rules were
// given up.
#pragma once

#include "cistula/adaptive/lattice_cell.h"

namespace cistula {

/// Statistics of a cell's corner samples, and of the middle sample of a whole pixel. Color differences are maxima over
/// the channels.
struct CornerFindings {
    bool differs = false;    // whether the path hashes differ
    uint32_t most_rays = 0;  // rays of the largest tree
    int64_t range = 0;       // between the darkest and the brightest corner
    int64_t across = 0;      // along the upper or lower side
    int64_t down = 0;        // along the left or right side

    CISTULA_INLINE static CornerFindings of(const LatticeSample* samples, const LatticeCell& cell) {
        const bool has_middle = cell.is_whole();
        const LatticeSample* at[4];
        for (int c = 0; c < 4; ++c) at[c] = samples + cell.corner(c);
        CornerFindings found;
        found.most_rays = at[0]->rays;
        for (int c = 1; c < 4; ++c) found.add(*at[c], *at[0]);
        if (has_middle) found.add(samples[lattice_middle], *at[0]);
        for (int c = 0; c < 3; ++c) {
            const int64_t a = at[0]->color(c);
            const int64_t b = at[1]->color(c);
            const int64_t d = at[2]->color(c);
            const int64_t e = at[3]->color(c);
            int64_t low = min_or_second(min_or_second(a, b), min_or_second(d, e));
            int64_t high = max_or_second(max_or_second(a, b), max_or_second(d, e));
            if (has_middle) {
                const int64_t m = samples[lattice_middle].color(c);
                low = min_or_second(low, m);
                high = max_or_second(high, m);
            }
            found.range = max_or_second(found.range, high - low);
            found.across = max_or_second(found.across, max_or_second(magnitude(a - b), magnitude(d - e)));
            found.down = max_or_second(found.down, max_or_second(magnitude(a - d), magnitude(b - e)));
        }
        return found;
    }

  private:
    CISTULA_INLINE void add(const LatticeSample& sample, const LatticeSample& first) {
        differs |= sample.path_hash != first.path_hash;
        most_rays = max_or_second(most_rays, sample.rays);
    }
};

/// Statistics of a pixel so far: the maxima over its cells.
struct PixelFindings {
    uint32_t rays = 0;  // of the largest tree
    int64_t range = 0;  // of the colors in a cell

    CISTULA_INLINE void add(const LatticeCell& cell) {
        rays = max_or_second(rays, cell.rays);
        range = max_or_second(range, cell.range);
    }
};

/// Splits a cell whose corners disagree: the range of their colors times the cell's area, which bounds the error of an
/// edge through the cell, may be a quarter of the target.
struct CornersDisagree {
    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const LatticeCell& cell,
                                      const CornerFindings& found) {
        return settings.exceeded_by(4 * found.range, cell.area());
    }
};

/// The row or column of samples right beside a cell, on side 0 left, 1 right, 2 upper or 3 lower. It lies outside the
/// pixel where the cell ends at the pixel's border.
struct CellSide {
    bool upright;
    int x, y, length;  // position of the first sample; number of samples
    int first, last;   // the cell's corners at the ends of the side

    CISTULA_INLINE static CellSide of(const LatticeCell& cell, int side) {
        CellSide s;
        s.upright = side < 2;
        const bool far = side % 2 != 0;
        const int across = s.upright ? cell.width : cell.height;
        s.length = s.upright ? cell.height : cell.width;
        s.x = cell.x + (s.upright ? (far ? across : -1) : 0);
        s.y = cell.y + (s.upright ? 0 : (far ? across : -1));
        s.first = far ? (s.upright ? 1 : 2) : 0;
        s.last = far ? 3 : s.upright ? 2 : 1;
        return s;
    }

    CISTULA_INLINE bool is_inside() const { return x >= 0 && y >= 0 && x < lattice_side && y < lattice_side; }
    CISTULA_INLINE int slot(int k) const { return upright ? (y + k) * lattice_side + x : y * lattice_side + x + k; }
    /// Whether sample k is among those of `rows`, one bit per column.
    CISTULA_INLINE bool is_in(const uint16_t* rows, int k) const {
        return (rows[slot(k) / lattice_side] >> slot(k) % lattice_side & 1) != 0;
    }
};

/// Splits a cell if a sample right beside it, between two of its corners, is brighter or darker than both by so much
/// that, over all of the cell, it would be worth more than two thirds of the target. A feature that enters through that
/// side, such as the tip of a mirrored edge or a stripe of a texture, may end before it reaches a corner.
struct SideCrossed {
    /// `rows`: the samples to look at, by row, one bit per column.
    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const LatticeSample* samples,
                                      const LatticeCell& cell, const uint16_t* rows) {
        for (int i = 0; i < 4; ++i) {
            const CellSide side = CellSide::of(cell, i);
            if (!side.is_inside()) continue;
            const LatticeSample& a = samples[cell.corner(side.first)];
            const LatticeSample& b = samples[cell.corner(side.last)];
            for (int k = 1; k < side.length - 1; ++k)
                if (side.is_in(rows, k) && stands_out(settings, a, b, samples[side.slot(k)], cell.area())) return true;
        }
        return false;
    }

  private:
    CISTULA_INLINE static bool stands_out(const LatticeSettings& settings, const LatticeSample& a,
                                          const LatticeSample& b, const LatticeSample& beside, int64_t area) {
        for (int c = 0; c < 3; ++c) {
            const int64_t one = a.color(c);
            const int64_t other = b.color(c);
            const int64_t there = beside.color(c);
            const int64_t beyond = max_or_second(min_or_second(one, other) - there, there - max_or_second(one, other));
            if (3 * beyond * area > 2 * settings.target * lattice_samples) return true;
        }
        return false;
    }
};

/// Splits a cell whose corners have different path hashes if it is larger than an eighth of the pixel, or if half of
/// it, with the greatest color range of any cell of the pixel, would exceed the target. A feature that one place of the
/// pixel shows may be hidden in another; the tip of a texel between two texels of one color, in any.
struct UnlikeCorners {
    static constexpr int largest_area = lattice_samples / 8;

    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const PixelFindings& pixel,
                                      const LatticeCell& cell) {
        return cell.differs && (cell.area() > largest_area || settings.exceeded_by(pixel.range, cell.area() / 2));
    }
};

/// Splits a cell of more than a sixteenth of the pixel if the pixel has a large ray tree and an unseen change of 1/32
/// of the radiance bound would exceed the target in the cell. Large trees see so much that some of it, such as the
/// mirrored image of a small light, lies between samples that agree, even if their own trees are small: a light ends a
/// tree early.
struct LargeTrees {
    static constexpr uint32_t large_tree = 16;  // rays
    static constexpr int64_t unseen_range = (int64_t(1) << color_bits) / 32;
    static constexpr int largest_area = lattice_samples / 16;

    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const PixelFindings& pixel, int64_t area) {
        return pixel.rays >= large_tree && area > largest_area && settings.exceeded_by(unseen_range, area);
    }
};

}  // namespace cistula
