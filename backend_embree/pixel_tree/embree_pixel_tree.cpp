#include "backend_embree/pixel_tree/embree_pixel_tree.h"

#include <stdexcept>

#include "backend_embree/pixel_tree/pixel_recorder.h"
#include "base/default_rounding.h"
#include "render/record/film_difference.h"

namespace cistula {
namespace {

/// Whether the samples add up to the film's one pixel.
bool same_pixel(const PixelTree& tree) {
    const PixelRecord shown = tree.film.pixels.at(0);
    PixelRecord sum = {};
    sum.z = RealTraits<float>::infinity;
    RayCounts rays;
    for (const SampleTree& sample : tree.samples) {
        sum.add(sample.record);
        rays.add(sample.rays);
    }
    sum.samples = shown.samples;
    sum.unmet = shown.unmet;
    sum.checked = shown.checked;
    sum.off = shown.off;
    const RayCounts& counted = tree.film.rays;
    return differing_values(sum, shown) == 0 && rays.primary == counted.primary &&
           rays.reflected == counted.reflected && rays.transmitted == counted.transmitted &&
           rays.shadow == counted.shadow;
}

/// Whether the branches of each sample add up to its sums.
bool adds_up(const PixelTree& tree) {
    for (const SampleTree& sample : tree.samples) {
        const PixelBranch& all = sample.branches.front();
        const Sums sums = Sums::of(sample.record);
        for (size_t c = 0; c < 3; ++c)
            if (all.adds[c] + all.adds_below[c] != sums.radiance[c] ||
                all.ledger[c] + all.ledger_below[c] != sums.pruned[c] + sums.cut[c])
                return false;
    }
    return true;
}

}  // namespace

template <class Real>
PixelTree embree_pixel_tree(const CompiledScene<Real>& scene, const EmbreeIntersector<Real>& intersector,
                            Renderer& renderer, const CameraFrame& camera, const FrameSettings& settings, int x, int y,
                            const PixelTreeLimits& limits) {
    const DefaultRounding rounding;
    uint32_t flags = 0;
    PixelTree pixel = record_pixel(scene, intersector.scene, intersector, camera, settings, x, y, limits, flags);
    FrameSettings alone = settings;
    alone.crop = {x, y, 1, 1};
    alone.parts = {};
    RenderProgress progress;
    renderer.render(camera, alone, pixel.film, progress);
    if (flags != pixel.film.flags || (flags == 0 && !same_pixel(pixel)))
        throw std::logic_error("internal error: the ray tree is not what the renderer gives for this pixel");
    if (flags == 0 && !adds_up(pixel))
        throw std::logic_error("internal error: the branches of the ray tree do not add up to the pixel");
    return pixel;
}

template PixelTree embree_pixel_tree(const CompiledScene<float>&, const EmbreeIntersector<float>&, Renderer&,
                                     const CameraFrame&, const FrameSettings&, int, int, const PixelTreeLimits&);
template PixelTree embree_pixel_tree(const CompiledScene<double>&, const EmbreeIntersector<double>&, Renderer&,
                                     const CameraFrame&, const FrameSettings&, int, int, const PixelTreeLimits&);

}  // namespace cistula
