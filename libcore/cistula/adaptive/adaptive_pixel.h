// Rendering of one adaptively sampled pixel, in frames with a target error, for both backends.
#pragma once

#include "cistula/adaptive/lattice.h"
#include "cistula/adaptive/path_hash.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// The budget with which a tree is traced again that had more than most_branches.
CISTULA_INLINE int64_t larger_budget(int64_t budget) {
    return 4 * max_or_second(budget, int64_t(1));
}

/// Renders sample `slot` of a pixel into `record` and returns its path hash. If its tree has more than most_branches,
/// it is traced again with a larger budget, and so on; the ledger contains what that drops. `gradual`:
/// shades_gradually(scene), computed once. task.work is the thread's own.
template <class E, class Intersector, class Stack>
CISTULA_HOST_NOINLINE uint32_t take_sample(const PixelTask<E, Intersector, Stack>& task, int slot, bool gradual,
                                           PixelRecord& record) {
    using Real = typename PixelTask<E, Intersector, Stack>::Real;
    using Hashing = HashingStack<Stack, Real>;
    const uint32_t before = task.work.rays.total();
    TreeSettings settings = task.frame.tree;
    for (;; settings.budget = larger_budget(settings.budget)) {
        begin_pixel(record);
        PathHash hash;
        Hashing stack(task.stack, hash, Real(task.frame.lattice.significant));
        const HashingIntersector<Intersector> intersector{task.intersector, hash, gradual};
        const PixelTask<E, HashingIntersector<Intersector>, Hashing> hashed{task.scene, task.frame, intersector, task.x,
                                                                            task.y,     task.work,  stack};
        render_sample(hashed, settings, {slot % lattice_side, slot / lattice_side, true}, record);
        record.rays = task.work.rays.total() - before;
        if (!stack.drop()) return hash.value;
        if (task.stack.stopped()) return hash.value;
    }
}

/// Enters sample `slot` into the pixel's layers as if it represented `weight` samples of the lattice, by tracing it
/// again. E: with fills_layers. False if its tree has more than most_branches.
template <class E, class Intersector, class Stack>
CISTULA_NOINLINE bool trace_layers(const PixelTask<E, Intersector, Stack>& task, const TreeSettings& settings, int slot,
                                   int weight) {
    using Real = typename PixelTask<E, Intersector, Stack>::Real;
    using Limited = HashingStack<Stack, Real>;
    PathHash unused;
    Limited stack(task.stack, unused, Real(task.frame.lattice.significant));
    PixelWork work;
    PixelRecord record;
    begin_pixel(record);
    const PixelTask<E, Intersector, Limited> traced{task.scene, task.frame, task.intersector,           task.x, task.y,
                                                    work,       stack,      {task.layers.words, weight}};
    render_sample(traced, settings, {slot % lattice_side, slot / lattice_side, LatticePixel::is_chosen(slot)}, record);
    task.work.flags |= work.flags & flag_objects_overflow;
    return !stack.drop();
}

/// Enters a sample into the pixel's layers, with the budget that take_sample came to.
template <class E, class Intersector, class Stack>
CISTULA_INLINE void add_layers(const PixelTask<E, Intersector, Stack>& task, int slot, int weight) {
    TreeSettings settings = task.frame.tree;
    while (!trace_layers(task, settings, slot, weight) && !task.stack.stopped()) {
        trace_layers(task, settings, slot, -weight);  // takes back what it added
        settings.budget = larger_budget(settings.budget);
    }
}

/// Copies the data that belong to a single sample: id, depth and normal.
CISTULA_INLINE void choose_sample(const PixelRecord& sample, PixelRecord& pixel) {
    pixel.id = sample.id;
    pixel.z = sample.z;
    for (int c = 0; c < 3; ++c) pixel.normal[c] = sample.normal[c];
}

/// What sample_adaptively tells of a sample that represents `weight` samples: nothing.
struct IgnoredWeights {
    CISTULA_INLINE void operator()(int, int) const {}
};

/// Takes all samples that the pixel wants into `record`, with local storage for them. take(slot, taken) renders a
/// sample into `taken` and returns its path hash; stands_for(slot, weight) is told of those that count in the end.
template <class Take, class StandsFor = IgnoredWeights>
CISTULA_INLINE void sample_adaptively(const LatticeSettings& settings, bool checked, PixelRecord& record,
                                      const Take& take, const StandsFor& stands_for = {}) {
    LatticeSample samples[lattice_samples];
    PixelRecord taken;
    LatticePixel pixel;
    record = PixelRecord();
    for (pixel.begin(checked); pixel.wanted() > 0;) {
        for (int i = 0; i < pixel.wanted(); ++i) {
            const int slot = pixel.wanted(i);
            const uint32_t hash = take(slot, taken);
            samples[slot].keep(taken, hash);
            record.rays += taken.rays;
            if (LatticePixel::is_chosen(slot)) choose_sample(taken, record);
        }
        for (int i = 0; i < pixel.cells(); ++i) pixel.judge(settings, samples, i);
        pixel.divide(settings, samples);
    }
    for (int i = 0; i < pixel.cells(); ++i)
        pixel.accumulate(i, [&](int slot, int weight) {
            samples[slot].give(record, weight, Plus());
            stands_for(slot, weight);
        });
    pixel.describe(record);
}

/// Renders a pixel of a frame with a target error. `stands_for` is that of sample_adaptively.
template <class E, class Intersector, class Stack, class StandsFor = IgnoredWeights>
CISTULA_INLINE void render_adaptive_pixel(const PixelTask<E, Intersector, Stack>& task, bool gradual,
                                          PixelRecord& record, const StandsFor& stands_for = {}) {
    sample_adaptively(
        task.frame.lattice, is_checked(task.x, task.y), record,
        [&](int slot, PixelRecord& taken) { return take_sample(task, slot, gradual, taken); }, stands_for);
}

}  // namespace cistula
