// Rendering of one adaptively sampled pixel, in frames with a target error, for both backends.
#pragma once

#include "cistula/adaptive/lattice.h"
#include "cistula/adaptive/path_hash.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// Renders sample `slot` of a pixel into `record` and returns its path hash. If its tree has more than most_branches,
/// it is traced again with a larger threshold, and so on; the ledger contains what that drops. Trees that are traced
/// again leave no trace, and their rays do not count. `threshold`: the first, and then the one that held. `gradual`:
/// shades_gradually(scene), computed once. task.work is the thread's own, task.layers the sample's.
template <class E, class Intersector, class Stack>
CISTULA_HOST_NOINLINE uint32_t take_sample(const PixelTask<E, Intersector, Stack>& task, int slot, bool gradual,
                                           TreeThreshold& threshold, PixelRecord& record) {
    using Real = typename PixelTask<E, Intersector, Stack>::Real;
    using Hashing = HashingStack<Stack, Real>;
    static_assert(E::has(keeps_budget));
    const PixelRays before = task.work.rays;
    for (;;) {
        task.work.rays = before;
        begin_pixel(record);
        if constexpr (E::has(fills_layers))
            for (int i = 0; i < task.frame.layers.sample_words(); ++i) task.layers.words[i] = 0;
        PathHash hash;
        Hashing stack(task.stack, hash, Real(task.frame.lattice.significant));
        const HashingIntersector<Intersector> intersector{task.intersector, hash, gradual};
        const PixelTask<E, HashingIntersector<Intersector>, Hashing> hashed{
            task.scene, task.frame, intersector, task.x, task.y, task.work, stack, task.layers};
        const bool holds = render_sample(hashed, threshold, {slot % lattice_side, slot / lattice_side, true}, record);
        record.rays = task.work.rays.total() - before.total();
        const bool is_too_large = stack.drop();
        if (task.stack.stopped()) return hash.value;
        if (is_too_large)
            threshold.grow();
        else if (holds)
            return hash.value;
        else
            threshold.shrink();
    }
}

/// Copies the data that belong to a single sample: id, depth and normal.
CISTULA_INLINE void choose_sample(const PixelSight& sample, PixelSight& pixel) {
    pixel.id = sample.id;
    pixel.z = sample.z;
    for (int c = 0; c < 3; ++c) pixel.normal[c] = sample.normal[c];
}

/// An observer of the samples that count in the end and of the lattice samples that each represents: it does nothing.
struct IgnoredWeights {
    CISTULA_INLINE void operator()(int, int, float) const {}
};

/// A pixel that takes its samples in rounds, with storage for them.
class AdaptivePixel {
  public:
    CISTULA_INLINE void begin(bool checked, PixelRecord& record) {
        record = PixelRecord();
        pixel_.begin(checked);
    }
    /// The slots of the samples that this round wants; none if the pixel is done.
    CISTULA_INLINE int wanted() const { return pixel_.wanted(); }
    CISTULA_INLINE int wanted(int i) const { return pixel_.wanted(i); }

    /// The threshold with which a sample is traced first.
    CISTULA_INLINE float first_threshold(const TreeSettings& settings, int slot) const {
        return LatticePixel::first_threshold(settings, samples_, slot);
    }

    /// Stores a sample that this round wants, and the threshold that held.
    CISTULA_INLINE void keep(int slot, const PixelRecord& taken, uint32_t hash, float threshold, PixelRecord& record) {
        samples_[slot].keep(taken, hash, threshold);
        record.rays += taken.rays;
        if (LatticePixel::is_chosen(slot)) choose_sample(taken, record);
    }
    /// Ends a round, once all its samples are stored.
    CISTULA_INLINE void end_round(const LatticeSettings& settings) {
        for (int i = 0; i < pixel_.cells(); ++i) pixel_.judge(settings, samples_, i);
        pixel_.divide(settings, samples_);
    }
    /// Completes the record of a pixel that is done. stands_for(slot, weight, threshold) is told of the samples that
    /// count.
    template <class StandsFor>
    CISTULA_INLINE void finish(PixelRecord& record, const StandsFor& stands_for) const {
        for (int i = 0; i < pixel_.cells(); ++i)
            pixel_.accumulate(i, [&](int slot, int weight) {
                samples_[slot].give(record, weight, Plus());
                stands_for(slot, weight, samples_[slot].threshold);
            });
        pixel_.describe(record);
    }

  private:
    LatticeSample samples_[lattice_samples];
    LatticePixel pixel_;
};

/// Takes all samples that a pixel wants into `record`. take(slot, threshold, taken) renders a sample into `taken`,
/// beginning with a threshold, sets the one that held, and returns the path hash; stands_for is that of
/// AdaptivePixel::finish.
template <class Take, class StandsFor = IgnoredWeights>
CISTULA_INLINE void sample_adaptively(const FrameView& frame, bool checked, PixelRecord& record, const Take& take,
                                      const StandsFor& stands_for = {}) {
    AdaptivePixel pixel;
    PixelRecord taken;
    for (pixel.begin(checked, record); pixel.wanted() > 0; pixel.end_round(frame.lattice))
        for (int i = 0; i < pixel.wanted(); ++i) {
            const int slot = pixel.wanted(i);
            TreeThreshold threshold{pixel.first_threshold(frame.tree, slot)};
            const uint32_t hash = take(slot, threshold, taken);
            pixel.keep(slot, taken, hash, threshold.share, record);
        }
    pixel.finish(record, stands_for);
}

/// Renders a pixel of a frame with a target error. With fills_layers each sample fills words of its own, in `samples`
/// by slot, and those that count enter task.layers, the pixel's, when their weights are known.
template <class E, class Intersector, class Stack>
CISTULA_INLINE void render_adaptive_pixel(const PixelTask<E, Intersector, Stack>& task, bool gradual,
                                          PixelRecord& record, [[maybe_unused]] int64_t* samples = nullptr) {
    [[maybe_unused]] const LayerPlan& plan = task.frame.layers;
    sample_adaptively(
        task.frame, is_checked(task.x, task.y), record,
        [&](int slot, TreeThreshold& threshold, PixelRecord& taken) {
            PixelTask<E, Intersector, Stack> own = task;
            if constexpr (E::has(fills_layers)) own.layers = {samples + slot * plan.sample_words()};
            return take_sample(own, slot, gradual, threshold, taken);
        },
        [&]([[maybe_unused]] int slot, [[maybe_unused]] int weight, float) {
            if constexpr (E::has(fills_layers)) {
                const int64_t* words = samples + slot * plan.sample_words();
                for (int i = 0; i < plan.sums(); ++i) task.layers.words[i] += weight * words[i];
                if (!give_first_hit(plan, words, weight, LatticePixel::is_chosen(slot), task.layers.words))
                    task.work.flags |= flag_objects_overflow;
            }
        });
}

}  // namespace cistula
