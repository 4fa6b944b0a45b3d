// One adaptively sampled pixel: what both backends do where a frame has a target.
#pragma once

#include "cistula/adaptive/lattice.h"
#include "cistula/adaptive/path_hash.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// Takes sample `slot` of pixel (px, py) into `record`, and gives its path hash. A tree of more than most_branches is
/// walked again with four times the budget, and so on: the ledger says so. `gradual`: shades_gradually(scene), found
/// once. `work` is the thread's own.
template <class Real, class E, class Intersector, class Stack, class Scene>
CISTULA_INLINE uint32_t take_sample(const Scene& scene, const FrameView& frame, const Intersector& intersector, int px,
                                    int py, int slot, bool gradual, PixelRecord& record, PixelWork& work,
                                    Stack& stack) {
    const uint32_t before = work.rays.total();
    TreeSettings settings = frame.tree;
    for (;; settings.budget = 4 * greatest(settings.budget, int64_t(1))) {
        begin_pixel(record);
        PathHash hash;
        HashingStack<Stack, Real> hashing(stack, hash, Real(frame.lattice.significant));
        render_sample<Real, E>(scene, frame, settings, HashingIntersector<Intersector>{intersector, hash, gradual}, px,
                               py, slot % lattice_side, slot / lattice_side, true, record, work, hashing);
        record.rays = work.rays.total() - before;
        if (!hashing.drop()) return hash.value;
        if (stack.stopped()) return hash.value;
    }
}

/// Copies what is one sample's alone.
CISTULA_INLINE void choose_sample(const PixelRecord& sample, PixelRecord& pixel) {
    pixel.id = sample.id;
    pixel.z = sample.z;
    for (int c = 0; c < 3; ++c) pixel.normal[c] = sample.normal[c];
}

/// Takes all samples that the pixel wants, with room of its own for them, into `record`. take(slot, taken): a sample's
/// record; gives its path hash.
template <class Take>
CISTULA_INLINE void sample_adaptively(const LatticeSettings& settings, PixelRecord& record, const Take& take) {
    LatticeSample samples[lattice_samples];
    PixelRecord taken;
    LatticePixel pixel;
    record = PixelRecord();
    for (pixel.begin(settings); pixel.wanted() > 0;) {
        for (int i = 0; i < pixel.wanted(); ++i) {
            const int slot = pixel.wanted(i);
            const uint32_t hash = take(slot, taken);
            samples[slot].keep(taken, hash);
            record.rays += taken.rays;
            if (LatticePixel::is_chosen(settings, slot)) choose_sample(taken, record);
        }
        for (int i = 0; i < pixel.cells(); ++i) pixel.judge(settings, samples, i);
        pixel.divide(settings);
    }
    for (int i = 0; i < pixel.cells(); ++i)
        pixel.accumulate(settings, i, [&](int slot, int weight) { samples[slot].give(record, weight, Plus()); });
    record.samples = uint32_t(pixel.taken());
    record.unmet = pixel.unmet();
}

/// Renders pixel (px, py) of a frame with a target error.
template <class Real, class E, class Intersector, class Stack, class Scene>
CISTULA_INLINE void render_adaptive_pixel(const Scene& scene, const FrameView& frame, const Intersector& intersector,
                                          int px, int py, bool gradual, PixelRecord& record, PixelWork& work,
                                          Stack& stack) {
    sample_adaptively(frame.lattice, record, [&](int slot, PixelRecord& taken) {
        return take_sample<Real, E>(scene, frame, intersector, px, py, slot, gradual, taken, work, stack);
    });
}

}  // namespace cistula
