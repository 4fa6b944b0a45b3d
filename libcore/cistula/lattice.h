// Adaptive sampling of one fixed lattice of 16 x 16 samples a pixel (NUMERICS, 10): which of them a pixel needs.
// Decided in integers from the pixel's own samples, so that crops, tiles and backends agree.
#pragma once

#include "cistula/pixel_record.h"
#include "cistula/real.h"

namespace cistula {

inline constexpr int lattice_side = 16, lattice_samples = lattice_side * lattice_side;
/// Sample (column, row) is slot 16 row + column; the middle of the pixel is the corner of all quadrants.
inline constexpr int lattice_middle = lattice_side / 2 * (lattice_side + 1);
/// The fewest that a pixel can do with: its corners and its middle.
inline constexpr int least_lattice_samples = 5;
/// Colors are compared in units of 2^-30 of the radiance bound's power of two.
inline constexpr int color_bits = 30, color_shift = 54 - color_bits;
/// Rays of a tree that sees many things, and the largest cell that may stand undivided in a pixel that met one.
inline constexpr uint32_t bushy_tree = 96;
inline constexpr int bushy_area = lattice_samples / 8;
/// How much brighter or darker what lies unseen in such a cell is taken to be: on infinity.json at most one pixel in
/// 1,500 is then beyond targets of 0.001 to 0.01.
inline constexpr int64_t unseen_range = (int64_t(1) << color_bits) / 192;
/// Eighths of a cell that something unseen in it is taken to fill. If its corners met different things, that may differ
/// as corners of any of the pixel's cells do; if they met the same, it is as much brighter or darker as samples that met
/// the same are at corners of a small cell: on both sides of a texture's border, say, but not where shading is gradual.
/// At 0.004 at most 0.14 % of the pixels of any golden image are then beyond. At 160x90, 4 and 2 leave 0.2 % of
/// critical-angle.json, 3 and 3 about 0.1 % of mirrors.json. Areas of 4 leave more than that of seed.json; those of 16
/// and more cost platonic.json 3 to 5 % and gain little.
inline constexpr int unseen_unlike = 4, unseen_alike = 3, jump_area = 8;

/// What a frame asks of adaptive sampling.
struct LatticeSettings {
    int64_t target = 0;          // error that sampling may leave, in units of 2^-color_bits; 0: no adaptive sampling
    int most = lattice_samples;  // samples of a pixel
    bool fine = true;            // also looks at the middle of every pixel, and splits in four first: for small targets
    double significant = 0;      // branches of less weight than this do not tell samples apart
};

/// What one sample of a pixel adds, in units of 2^-54 (fixed_sum.h, 256 samples), and what it met.
struct LatticeSample {
    int64_t radiance[3], pruned[3], cut[3];
    uint32_t hits, rays;
    uint32_t signature;  // of its ray tree (signature.h)

    CISTULA_INLINE void keep(const PixelRecord& record, uint32_t met) {
        for (int c = 0; c < 3; ++c) {
            radiance[c] = record.radiance[c];
            pruned[c] = record.pruned[c];
            cut[c] = record.cut[c];
        }
        hits = record.hits;
        rays = record.rays;
        signature = met;
    }

    /// add(to, value) for all that the sample is worth to its pixel if it stands for `weight` of the lattice.
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

/// A pixel, in rounds: all samples that it wants are taken, all new cells judged and those that differ divided, whose
/// children want the next. A cell, a rectangle of samples, is known by its four corners; where these differ too much it
/// is split, else they stand for all of it, unless what the pixel shows elsewhere by then makes that doubtful. A
/// straight border through a rectangle parts its corners, so that it is never overlooked. All 256 samples give what the
/// uniform 16 x 16 grid does. The children of a split share no sample. In each of a round's steps the work on one
/// sample or cell may be any thread's. The samples lie with the caller, by slot.
class LatticePixel {
  public:
    CISTULA_INLINE void begin(const LatticeSettings& settings) {
        unmet_ = bushy_ = 0;
        range_ = jump_ = 0;
        count_ = 1;
        cells_[0] = whole_cell();
        wanted_ = 0;
        for (int c = 0; c < 4; ++c) want(corner(cells_[0], c));
        if (settings.fine) want(lattice_middle);
        due_ = wanted_;
    }

    /// The slots of the samples that this round wants, none if the pixel is done: wanted(0) to wanted(wanted() - 1).
    CISTULA_INLINE int wanted() const { return wanted_; }
    CISTULA_INLINE int wanted(int i) const { return slots_[i]; }

    /// Cells that the pixel consists of, to be judged once all that was wanted is there.
    CISTULA_INLINE int cells() const { return count_; }

    /// What the corners of the index-th cell, if it is new, tell of it and of its pixel.
    CISTULA_INLINE void judge(const LatticeSettings& settings, const LatticeSample* samples, int index) {
        Cell& cell = cells_[index];
        if (!cell.is_new) return;
        const LatticeSample* at[4];
        for (int c = 0; c < 4; ++c) at[c] = samples + corner(cell, c);
        const bool whole = is_whole(cell), has_middle = settings.fine && whole;
        bool differs = has_middle && samples[lattice_middle].signature != at[0]->signature;
        bool bushy = at[0]->rays >= bushy_tree;
        for (int c = 1; c < 4; ++c) {
            differs |= at[c]->signature != at[0]->signature;
            bushy |= at[c]->rays >= bushy_tree;
        }
        int64_t range = 0, bend = 0, across = 0, down = 0;
        for (int c = 0; c < 3; ++c) {
            const int64_t a = color(*at[0], c), b = color(*at[1], c), d = color(*at[2], c), e = color(*at[3], c);
            int64_t low = least(least(a, b), least(d, e)), high = greatest(greatest(a, b), greatest(d, e));
            if (has_middle) {
                const int64_t m = color(samples[lattice_middle], c);
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
        const int64_t area = area_of(cell), allowed = settings.target * lattice_samples;
        // What a border through it can be worth: its range times its area. Rays that meet the same things bend little
        // between, unless a texture does.
        const int64_t fineness = settings.fine && !whole ? 8 : 4;
        cell.wants_split = (differs && fineness * range * area > allowed) || bend * area > allowed ||
                           (settings.fine ? 8 : 4) * range * area > 3 * allowed;
        cell.is_new = false;
        cell.differs = differs;
        cell.bushy = bushy;
        cell.across = is_split_across(cell, across, down);
        cell.range = range;
        cell.jump = 0;
        if (area > jump_area) return;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j)
                for (int c = 0; c < 3 && at[i]->signature == at[j]->signature; ++c)
                    cell.jump = greatest(cell.jump, magnitude_of(color(*at[i], c) - color(*at[j], c)));
    }

    /// Splits those of the cells that should be and still may.
    CISTULA_INLINE void divide(const LatticeSettings& settings) {
        const int count = count_;
        for (int i = 0; i < count; ++i) {
            const Cell& cell = cells_[i];
            bushy_ |= cell.bushy;
            range_ = greatest(range_, cell.range);
            jump_ = greatest(jump_, cell.jump);
        }
        wanted_ = 0;
        for (int i = 0; i < count; ++i) {
            const Cell cell = cells_[i];
            if (area_of(cell) == 4 || !(cell.wants_split || overlooks(settings, cell))) continue;
            const bool in_four = settings.fine && is_whole(cell);
            const int more = in_four ? 11 : 4;  // the middle is one of sixteen
            if (due_ + more > settings.most) {
                unmet_ = 1;
                continue;
            }
            due_ += more;
            if (in_four) {
                for (int q = 0; q < 4; ++q) add_child(i, q, cell, q & 1 ? 1 : -1, q & 2 ? 1 : -1);
            } else {
                for (int half = 0; half < 2; ++half)
                    add_child(i, half, cell, cell.across ? 2 * half - 1 : 0, cell.across ? 0 : 2 * half - 1);
            }
        }
    }

    /// stand(slot, weight): samples that stand for cell i once the pixel is done.
    template <class Stand>
    CISTULA_INLINE void settle(const LatticeSettings& settings, int i, const Stand& stand) const {
        const Cell& cell = cells_[i];
        int each = area_of(cell) / 4;
        if (settings.fine && is_whole(cell)) {
            // Simpson's rule, near enough, where all is smooth.
            each = cell.differs ? 32 : 24;
            stand(lattice_middle, lattice_samples - 4 * each);
        }
        for (int c = 0; c < 4; ++c) stand(corner(cell, c), each);
    }

    /// Samples taken.
    CISTULA_INLINE int taken() const { return due_; }
    CISTULA_INLINE bool unmet() const { return unmet_ != 0; }

    /// Whether the sample is the one that stands for the pixel where no mean makes sense: of those taken the one in its
    /// middle, else the first.
    CISTULA_INLINE static bool is_chosen(const LatticeSettings& settings, int slot) {
        return slot == lattice_middle || (slot == 0 && !settings.fine);
    }

  private:
    static constexpr int most_cells = lattice_samples / 4;

    struct Cell {
        uint8_t x, y, width, height;
        bool is_new, wants_split, across, differs, bushy;
        int64_t range, jump;  // of colors: of all corners; in a small cell, of those that met the same
    };

    CISTULA_INLINE static Cell whole_cell() {
        Cell cell = Cell();
        cell.width = cell.height = lattice_side;
        cell.is_new = true;
        return cell;
    }
    CISTULA_INLINE static int area_of(const Cell& cell) { return cell.width * cell.height; }
    CISTULA_INLINE static bool is_whole(const Cell& cell) {
        return cell.width == lattice_side && cell.height == lattice_side;
    }
    /// Bit 0 of c: right; bit 1: lower.
    CISTULA_INLINE static int corner(const Cell& cell, int c) {
        return (cell.y + (c & 2 ? cell.height - 1 : 0)) * lattice_side + cell.x + (c & 1 ? cell.width - 1 : 0);
    }
    CISTULA_INLINE void want(int slot) { slots_[wanted_++] = uint8_t(slot); }

    CISTULA_INLINE static int64_t color(const LatticeSample& sample, int c) {
        return sample.radiance[c] >> color_shift;
    }
    CISTULA_INLINE static int64_t magnitude_of(int64_t a) { return a < 0 ? -a : a; }

    /// Where the colors differ more, unless that makes needles.
    CISTULA_INLINE static bool is_split_across(const Cell& cell, int64_t across, int64_t down) {
        if (cell.width == 2 || cell.height == 2) return cell.width > 2;
        if (cell.width >= 4 * cell.height || cell.height >= 4 * cell.width) return cell.width > cell.height;
        return across != down ? across > down : cell.width >= cell.height;
    }

    /// Whether a cell whose corners agree may well hide what is worth the target, by what the pixel shows so far.
    CISTULA_INLINE bool overlooks(const LatticeSettings& settings, const Cell& cell) const {
        const int64_t area = area_of(cell), allowed = settings.target * lattice_samples;
        // Bushy trees see so much that some of it may well lie between a few samples that agree, be these bushy or not:
        // a light's image ends a tree early, and hides between others as others do between lights.
        if (settings.fine && bushy_ && (area > bushy_area || unseen_range * area > allowed)) return true;
        return (cell.differs ? unseen_unlike * range_ : unseen_alike * jump_) * area > 8 * allowed;
    }

    /// Child `nth` of cell i: the left or right half (-1, 1; 0: both) of the upper or lower half; wants the corners
    /// that it does not inherit.
    CISTULA_INLINE void add_child(int i, int nth, const Cell& parent, int right, int lower) {
        Cell child = parent;
        child.is_new = true;
        if (right != 0) child.width /= 2;
        if (lower != 0) child.height /= 2;
        if (right > 0) child.x = uint8_t(child.x + child.width);
        if (lower > 0) child.y = uint8_t(child.y + child.height);
        for (int c = 0; c < 4; ++c) {
            const bool inherits =
                (right == 0 || (c & 1 ? 1 : -1) == right) && (lower == 0 || (c & 2 ? 1 : -1) == lower);
            const bool is_middle = right != 0 && lower != 0 && corner(child, c) == lattice_middle;
            if (!inherits && !is_middle) want(corner(child, c));
        }
        cells_[nth == 0 ? i : count_++] = child;
    }

    int count_;             // cells
    int due_, wanted_;      // samples taken and wanted, and of these the latter
    int unmet_, bushy_;     // bushy_: whether a cell had a bushy corner
    int64_t range_, jump_;  // greatest of any cell
    uint8_t slots_[lattice_samples / 2];
    Cell cells_[most_cells];
};

}  // namespace cistula
