// Adaptive sampling of a pixel on a fixed lattice of 16 x 16 samples (docs/rules.md, 10): decides in integers, from the
// pixel's own samples only, which of them to take, so that crops, tiles and backends agree.
#pragma once

#include "cistula/adaptive/adaptive_rules.h"
#include "cistula/transport/tree_threshold.h"

namespace cistula {

/// A pixel that is being sampled adaptively, in rounds: all wanted samples are taken, the new cells are judged, and
/// those that need it are split; their children want the next samples. A cell is a rectangle of samples, known by its
/// four corners. It is split if the corners differ too much, or if the rest of the pixel makes them doubtful
/// (adaptive_rules.h); otherwise the corners stand for all of it. A straight edge through a rectangle separates its
/// corners, so it is never missed. With all 256 samples the result is that of the uniform 16 x 16 grid. Cells share no
/// samples. In each step of a round, any thread may work on any sample or cell. The caller stores the samples, by slot.
/// A pixel that is checked takes all other samples in a last round: they say whether its cells stood for them.
class LatticePixel {
  public:
    /// `checked`: whether the pixel is to be checked.
    CISTULA_INLINE void begin(bool checked) {
        const LatticeCell whole = LatticeCell::whole_pixel();
        cells_[0] = whole;
        // Equals want() for the corners and the middle, but reads nothing: a device would wait for every read.
        for (int y = 0; y < lattice_side; ++y) {
            const bool is_outer = y == 0 || y == lattice_side - 1;
            taken_[y] = fresh_[y] = is_outer                             ? uint16_t(1u | 1u << (lattice_side - 1))
                                    : y == lattice_middle / lattice_side ? uint16_t(1u << lattice_middle % lattice_side)
                                                                         : uint16_t(0);
        }
        for (int c = 0; c < 4; ++c) slots_[c] = uint8_t(whole.corner(c));
        slots_[4] = uint8_t(lattice_middle);
        Tally now = Tally();
        now.cells = 1;
        now.due = now.wanted = least_lattice_samples;
        now.check = checked ? Check::planned : Check::none;
        tally_ = now;
    }

    /// The slots of the samples that this round wants: wanted(0) to wanted(wanted() - 1). None if the pixel is done.
    CISTULA_INLINE int wanted() const { return tally_.wanted; }
    CISTULA_INLINE int wanted(int i) const { return slots_[i]; }

    /// The number of the pixel's cells, to be judged once all wanted samples are taken.
    CISTULA_INLINE int cells() const { return tally_.cells; }

    /// Judges cell `index` by its corners, if it is new, and by the samples right beside it.
    CISTULA_INLINE void judge(const LatticeSettings& settings, const LatticeSample* samples, int index) {
        LatticeCell& cell = cells_[index];
        const uint16_t* beside = cell.is_new ? taken_ : fresh_;
        if (cell.is_new) judge_corners(settings, samples, cell);
        if (!cell.wants_split && cell.area() > 4)
            cell.wants_split = SideCrossed::splits(settings, samples, cell, beside);
    }

    /// Splits the cells that should be split, as far as the number of samples allows. If there are none, the pixel is
    /// done, or its check begins or ends.
    CISTULA_INLINE void divide(const LatticeSettings& settings, const LatticeSample* samples) {
        Tally now = tally_;
        if (now.check == Check::under_way) {
            end_check(settings, samples);
            return;
        }
        const int count = now.cells;
        for (int i = 0; i < count; ++i) now.seen.add(cells_[i]);
        now.wanted = 0;
        for (int y = 0; y < lattice_side; ++y) fresh_[y] = 0;
        for (int i = 0; i < count; ++i) {
            const LatticeCell cell = cells_[i];
            const bool splits = cell.wants_split || UnlikeCorners::splits(settings, now.seen, cell) ||
                                LargeTrees::splits(settings, now.seen, cell.area());
            if (cell.area() == 4 || !splits) continue;
            const bool first = cell.is_whole();
            // the first split has its middle sample already
            const int in_four = first ? 11 : 12;
            const int in_two = 4;
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
        if (now.wanted == 0 && now.check == Check::planned) begin_check(now);
        tally_ = now;
    }

    /// Calls add(slot, weight) for the samples that represent cell i once the pixel is done.
    template <class Add>
    CISTULA_INLINE void accumulate(int i, const Add& add) const {
        const LatticeCell& cell = cells_[i];
        int each = cell.area() / 4;
        if (cell.is_whole()) {
            // Close to Simpson's rule where the pixel is smooth.
            each = cell.differs ? 32 : 24;
            add(lattice_middle, lattice_samples - 4 * each);
        }
        for (int c = 0; c < 4; ++c) add(cell.corner(c), each);
    }

    /// Writes what is known of a pixel that is done, beside its sums.
    CISTULA_INLINE void describe(PixelRadiance& record) const {
        record.samples = uint32_t(tally_.due);
        record.unmet = tally_.unmet;
        record.checked = tally_.check != Check::none;
        record.off = tally_.check == Check::off;
    }

    /// The threshold with which a sample's tree is traced first: of a pixel's first samples the frame's; of others the
    /// greatest that those held, so that few trees are traced again.
    CISTULA_INLINE static float first_threshold(const TreeSettings& settings, const LatticeSample* samples, int slot) {
        const LatticeCell whole = LatticeCell::whole_pixel();
        bool is_first = slot == lattice_middle;
        for (int c = 0; c < 4; ++c) is_first |= slot == whole.corner(c);
        if (is_first) return settings.threshold;
        float greatest = samples[lattice_middle].threshold;
        for (int c = 0; c < 4; ++c) greatest = max_or_second(samples[whole.corner(c)].threshold, greatest);
        return greatest;
    }

    /// Whether this sample gives the pixel's id, depth and normal.
    CISTULA_INLINE static bool is_chosen(int slot) { return slot == lattice_middle; }

  private:
    static constexpr int most_cells = lattice_samples / 4;

    /// The check of a pixel. held, off: its cells stood for all samples within the target, or did not.
    enum class Check : uint8_t { none, planned, under_way, held, off };

    /// Counters of a pixel. They are updated in a local copy, which stays in registers: the compiler must assume that
    /// stores of bytes, such as slots, alias any member.
    struct Tally {
        int cells, due, wanted;  // due: samples taken and wanted
        bool unmet;
        Check check;
        PixelFindings seen;
    };

    /// Adds a sample to those that this round wants, unless it is taken already.
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
        const CornerFindings found = CornerFindings::of(samples, cell);
        cell.is_new = false;
        cell.wants_split = CornersDisagree::splits(settings, cell, found);
        cell.across = is_split_across(cell, found.across, found.down);
        cell.differs = found.differs;
        cell.rays = found.most_rays;
        cell.range = found.range;
    }

    /// Whether to split across the direction in which colors differ more, unless that makes cells too narrow.
    CISTULA_INLINE static bool is_split_across(const LatticeCell& cell, int64_t across, int64_t down) {
        if (cell.width == 2 || cell.height == 2) return cell.width > 2;
        if (cell.width >= 4 * cell.height || cell.height >= 4 * cell.width) return cell.width > cell.height;
        return across != down ? across > down : cell.width >= cell.height;
    }

    /// Whether a cell is split in four at once, which saves a round: where its halves would be split too, whatever they
    /// show.
    CISTULA_INLINE static bool wants_four(const LatticeSettings& settings, const PixelFindings& seen,
                                          const LatticeCell& cell) {
        return cell.width >= 4 && cell.height >= 4 && LargeTrees::splits(settings, seen, cell.area() / 2);
    }

    /// Stores part `nth` of cell i, the first in place of the cell and the others at the end, and wants its missing
    /// corners.
    CISTULA_INLINE void add_child(Tally& now, int i, int nth, const LatticeCell& child) {
        for (int c = 0; c < 4; ++c) want(now, child.corner(c));
        cells_[nth == 0 ? i : now.cells++] = child;
    }

    CISTULA_INLINE void begin_check(Tally& now) {
        now.check = Check::under_way;
        for (int slot = 0; slot < lattice_samples; ++slot) want(now, slot);
        now.due = lattice_samples;
        if (now.wanted == 0) now.check = Check::held;
    }

    /// Compares the cells with all samples, and puts the smallest cells in their place, which stand for themselves.
    CISTULA_INLINE void end_check(const LatticeSettings& settings, const LatticeSample* samples) {
        tally_.check = Check::held;
        for (int c = 0; c < 3; ++c) {
            int64_t difference = 0;
            for (int slot = 0; slot < lattice_samples; ++slot) difference -= samples[slot].color(c);
            for (int i = 0; i < tally_.cells; ++i)
                accumulate(i, [&](int slot, int weight) { difference += weight * samples[slot].color(c); });
            if (magnitude(difference) > settings.target * lattice_samples) tally_.check = Check::off;
        }
        for (int i = 0; i < most_cells; ++i) cells_[i] = LatticeCell::smallest(i);
        tally_.cells = most_cells;
        tally_.wanted = 0;
    }

    Tally tally_;
    uint16_t taken_[lattice_side], fresh_[lattice_side];  // samples by row, one bit per column: all, and this round's
    uint8_t slots_[lattice_samples];
    LatticeCell cells_[most_cells];
};

}  // namespace cistula
