// Adaptive sampling of one fixed lattice of 16 x 16 samples a pixel (NUMERICS, 10): which of them a pixel needs.
// Decided in integers from the pixel's own samples, so that crops, tiles and backends agree.
#pragma once

#include "cistula/pixel_record.h"
#include "cistula/real.h"

namespace cistula {

inline constexpr int lattice_side = 16, lattice_samples = lattice_side * lattice_side;
/// The fewest that a pixel can do with: its corners and its middle.
inline constexpr int least_lattice_samples = 5;
/// Colors are compared in units of 2^-30 of the radiance bound's power of two.
inline constexpr int color_bits = 30, color_shift = 54 - color_bits;

/// What a frame asks of adaptive sampling.
struct LatticeSettings {
    int64_t target = 0;          // error that sampling may leave, in units of 2^-color_bits; 0: no adaptive sampling
    int most = lattice_samples;  // samples of a pixel
    bool fine = true;            // also looks at the middle of every pixel, and splits in four first: for small targets
    double significant = 0;      // branches of less weight than this do not tell samples apart
};

/// One sample of a pixel. The sums are in units of 2^-54 (fixed_sum.h, 256 samples).
struct LatticeSample {
    PixelRecord record;
    uint32_t signature = 0;  // of its ray tree (signature.h)
};

/// Pixels, one after the other: ask for the next sample that it wants, render that into the place given, and so on. A
/// rectangle of samples is known by its four corners; where these differ too much it is split, else they stand for all
/// of it. A straight border through a rectangle parts its corners, so that it is never overlooked. All 256 samples give
/// what the uniform 16 x 16 grid does. The children of a split share no sample, so that few are kept at a time.
class LatticePixel {
  public:
    CISTULA_INLINE explicit LatticePixel(const LatticeSettings& settings) : settings_(settings) {}

    /// The next pixel, whose record this will be. Only where the one before is done.
    CISTULA_INLINE void begin(PixelRecord& record) {
        record_ = &record;
        record = PixelRecord();
        free_ = (1u << slot_count) - 1;
        depth_ = 1;
        due_ = settings_.fine ? 5 : 4;
        cells_[0] = {0, 0, lattice_side, lattice_side, {nothing, nothing, nothing, nothing}};
    }

    /// The sample to render next, into at(slot); false if the pixel is done.
    CISTULA_INLINE bool wants(int& column, int& row, int& slot) {
        while (depth_ > 0) {
            Cell& cell = cells_[depth_ - 1];
            for (int c = 0; c < 4; ++c) {
                if (cell.corner[c] != nothing) continue;
                column = cell.x + (c & 1 ? cell.width - 1 : 0);
                row = cell.y + (c & 2 ? cell.height - 1 : 0);
                if (middle_ != nothing && column == middle && row == middle) {
                    cell.corner[c] = middle_;
                    middle_ = nothing;
                    continue;
                }
                slot = cell.corner[c] = take_slot();
                return true;
            }
            if (settings_.fine && is_whole(cell) && middle_ == nothing) {
                column = row = middle;
                slot = middle_ = take_slot();
                return true;
            }
            settle(cell);
        }
        return false;
    }

    CISTULA_INLINE LatticeSample& at(int slot) { return samples_[slot]; }

    /// at(slot) holds the sample (column, row) now.
    CISTULA_INLINE void took(int column, int row, int slot) {
        const PixelRecord& sample = samples_[slot].record;
        ++record_->samples;
        record_->rays += sample.rays;
        // What stands for the pixel where no mean makes sense: the sample in its middle, if that is taken.
        if ((column | row) != 0 && (column != middle || row != middle)) return;
        record_->id = sample.id;
        record_->z = sample.z;
        for (int c = 0; c < 3; ++c) record_->normal[c] = sample.normal[c];
    }

  private:
    static constexpr int middle = lattice_side / 2;
    static constexpr uint8_t nothing = 0xff;
    /// A split adds one cell, or three at first; four follow in either direction until cells are 2 x 2.
    static constexpr int cell_count = 10;
    /// Four of the cell at hand, two of each that waits (one where it waits since the first split), and the middle.
    static constexpr int slot_count = 20;

    struct Cell {
        uint8_t x, y, width, height;
        uint8_t corner[4];  // slots; bit 0: right, bit 1: lower
    };

    CISTULA_INLINE static bool is_whole(const Cell& cell) {
        return cell.width == lattice_side && cell.height == lattice_side;
    }

    CISTULA_INLINE uint8_t take_slot() {
        const uint32_t slot = lowest_bit(free_);
        free_ &= free_ - 1;
        return uint8_t(slot);
    }

    /// Of the sample in the slot, of channel c.
    CISTULA_INLINE int64_t color(uint8_t slot, int c) const { return samples_[slot].record.radiance[c] >> color_shift; }

    /// Splits the cell on top, or lets its samples stand for it.
    CISTULA_INLINE void settle(const Cell& cell) {
        const bool whole = is_whole(cell), has_middle = middle_ != nothing && whole;
        bool differs = has_middle && samples_[middle_].signature != samples_[cell.corner[0]].signature;
        for (int i = 1; i < 4; ++i) differs |= samples_[cell.corner[i]].signature != samples_[cell.corner[0]].signature;
        int64_t range = 0, bend = 0, across = 0, down = 0;
        for (int c = 0; c < 3; ++c) {
            const int64_t a = color(cell.corner[0], c), b = color(cell.corner[1], c), d = color(cell.corner[2], c),
                          e = color(cell.corner[3], c);
            int64_t low = least(least(a, b), least(d, e)), high = greatest(greatest(a, b), greatest(d, e));
            if (has_middle) {
                const int64_t m = color(middle_, c);
                low = least(low, m);
                high = greatest(high, m);
                // Beside the mean of the corners; four times that, and half as much counts as below.
                bend = greatest(bend, magnitude_of(4 * m - a - b - d - e) / 2);
            } else {
                bend = greatest(bend, magnitude_of(a + e - b - d));
            }
            range = greatest(range, high - low);
            across = greatest(across, greatest(magnitude_of(a - b), magnitude_of(d - e)));
            down = greatest(down, greatest(magnitude_of(a - d), magnitude_of(b - e)));
        }
        const int64_t area = int64_t(cell.width) * cell.height, allowed = settings_.target * lattice_samples;
        // What a border through it can be worth: its range times its area. Rays that meet the same things bend little
        // between, unless a texture does.
        const int64_t fineness = settings_.fine && !whole ? 8 : 4;
        const bool wanted = (differs && fineness * range * area > allowed) || bend * area > allowed ||
                            (settings_.fine ? 8 : 4) * range * area > 3 * allowed;
        if (!wanted || (cell.width == 2 && cell.height == 2)) {
            add(cell, differs);
            return;
        }
        const bool in_four = whole && settings_.fine;
        const int more = in_four ? 11 : 4;  // the middle is one of sixteen
        if (due_ + more > settings_.most) {
            record_->unmet = 1;
            add(cell, differs);
            return;
        }
        due_ += more;
        const Cell parent = cell;
        --depth_;
        if (in_four) {
            for (int i = 3; i >= 0; --i) push(parent, i & 1 ? 1 : -1, i & 2 ? 1 : -1);
        } else if (is_split_across(parent, across, down)) {
            push(parent, 1, 0);
            push(parent, -1, 0);
        } else {
            push(parent, 0, 1);
            push(parent, 0, -1);
        }
    }

    /// Where the colors differ more, unless that makes needles.
    CISTULA_INLINE static bool is_split_across(const Cell& cell, int64_t across, int64_t down) {
        if (cell.width == 2 || cell.height == 2) return cell.width > 2;
        if (cell.width >= 4 * cell.height || cell.height >= 4 * cell.width) return cell.width > cell.height;
        return across != down ? across > down : cell.width >= cell.height;
    }

    /// The left or right half (-1, 1; 0: both) of the upper or lower half, with the corners that it inherits.
    CISTULA_INLINE void push(const Cell& parent, int right, int lower) {
        Cell child = parent;
        if (right != 0) child.width /= 2;
        if (lower != 0) child.height /= 2;
        if (right > 0) child.x = uint8_t(child.x + child.width);
        if (lower > 0) child.y = uint8_t(child.y + child.height);
        for (int i = 0; i < 4; ++i)
            if ((right != 0 && (i & 1 ? 1 : -1) != right) || (lower != 0 && (i & 2 ? 1 : -1) != lower))
                child.corner[i] = nothing;
        cells_[depth_++] = child;
    }

    /// The corners, and the middle where there is one, stand for the cell.
    CISTULA_INLINE void add(const Cell& cell, bool differs) {
        int each = cell.width * cell.height / 4;
        if (middle_ != nothing && is_whole(cell)) {
            // Simpson's rule, near enough, where all is smooth.
            each = differs ? 32 : 24;
            add(middle_, lattice_samples - 4 * each);
            middle_ = nothing;
        }
        for (int i = 0; i < 4; ++i) add(cell.corner[i], each);
        --depth_;
    }

    CISTULA_INLINE void add(uint8_t slot, int weight) {
        const PixelRecord& sample = samples_[slot].record;
        for (int c = 0; c < 3; ++c) {
            record_->radiance[c] += weight * sample.radiance[c];
            record_->pruned[c] += weight * sample.pruned[c];
            record_->cut[c] += weight * sample.cut[c];
        }
        record_->hits += uint32_t(weight) * sample.hits;
        free_ |= 1u << slot;
    }

    CISTULA_INLINE static int64_t magnitude_of(int64_t a) { return a < 0 ? -a : a; }

    const LatticeSettings& settings_;
    PixelRecord* record_ = nullptr;
    uint32_t free_ = 0;
    int depth_ = 0;
    int due_ = 0;               // samples taken, and those that the cells still want
    uint8_t middle_ = nothing;  // the slot of the sample in the middle, while no cell has it
    Cell cells_[cell_count];
    LatticeSample samples_[slot_count];
};

}  // namespace cistula
