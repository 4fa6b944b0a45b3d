// One adaptively sampled pixel: the body of both backends' loops where a frame has a target.
#pragma once

#include "cistula/pixel.h"
#include "cistula/signature.h"

namespace cistula {

/// The sample that pixel (px, py) wants in `slot`. `gradual`: shades_gradually(scene), found once. `work` is the
/// thread's own.
template <class Real, class E, class Intersector, class Stack, class Scene>
CISTULA_INLINE void render_wanted(const Scene& scene, const FrameView& frame, const Intersector& intersector, int px,
                                  int py, int column, int row, int slot, bool gradual, LatticePixel& pixel,
                                  PixelWork& work, Stack& stack) {
    LatticeSample& sample = pixel.at(slot);
    sample.record = PixelRecord();
    sample.record.z = RealTraits<float>::infinity;
    Signature signature;
    const uint32_t before = work.rays.total();
    SigningStack<Stack, Real> signing(stack, signature, Real(frame.lattice.significant));
    render_sample<Real, E>(scene, frame, SigningIntersector<Intersector>{intersector, signature, gradual}, px, py,
                           column, row, true, sample.record, work, signing);
    sample.record.rays = work.rays.total() - before;
    sample.signature = signature.value;
    pixel.took(column, row, slot);
}

/// All that it wants, with a stack of its own.
template <class Real, class E, class Intersector, class Scene>
CISTULA_INLINE void render_adaptive_pixel(const Scene& scene, const FrameView& frame, const Intersector& intersector,
                                          int px, int py, bool gradual, PixelRecord& record, PixelWork& work) {
    BranchStack<Real, typename Intersector::Media> stack;
    LatticePixel pixel(frame.lattice);
    pixel.begin(record);
    for (int column, row, slot; pixel.wants(column, row, slot);)
        render_wanted<Real, E>(scene, frame, intersector, px, py, column, row, slot, gradual, pixel, work, stack);
}

}  // namespace cistula
