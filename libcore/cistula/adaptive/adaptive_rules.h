// The rules of adaptive sampling. Each decides whether a cell of the sample lattice is split instead of being
// represented by its corners. docs/decisions/0007-adaptive-rules.md tells what each gains, and which rules were given
// up.
#pragma once

#include "cistula/adaptive/lattice_cell.h"

namespace cistula {

/// Statistics of a cell's corner samples, and of the middle sample of a whole pixel if it was taken. Color differences
/// are maxima over the channels.
struct CornerFindings {
    bool differs = false;          // whether the path hashes differ
    uint32_t most_rays = 0;        // rays of the largest tree
    int64_t range = 0;             // between the darkest and the brightest corner
    int64_t bend = 0;              // difference of the diagonals' means (or of the middle from them), times two
    int64_t across = 0, down = 0;  // along the upper or lower side; along the left or right side

    CISTULA_INLINE static CornerFindings of(const LatticeSample* samples, const LatticeCell& cell, bool has_middle) {
        const LatticeSample* at[4];
        for (int c = 0; c < 4; ++c) at[c] = samples + cell.corner(c);
        CornerFindings found;
        found.most_rays = at[0]->rays;
        for (int c = 1; c < 4; ++c) found.add(*at[c], *at[0]);
        if (has_middle) found.add(samples[lattice_middle], *at[0]);
        for (int c = 0; c < 3; ++c) {
            const int64_t a = at[0]->color(c), b = at[1]->color(c), d = at[2]->color(c), e = at[3]->color(c);
            int64_t low = min_or_second(min_or_second(a, b), min_or_second(d, e)),
                    high = max_or_second(max_or_second(a, b), max_or_second(d, e));
            if (has_middle) {
                const int64_t m = samples[lattice_middle].color(c);
                low = min_or_second(low, m);
                high = max_or_second(high, m);
                // The difference of the middle from the mean of the corners, times four. It counts half: as much as the
                // diagonals' difference without a middle.
                found.bend = max_or_second(found.bend, magnitude(4 * m - a - b - d - e) / 2);
            } else {
                found.bend = max_or_second(found.bend, magnitude(a + e - b - d));
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
    uint32_t rays = 0, first_rays = 0;  // of the largest tree; of the largest among the first samples
    int64_t range = 0;                  // of the colors in a cell
    int64_t jump = 0;                   // between corners of a small cell with equal path hashes

    CISTULA_INLINE void add(const LatticeCell& cell) {
        rays = max_or_second(rays, cell.rays);
        if (cell.is_whole()) first_rays = cell.rays;
        range = max_or_second(range, cell.range);
        jump = max_or_second(jump, cell.jump);
    }
};

/// Splits a cell whose corners disagree. The range of their colors times the cell's area bounds the error of an edge
/// through the cell. If the corners have different path hashes, that may be an eighth of the target (a quarter in a
/// whole pixel and for coarse targets). If they have equal ones, shading varies gradually unless it is textured, and
/// the limit is three eighths of the target (three quarters for coarse targets). The means of the two diagonals may
/// differ by the target itself.
struct CornersDisagree {
    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const LatticeCell& cell,
                                      const CornerFindings& found) {
        const int64_t area = cell.area(), of_borders = settings.fine && !cell.is_whole() ? 8 : 4;
        return (found.differs && settings.exceeded_by(of_borders * found.range, area)) ||
               settings.exceeded_by(found.bend, area) ||
               (settings.fine ? 8 : 4) * found.range * area > 3 * settings.target * lattice_samples;
    }
};

/// The row or column of samples right beside a cell, on side 0 left, 1 right, 2 upper or 3 lower. It lies outside the
/// pixel where the cell ends at the pixel's border.
struct CellSide {
    bool upright;
    int x, y, length;  // position of the first sample; number of samples
    int size;          // of the cell, perpendicular to the side
    int first, last;   // the cell's corners at the ends of the side
    int opposite;      // bit of a corner's number that selects the side or the one opposite

    CISTULA_INLINE static CellSide of(const LatticeCell& cell, int side) {
        CellSide s;
        s.upright = side < 2;
        const bool far = side % 2 != 0;
        s.size = s.upright ? cell.width : cell.height;
        s.length = s.upright ? cell.height : cell.width;
        s.x = cell.x + (s.upright ? (far ? s.size : -1) : 0);
        s.y = cell.y + (s.upright ? 0 : (far ? s.size : -1));
        s.first = far ? (s.upright ? 1 : 2) : 0;
        s.last = far ? 3 : s.upright ? 2 : 1;
        s.opposite = s.upright ? 1 : 2;
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
            const int64_t one = a.color(c), other = b.color(c), there = beside.color(c);
            const int64_t beyond = max_or_second(min_or_second(one, other) - there, there - max_or_second(one, other));
            if (3 * beyond * area > 2 * settings.target * lattice_samples) return true;
        }
        return false;
    }
};

/// For small targets: splits a cell if a sample right beside a corner gives a slope that, extrapolated across the cell,
/// misses the opposite corner by so much that the difference over the whole cell would exceed the target. All three
/// samples must have equal path hashes: shading then bends inside the cell, although its corners agree.
struct SlopeBends {
    static constexpr int steepest = 4;  // targets between neighbors; more is an edge in a texture

    /// `rows`: the samples to look at, by row, one bit per column.
    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const LatticeSample* samples,
                                      const LatticeCell& cell, const uint16_t* rows) {
        if (!settings.fine) return false;
        for (int i = 0; i < 4; ++i) {
            const CellSide side = CellSide::of(cell, i);
            if (!side.is_inside() || side.size <= 2) continue;
            for (int end = 0; end < 2; ++end) {
                const int k = end == 0 ? 0 : side.length - 1, near = end == 0 ? side.first : side.last;
                if (side.is_in(rows, k) &&
                    bends(settings, samples[side.slot(k)], samples[cell.corner(near)],
                          samples[cell.corner(near ^ side.opposite)], side.size - 1, cell.area()))
                    return true;
            }
        }
        return false;
    }

  private:
    /// `steps`: lattice steps from `first` to `last`.
    CISTULA_INLINE static bool bends(const LatticeSettings& settings, const LatticeSample& before,
                                     const LatticeSample& first, const LatticeSample& last, int steps, int64_t area) {
        if (before.path_hash != first.path_hash || first.path_hash != last.path_hash) return false;
        for (int c = 0; c < 3; ++c) {
            const int64_t from = first.color(c), slope = from - before.color(c);
            if (magnitude(slope) > steepest * settings.target) continue;
            if (settings.exceeded_by(magnitude(from + steps * slope - last.color(c)), area)) return true;
        }
        return false;
    }
};

/// Splits a cell if the pixel has a color jump, between nearby samples with equal path hashes, that would exceed the
/// target over three eighths of the cell. At such small distances gradual shading differs little but an edge in a
/// texture by its full contrast, and the texture's stripes, seen through curved glass or from afar, may lie between
/// corners that agree.
struct TextureJumps {
    static constexpr int eighths = 3;
    static constexpr int near_area = 8;  // maximum area, in samples, of a cell whose corners are nearby

    /// The greatest color difference between nearby corners with equal path hashes; 0 if there are none.
    CISTULA_INLINE static int64_t jump_in(const LatticeSample* samples, const LatticeCell& cell) {
        int64_t jump = 0;
        if (cell.area() > near_area) return jump;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j) {
                const LatticeSample &a = samples[cell.corner(i)], &b = samples[cell.corner(j)];
                for (int c = 0; c < 3 && a.path_hash == b.path_hash; ++c)
                    jump = max_or_second(jump, magnitude(a.color(c) - b.color(c)));
            }
        return jump;
    }

    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const PixelFindings& pixel, int64_t area) {
        return eighths * pixel.jump * area > 8 * settings.target * lattice_samples;
    }
};

/// Splits a cell whose corners have different path hashes if half of it, with the greatest color range of any cell of
/// the pixel, would exceed the target. A feature that one place of the pixel shows may be hidden in another.
struct UnlikeCorners {
    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const PixelFindings& pixel,
                                      const LatticeCell& cell) {
        return cell.differs && settings.exceeded_by(pixel.range, cell.area() / 2);
    }
};

/// For small targets: splits a cell if the pixel has a large ray tree and an unseen change of 1/192 of the radiance
/// bound would exceed the target in the cell. Large trees see so much that some of it lies between samples that agree,
/// even if their own trees are small: the image of a light ends a tree early.
struct LargeTrees {
    static constexpr uint32_t large_tree = 96;  // rays
    static constexpr int64_t unseen_range = (int64_t(1) << color_bits) / 192;

    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const PixelFindings& pixel, int64_t area) {
        return settings.fine && pixel.rays >= large_tree && settings.exceeded_by(unseen_range, area);
    }
};

/// For small targets: splits a cell that is not small if one of the pixel's first five trees has several rays and the
/// pixel's colors span many targets. A highlight may lie between its corners.
struct WideColors {
    static constexpr uint32_t some_rays = 5;
    static constexpr int wide_range = 16;  // targets
    static constexpr int wide_area = lattice_samples / 16;

    CISTULA_INLINE static bool splits(const LatticeSettings& settings, const PixelFindings& pixel, int64_t area) {
        return settings.fine && pixel.first_rays >= some_rays && area > wide_area &&
               pixel.range >= wide_range * settings.target;
    }
};

/// Whether the rest of the pixel makes it doubtful that the corners represent a cell of `area` samples, however alike
/// they are.
CISTULA_INLINE bool splits_by_pixel(const LatticeSettings& settings, const PixelFindings& pixel, int64_t area) {
    return LargeTrees::splits(settings, pixel, area) || WideColors::splits(settings, pixel, area) ||
           TextureJumps::splits(settings, pixel, area);
}

}  // namespace cistula
