// Samples and cells of the lattice of 16 x 16 samples per pixel from which adaptive sampling draws (docs/rules.md, 10).
#pragma once

#include "cistula/model/lattice_settings.h"
#include "cistula/model/pixel_record.h"
#include "cistula/numerics/real.h"

namespace cistula {

/// The slot of the sample next to the pixel's middle, a corner of its lower right quadrant. Sample (column, row) has
/// slot 16 row + column.
inline constexpr int lattice_middle = lattice_side / 2 * (lattice_side + 1);
/// One sample of a pixel: its contribution in units of 2^-54 (fixed_sum.h, 256 samples), and what it met.
struct LatticeSample {
    int64_t radiance[3], pruned[3], cut[3];
    uint32_t hits, rays;
    uint32_t path_hash;  // hash of its ray tree (path_hash.h)
    float threshold;     // that its tree held (tree_threshold.h)

    /// A channel's radiance in units of 2^-color_bits.
    CISTULA_INLINE int64_t color(int channel) const { return radiance[channel] >> color_shift; }

    CISTULA_INLINE void keep(const PixelRecord& record, uint32_t hash, float threshold_held) {
        for (int c = 0; c < 3; ++c) {
            radiance[c] = record.radiance[c];
            pruned[c] = record.pruned[c];
            cut[c] = record.cut[c];
        }
        hits = record.hits;
        rays = record.rays;
        path_hash = hash;
        threshold = threshold_held;
    }

    /// Calls add(to, value) for the sample's sums, as if it represented `weight` samples of the lattice.
    template <class Add>
    CISTULA_INLINE void give(PixelRecord& record, int weight, const Add& add) const {
        for (int c = 0; c < 3; ++c) {
            add(record.radiance[c], weight * radiance[c]);
            add(record.pruned[c], weight * pruned[c]);
            add(record.cut[c], weight * cut[c]);
        }
        add(record.hits, uint32_t(weight) * hits);
    }
};

/// A rectangle of samples that is known by its four corners; the whole pixel by its middle too.
struct LatticeCell {
    uint8_t x, y, width, height;
    bool is_new, wants_split;
    bool across;    // split into a left and a right half, not an upper and a lower one
    bool differs;   // whether the path hashes differ
    uint32_t rays;  // rays of the largest tree
    int64_t range;  // of the corners' colors

    CISTULA_INLINE static LatticeCell whole_pixel() {
        LatticeCell cell = LatticeCell();
        cell.width = cell.height = lattice_side;
        cell.is_new = true;
        return cell;
    }

    /// The i-th of the cells of 2 x 2 samples, by rows.
    CISTULA_INLINE static LatticeCell smallest(int i) {
        LatticeCell cell = LatticeCell();
        cell.x = uint8_t(2 * i % lattice_side);
        cell.y = uint8_t(2 * (2 * i / lattice_side));
        cell.width = cell.height = 2;
        return cell;
    }

    CISTULA_INLINE int area() const { return width * height; }
    CISTULA_INLINE bool is_whole() const { return width == lattice_side && height == lattice_side; }
    /// The slot of corner c. Bit 0 of c: right; bit 1: lower.
    CISTULA_INLINE int corner(int c) const {
        return (y + (c & 2 ? height - 1 : 0)) * lattice_side + x + (c & 1 ? width - 1 : 0);
    }

    /// A half or a quarter of the cell, not yet judged: left (-1), right (1) or both (0); upper (-1), lower (1) or both
    /// (0).
    CISTULA_INLINE LatticeCell part(int right, int lower) const {
        LatticeCell child = *this;
        child.is_new = true;
        if (right != 0) child.width /= 2;
        if (lower != 0) child.height /= 2;
        if (right > 0) child.x = uint8_t(child.x + child.width);
        if (lower > 0) child.y = uint8_t(child.y + child.height);
        return child;
    }
};

}  // namespace cistula
