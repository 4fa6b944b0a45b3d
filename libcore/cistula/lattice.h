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
/// Colors are compared in units of 2^-44 of the radiance bound's power of two: a target may be 2^-32 of that, as in
/// closed-box.json. What is computed of them takes at most 13 bits more.
inline constexpr int color_bits = 44, color_shift = 54 - color_bits;
/// Rays of a large tree, which sees many things, and how much brighter or darker what lies unseen in a cell is taken to
/// be once a pixel met one.
inline constexpr uint32_t large_tree = 96;
inline constexpr int64_t unseen_range = (int64_t(1) << color_bits) / 192;
/// Eighths of a cell that something unseen in it is taken to fill, as much brighter or darker as samples that met the
/// same are at corners of a small cell: on both sides of a texture's border, say, but not where shading is gradual.
inline constexpr int unseen_alike = 3, jump_area = 8;
/// For small targets: where one of a pixel's first five trees has some_rays and a cell's colors span wide_range
/// targets, no cell larger than wide_area stands, as a highlight may lie between.
inline constexpr uint32_t some_rays = 5;
inline constexpr int wide_range = 16, wide_area = lattice_samples / 16;

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
    uint32_t path_hash;  // of its ray tree (path_hash.h)

    CISTULA_INLINE void keep(const PixelRecord& record, uint32_t hash) {
        for (int c = 0; c < 3; ++c) {
            radiance[c] = record.radiance[c];
            pruned[c] = record.pruned[c];
            cut[c] = record.cut[c];
        }
        hits = record.hits;
        rays = record.rays;
        path_hash = hash;
    }

    /// add(to, value) for all that the sample is worth to its pixel if it stands for `weight` of the lattice; for a
    /// ledger only if what was kept had one.
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
        const Cell whole = whole_cell();
        cells_[0] = whole;
        // As want() would the corners and the middle, but that nothing is read: a device would wait for each.
        const int middle_row = settings.fine ? lattice_middle / lattice_side : lattice_side;
        for (int y = 0; y < lattice_side; ++y) {
            const bool is_outer = y == 0 || y == lattice_side - 1;
            taken_[y] = fresh_[y] = is_outer          ? uint16_t(1u | 1u << (lattice_side - 1))
                                    : y == middle_row ? uint16_t(1u << lattice_middle % lattice_side)
                                                      : uint16_t(0);
        }
        for (int c = 0; c < 4; ++c) slots_[c] = uint8_t(corner(whole, c));
        slots_[4] = uint8_t(lattice_middle);
        Tally now = Tally();
        now.cells = 1;
        now.due = now.wanted = settings.fine ? least_lattice_samples : least_lattice_samples - 1;
        tally_ = now;
    }

    /// The slots of the samples that this round wants, none if the pixel is done: wanted(0) to wanted(wanted() - 1).
    CISTULA_INLINE int wanted() const { return tally_.wanted; }
    CISTULA_INLINE int wanted(int i) const { return slots_[i]; }

    /// Cells that the pixel consists of, to be judged once all that was wanted is there.
    CISTULA_INLINE int cells() const { return tally_.cells; }

    /// What the corners of the index-th cell, if it is new, tell of it and of its pixel, and what was taken beside it.
    CISTULA_INLINE void judge(const LatticeSettings& settings, const LatticeSample* samples, int index) {
        Cell& cell = cells_[index];
        const uint16_t* beside = cell.is_new ? taken_ : fresh_;
        if (cell.is_new) judge_corners(settings, samples, cell);
        if (!cell.wants_split && area_of(cell) > 4) cell.wants_split = is_crossed(settings, samples, cell, beside);
    }

    /// Splits those of the cells that should be and still may.
    CISTULA_INLINE void divide(const LatticeSettings& settings) {
        Tally now = tally_;
        const int count = now.cells;
        for (int i = 0; i < count; ++i) {
            const Cell& cell = cells_[i];
            now.met_large |= cell.met_large;
            now.first_rays = greatest(now.first_rays, cell.first_rays);
            now.range = greatest(now.range, cell.range);
            now.jump = greatest(now.jump, cell.jump);
        }
        now.wanted = 0;
        for (int y = 0; y < lattice_side; ++y) fresh_[y] = 0;
        for (int i = 0; i < count; ++i) {
            const Cell cell = cells_[i];
            if (area_of(cell) == 4 || !(cell.wants_split || overlooks(settings, now, area_of(cell)))) continue;
            const bool first = settings.fine && is_whole(cell);
            const int in_four = first ? 11 : 12, in_two = 4;  // of the first the middle is there
            if ((first || wants_four(settings, now, cell)) && now.due + in_four <= settings.most) {
                now.due += in_four;
                for (int q = 0; q < 4; ++q) add_child(now, i, q, cell, q & 1 ? 1 : -1, q & 2 ? 1 : -1);
            } else if (!first && now.due + in_two <= settings.most) {
                now.due += in_two;
                for (int half = 0; half < 2; ++half)
                    add_child(now, i, half, cell, cell.across ? 2 * half - 1 : 0, cell.across ? 0 : 2 * half - 1);
            } else {
                now.unmet = true;
            }
        }
        tally_ = now;
    }

    /// add(slot, weight): samples that stand for cell i once the pixel is done.
    template <class Add>
    CISTULA_INLINE void accumulate(const LatticeSettings& settings, int i, const Add& add) const {
        const Cell& cell = cells_[i];
        int each = area_of(cell) / 4;
        if (settings.fine && is_whole(cell)) {
            // Simpson's rule, near enough, where all is smooth.
            each = cell.differs ? 32 : 24;
            add(lattice_middle, lattice_samples - 4 * each);
        }
        for (int c = 0; c < 4; ++c) add(corner(cell, c), each);
    }

    /// Samples taken.
    CISTULA_INLINE int taken() const { return tally_.due; }
    CISTULA_INLINE bool unmet() const { return tally_.unmet; }

    /// Whether the sample is the one that stands for the pixel where no mean makes sense: of those taken the one in its
    /// middle, else the first.
    CISTULA_INLINE static bool is_chosen(const LatticeSettings& settings, int slot) {
        return slot == lattice_middle || (slot == 0 && !settings.fine);
    }

  private:
    static constexpr int most_cells = lattice_samples / 4;

    struct Cell {
        uint8_t x, y, width, height;
        bool is_new, wants_split, across, differs, met_large;
        uint32_t first_rays;  // of the largest tree, set of the whole pixel
        int64_t range, jump;  // of colors: of all corners; in a small cell, of those that met the same
    };

    /// Of the pixel. Worked on in a copy, which stays in registers: stores of slots, being bytes, could be to any
    /// member.
    struct Tally {
        int cells, due, wanted;  // samples due: taken and wanted
        bool unmet, met_large;   // met_large: whether the tree of a corner of any cell was large
        uint32_t first_rays;     // of the largest of the first trees
        int64_t range, jump;     // greatest of any cell
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
    /// Unless it is there.
    CISTULA_INLINE void want(Tally& now, int slot) {
        const int y = slot / lattice_side;
        const uint16_t bit = uint16_t(1u << slot % lattice_side);
        if ((taken_[y] & bit) != 0) return;
        taken_[y] = uint16_t(taken_[y] | bit);
        fresh_[y] = uint16_t(fresh_[y] | bit);
        slots_[now.wanted++] = uint8_t(slot);
    }

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

    CISTULA_INLINE void judge_corners(const LatticeSettings& settings, const LatticeSample* samples, Cell& cell) const {
        const LatticeSample* at[4];
        for (int c = 0; c < 4; ++c) at[c] = samples + corner(cell, c);
        const bool whole = is_whole(cell), has_middle = settings.fine && whole;
        bool differs = has_middle && samples[lattice_middle].path_hash != at[0]->path_hash;
        bool met_large = at[0]->rays >= large_tree;
        for (int c = 1; c < 4; ++c) {
            differs |= at[c]->path_hash != at[0]->path_hash;
            met_large |= at[c]->rays >= large_tree;
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
        // Five samples that met different things say too little of a pixel, however alike in color.
        cell.wants_split = (differs && (has_middle || fineness * range * area > allowed)) || bend * area > allowed ||
                           (settings.fine ? 8 : 4) * range * area > 3 * allowed;
        if (has_middle) {
            cell.first_rays = samples[lattice_middle].rays;
            for (int c = 0; c < 4; ++c) cell.first_rays = greatest(cell.first_rays, at[c]->rays);
        }
        cell.is_new = false;
        cell.differs = differs;
        cell.met_large = met_large;
        cell.across = is_split_across(cell, across, down);
        cell.range = range;
        cell.jump = 0;
        if (area > jump_area) return;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j)
                for (int c = 0; c < 3 && at[i]->path_hash == at[j]->path_hash; ++c)
                    cell.jump = greatest(cell.jump, magnitude_of(color(*at[i], c) - color(*at[j], c)));
    }

    /// Whether a sample right beside a cell tells of what its corners do not: between the corners of a side of
    /// something that comes in there. `rows`: the samples to look at.
    CISTULA_INLINE static bool is_crossed(const LatticeSettings& settings, const LatticeSample* samples,
                                          const Cell& cell, const uint16_t* rows) {
        const int64_t area = area_of(cell);
        for (int side = 0; side < 4; ++side) {  // left, right, upper, lower
            const bool upright = side < 2, far = side % 2 != 0;
            const int size = upright ? cell.width : cell.height, length = upright ? cell.height : cell.width;
            const int beside = (upright ? cell.x : cell.y) + (far ? size : -1);
            if (beside < 0 || beside >= lattice_side) continue;
            const LatticeSample& a = samples[corner(cell, far ? (upright ? 1 : 2) : 0)];
            const LatticeSample& b = samples[corner(cell, far ? 3 : upright ? 2 : 1)];
            for (int k = 1; k < length - 1; ++k) {
                const int x = upright ? beside : cell.x + k, y = upright ? cell.y + k : beside;
                if ((rows[y] >> x & 1) != 0 && comes_in(settings, a, b, samples[y * lattice_side + x], area))
                    return true;
            }
        }
        return false;
    }

    /// Whether a sample beside the side between two corners is brighter or darker than both by so much that two thirds
    /// of the cell would be worth the target: what comes in through that side may end before it meets a corner.
    CISTULA_INLINE static bool comes_in(const LatticeSettings& settings, const LatticeSample& a, const LatticeSample& b,
                                        const LatticeSample& beside, int64_t area) {
        for (int c = 0; c < 3; ++c) {
            const int64_t one = color(a, c), other = color(b, c), there = color(beside, c);
            const int64_t beyond = greatest(least(one, other) - there, there - greatest(one, other));
            if (3 * beyond * area > 2 * settings.target * lattice_samples) return true;
        }
        return false;
    }

    /// Whether a cell that is split is so in four at once, which spares a round: where its halves would be too,
    /// whatever they show.
    CISTULA_INLINE static bool wants_four(const LatticeSettings& settings, const Tally& now, const Cell& cell) {
        return cell.width >= 4 && cell.height >= 4 && overlooks(settings, now, area_of(cell) / 2);
    }

    /// Whether a cell may well hide what is worth the target, however alike its corners are, by what the pixel shows so
    /// far.
    CISTULA_INLINE static bool overlooks(const LatticeSettings& settings, const Tally& now, int64_t area) {
        const int64_t allowed = settings.target * lattice_samples;
        // Large trees see so much that some of it may well lie between a few samples that agree, be theirs large or
        // not: a light's image ends a tree early, and hides between others as others do between lights.
        if (settings.fine && now.met_large && unseen_range * area > allowed) return true;
        if (settings.fine && now.first_rays >= some_rays && area > wide_area &&
            now.range >= wide_range * settings.target)
            return true;
        return unseen_alike * now.jump * area > 8 * allowed;
    }

    /// Child `nth` of cell i: the left or right half (-1, 1; 0: both) of the upper or lower half; wants the corners
    /// that are not there.
    CISTULA_INLINE void add_child(Tally& now, int i, int nth, const Cell& parent, int right, int lower) {
        Cell child = parent;
        child.is_new = true;
        if (right != 0) child.width /= 2;
        if (lower != 0) child.height /= 2;
        if (right > 0) child.x = uint8_t(child.x + child.width);
        if (lower > 0) child.y = uint8_t(child.y + child.height);
        for (int c = 0; c < 4; ++c) want(now, corner(child, c));
        cells_[nth == 0 ? i : now.cells++] = child;
    }

    Tally tally_;
    uint16_t taken_[lattice_side], fresh_[lattice_side];  // samples by row, a bit a column: all, and this round's
    uint8_t slots_[lattice_samples * 3 / 4];              // no split wants more than three of four new samples
    Cell cells_[most_cells];
};

}  // namespace cistula
