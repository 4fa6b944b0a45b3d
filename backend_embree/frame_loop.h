// The host's launcher: render_pixel for any intersector, over tiles that TBB spreads.
#pragma once

#include <immintrin.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "cistula/adaptive_pixel.h"
#include "cistula/bvh.h"
#include "scene/frame_contents.h"
#include "scene/frame_view.h"
#include "scene/put_pixels.h"

namespace cistula {

/// Rounds to nearest, no flush to zero: other libraries' threads may have left these set otherwise.
inline void use_default_rounding() {
    _mm_setcsr(0x1f80);
}

/// A stack that is empty once `stop` is set: a tree may be endless.
template <class Inner>
class StoppableStack {
  public:
    explicit StoppableStack(const std::atomic<bool>& stop) : stop_(stop) {}

    template <class Entry>
    bool push(const Entry& branch) {
        return inner_.push(branch);
    }
    template <class Entry>
    bool pop(Entry& branch) {
        if (stop_.load(std::memory_order_relaxed)) inner_.clear();
        return inner_.pop(branch);
    }
    bool empty() const { return inner_.empty(); }
    void clear() { inner_.clear(); }

  private:
    Inner inner_;
    const std::atomic<bool>& stop_;
};

/// Calls render(x, y, record, work) for each pixel of the film that may show something, in tiles.
template <class Render>
bool for_each_pixel(const FrameSettings& settings, const FrameContents& contents, Film& film, RenderProgress& progress,
                    const Render& render) {
    const PixelRect rect = film.rect;
    const int tile = settings.tile, columns = (rect.width + tile - 1) / tile, rows = (rect.height + tile - 1) / tile;
    std::mutex totals;
    tbb::parallel_for(tbb::blocked_range<int64_t>(0, int64_t(columns) * rows, 1), [&](const auto& range) {
        use_default_rounding();
        for (int64_t t = range.begin(); t != range.end(); ++t) {
            const int x0 = int(t % columns) * tile, y0 = int(t / columns) * tile;
            const int x1 = std::min(x0 + tile, rect.width), y1 = std::min(y0 + tile, rect.height);
            RayCounts rays;
            uint32_t flags = 0;
            const PixelWriter writer;
            const auto render_run = [&](int begin, int end, int y, PixelRecord* pixels) {
                for (int x = begin; x < end && !progress.stop.load(std::memory_order_relaxed); ++x) {
                    PixelWork own;
                    render(rect.x + x, rect.y + y, pixels[x - begin], own);
                    rays.add(own.rays);
                    flags |= own.flags;
                }
            };
            for (int y = y0; y < y1; ++y)
                contents.cover.for_each_part(y, x0, x1, [&](int begin, int end, bool covered) {
                    PixelRecord* pixels = &film.pixels[size_t(y) * size_t(rect.width) + size_t(begin)];
                    if (covered) return render_run(begin, end, y, pixels);
                    writer.fill(pixels, size_t(end - begin), contents.background.record);
                    contents.background.count(uint64_t(end - begin), rays, flags);
                });
            if (progress.stop.load(std::memory_order_relaxed)) return;
            progress.pixels_done += uint64_t(x1 - x0) * uint64_t(y1 - y0);
            progress.rays += rays.total();
            const std::lock_guard<std::mutex> lock(totals);
            film.rays.add(rays);
            film.flags |= flags;
        }
    });
    return !progress.stop.load();
}

template <class Real, class E, class Intersector>
bool render_tiles(const typename Intersector::Scene& scene, const FrameView& frame, const Intersector& intersector,
                  const FrameSettings& settings, const FrameContents& contents, Film& film, RenderProgress& progress) {
    return for_each_pixel(settings, contents, film, progress, [&](int x, int y, PixelRecord& pixel, PixelWork& own) {
        StoppableStack<StackOf<Real, E, typename Intersector::Media>> stack(progress.stop);
        render_pixel<Real, E>(scene, frame, intersector, x, y, SampleRange(), pixel, own, stack);
    });
}

/// Of a frame with a target error.
template <class Real, class E, class Intersector>
bool render_adaptive_tiles(const typename Intersector::Scene& scene, const FrameView& frame,
                           const Intersector& intersector, const FrameSettings& settings, const FrameContents& contents,
                           Film& film, RenderProgress& progress) {
    const bool gradual = shades_gradually(scene);
    return for_each_pixel(settings, contents, film, progress, [&](int x, int y, PixelRecord& pixel, PixelWork& own) {
        StoppableStack<StackOf<Real, E, typename Intersector::Media>> stack(progress.stop);
        render_adaptive_pixel<Real, E>(scene, frame, intersector, x, y, gradual, pixel, own, stack);
    });
}

template <class Real, class Intersector>
bool render_mask(const typename Intersector::Scene& scene, const FrameView& frame, const Intersector& intersector,
                 const FrameSettings& settings, const FrameContents& contents, Film& film, RenderProgress& progress,
                 int mask, uint32_t& ran) {
    ran = effect_masks[mask];
    using Render = bool (*)(const typename Intersector::Scene&, const FrameView&, const Intersector&,
                            const FrameSettings&, const FrameContents&, Film&, RenderProgress&);
    static constexpr auto table = []<size_t... I>(std::index_sequence<I...>) {
        return std::array<Render, sizeof...(I)>{&render_tiles<Real, Effects<effect_masks[I]>, Intersector>...};
    }
    (std::make_index_sequence<compiled_mask_count>());
    return table[size_t(mask)](scene, frame, intersector, settings, contents, film, progress);
}

/// The device's traversal runs here to be tested only: with one mask, which spares the compiler the others.
template <class Intersector>
inline constexpr bool runs_every_mask = true;
template <class Real>
inline constexpr bool runs_every_mask<BvhIntersector<Real>> = false;

/// Runs the least instantiated mask that contains settings.effects (0: what the scene requires); `ran` tells which.
template <class Real, class Intersector>
bool render_frame(const CompiledScene<Real>& compiled, const typename Intersector::Scene& scene,
                  const Intersector& intersector, const CameraFrame& camera, const FrameSettings& settings, Film& film,
                  RenderProgress& progress, uint32_t& ran) {
    use_default_rounding();
    FrameView frame = frame_view(compiled, camera, settings);
    prepare_film(film, settings, compiled, camera);
    if (!camera_solids(scene, intersector, frame.camera.position, frame.camera_media))
        film.flags |= flag_media_overflow;
    const FrameContents contents = frame_contents(compiled, frame, settings);
    if (settings.adaptive()) {  // one mask for all: what it would save is less than what compiling more takes
        ran = all_effects;
        return render_adaptive_tiles<Real, Effects<all_effects>>(scene, frame, intersector, settings, contents, film,
                                                                 progress);
    }
    if constexpr (!runs_every_mask<Intersector>) {
        ran = all_effects;
        return render_tiles<Real, Effects<all_effects>>(scene, frame, intersector, settings, contents, film, progress);
    } else {
        return render_mask<Real>(scene, frame, intersector, settings, contents, film, progress,
                                 mask_to_run(compiled.effects, settings, frame), ran);
    }
}

}  // namespace cistula
