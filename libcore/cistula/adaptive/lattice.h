// Adaptive sampling of one fixed lattice of 16 x 16 samples a pixel (docs/rules.md, 10): which of them a pixel needs.
// Decided in integers from the pixel's own samples, so that crops, tiles and backends agree.
#pragma once

#include "cistula/adaptive/adaptive_rules.h"

namespace cistula {

/// A pixel, in rounds: all samples that it wants are taken, all new cells judged and those that differ divided, whose
/// children want the next. A cell, a rectangle of samples, is known by its four corners; where these differ too much it
/// is split, else they stand for all of it, unless what the pixel shows elsewhere by then makes that doubtful
/// (adaptive_rules.h). A straight border through a rectangle parts its corners, so that it is never overlooked. All 256
/// samples give what the uniform 16 x 16 grid does. The children of a split share no sample. In each of a round's steps
/// the work on one sample or cell may be any thread's. The samples lie with the caller, by slot.
class LatticePixel {
  public:
    CISTULA_INLINE void begin(const LatticeSettings& settings) {
        const LatticeCell whole = LatticeCell::whole_pixel();
        cells_[0] = whole;
        // As want() would the corners and the middle, but that nothing is read: a device would wait for each.
        const int middle_row = settings.fine ? lattice_middle / lattice_side : lattice_side;
        for (int y = 0; y < lattice_side; ++y) {
            const bool is_outer = y == 0 || y == lattice_side - 1;
            taken_[y] = fresh_[y] = is_outer          ? uint16_t(1u | 1u << (lattice_side - 1))
                                    : y == middle_row ? uint16_t(1u << lattice_middle % lattice_side)
                                                      : uint16_t(0);
        }
        for (int c = 0; c < 4; ++c) slots_[c] = uint8_t(whole.corner(c));
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
        LatticeCell& cell = cells_[index];
        const uint16_t* beside = cell.is_new ? taken_ : fresh_;
        if (cell.is_new) judge_corners(settings, samples, cell);
        if (!cell.wants_split && cell.area() > 4)
            cell.wants_split = SideCrossed::splits(settings, samples, cell, beside) ||
                               SlopeBends::splits(settings, samples, cell, beside);
    }

    /// Splits those of the cells that should be and still may.
    CISTULA_INLINE void divide(const LatticeSettings& settings) {
        Tally now = tally_;
        const int count = now.cells;
        for (int i = 0; i < count; ++i) now.seen.add(cells_[i]);
        now.wanted = 0;
        for (int y = 0; y < lattice_side; ++y) fresh_[y] = 0;
        for (int i = 0; i < count; ++i) {
            const LatticeCell cell = cells_[i];
            const bool splits = cell.wants_split || UnlikeCorners::splits(settings, now.seen, cell) ||
                                splits_by_pixel(settings, now.seen, cell.area());
            if (cell.area() == 4 || !splits) continue;
            const bool first = settings.fine && cell.is_whole();
            const int in_four = first ? 11 : 12, in_two = 4;  // of the first the middle is there
            if ((first || wants_four(settings, now.seen, cell)) && now.due + in_four <= settings.most) {
                now.due += in_four;
                for (int q = 0; q < 4; ++q) add_child(now, i, q, cell.part(q & 1 ? 1 : -1, q & 2 ? 1 : -1));
            } else if (!first && now.due + in_two <= settings.most) {
                now.due += in_two;
                for (int half = 0; half < 2; ++half)
                    add_child(now, i, half, cell.across ? cell.part(2 * half - 1, 0) : cell.part(0, 2 * half - 1));
            } else {
                now.unmet = true;
            }
        }
        tally_ = now;
    }

    /// add(slot, weight): samples that stand for cell i once the pixel is done.
    template <class Add>
    CISTULA_INLINE void accumulate(const LatticeSettings& settings, int i, const Add& add) const {
        const LatticeCell& cell = cells_[i];
        int each = cell.area() / 4;
        if (settings.fine && cell.is_whole()) {
            // Simpson's rule, near enough, where all is smooth.
            each = cell.differs ? 32 : 24;
            add(lattice_middle, lattice_samples - 4 * each);
        }
        for (int c = 0; c < 4; ++c) add(cell.corner(c), each);
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

    /// Counts of the pixel. Worked on in a copy, which stays in registers: stores of slots, being bytes, could be to
    /// any member.
    struct Tally {
        int cells, due, wanted;  // samples due: taken and wanted
        bool unmet;
        PixelFindings seen;
    };

    /// Unless it is there.
    CISTULA_INLINE void want(Tally& now, int slot) {
        const int y = slot / lattice_side;
        const uint16_t bit = uint16_t(1u << slot % lattice_side);
        if ((taken_[y] & bit) != 0) return;
        taken_[y] = uint16_t(taken_[y] | bit);
        fresh_[y] = uint16_t(fresh_[y] | bit);
        slots_[now.wanted++] = uint8_t(slot);
    }

    CISTULA_INLINE static void judge_corners(const LatticeSettings& settings, const LatticeSample* samples,
                                             LatticeCell& cell) {
        const CornerFindings found = CornerFindings::of(samples, cell, settings.fine && cell.is_whole());
        cell.is_new = false;
        cell.wants_split = CornersDisagree::splits(settings, cell, found);
        cell.across = is_split_across(cell, found.across, found.down);
        cell.differs = found.differs;
        cell.rays = found.most_rays;
        cell.range = found.range;
        cell.jump = TextureJumps::jump_in(samples, cell);
    }

    /// Where the colors differ more, unless that makes needles.
    CISTULA_INLINE static bool is_split_across(const LatticeCell& cell, int64_t across, int64_t down) {
        if (cell.width == 2 || cell.height == 2) return cell.width > 2;
        if (cell.width >= 4 * cell.height || cell.height >= 4 * cell.width) return cell.width > cell.height;
        return across != down ? across > down : cell.width >= cell.height;
    }

    /// Whether a cell that is split is so in four at once, which spares a round: where its halves would be too,
    /// whatever they show.
    CISTULA_INLINE static bool wants_four(const LatticeSettings& settings, const PixelFindings& seen,
                                          const LatticeCell& cell) {
        return cell.width >= 4 && cell.height >= 4 && splits_by_pixel(settings, seen, cell.area() / 2);
    }

    /// Puts part `nth` of cell i in its place, the first, or behind all; wants the corners that are not there.
    CISTULA_INLINE void add_child(Tally& now, int i, int nth, const LatticeCell& child) {
        for (int c = 0; c < 4; ++c) want(now, child.corner(c));
        cells_[nth == 0 ? i : now.cells++] = child;
    }

    Tally tally_;
    uint16_t taken_[lattice_side], fresh_[lattice_side];  // samples by row, a bit a column: all, and this round's
    uint8_t slots_[lattice_samples * 3 / 4];              // no split wants more than three of four new samples
    LatticeCell cells_[most_cells];
};

}  // namespace cistula
