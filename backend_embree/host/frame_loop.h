// The host's frame loop: render_pixel for any intersector, over tiles that TBB distributes.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>

#include "backend_embree/lanes/pixels_by_sample.h"
#include "base/default_rounding.h"
#include "cistula/lanes/lane_scene.h"
#include "cistula/traversal/bvh.h"
#include "render/frame/frame_hints.h"
#include "render/frame/frame_view.h"
#include "scene/compile/lane_scene.h"

namespace cistula {

/// Whether the render was stopped, so that ray trees end early.
struct RenderStop {
    const std::atomic<bool>& flag;  // RenderProgress::stop

    bool operator()() const { return flag.load(std::memory_order_relaxed); }
};

/// Whether an intersector is compiled for layers: the backends' own.
template <class Intersector>
inline constexpr bool fills_film_layers = false;
template <class Real>
inline constexpr bool fills_film_layers<BvhIntersector<Real>> = true;

/// A pixel to be rendered: its place in the frame, and where its result goes.
struct TilePixel {
    int x, y;
    PixelRecord& record;
    PixelLayers layers;
};

/// A tile in work: the records of its pixels where the scene may be visible, and what was counted.
class Tile {
  public:
    explicit Tile(int side)
        : records_(std::make_unique_for_overwrite<PixelRecord[]>(size_t(side) * size_t(side))),
          places_(std::make_unique_for_overwrite<size_t[]>(size_t(side) * size_t(side))) {}

    /// Begins another. `area` is relative to the film's first pixel.
    void begin(const PixelRect& area) {
        rect = area;
        counts = {};
        used_ = 0;
    }
    /// A record for a pixel of the film.
    PixelRecord& record_of(size_t pixel) {
        places_[used_] = pixel;
        return records_[used_++];
    }
    /// Puts the records into the film, and counts them.
    void put_into(Film& film) {
        const PixelWriter writer(film.pixels.planes());
        for (size_t i = 0; i < used_; ++i) {
            writer.put(places_[i], records_[i]);
            counts.totals.add(records_[i], film.units_lost(records_[i]));
        }
    }

    PixelRect rect;
    FrameCounts counts;

  private:
    const std::unique_ptr<PixelRecord[]> records_;
    const std::unique_ptr<size_t[]> places_;
    size_t used_ = 0;
};

/// The rendering of one frame on the host: many rays at once, or one after the other with code for all effects.
template <class Real, class Intersector>
class FrameTask {
  public:
    using Scene = typename Intersector::Scene;
    using Media = typename Intersector::Media;

    /// Sets up the film. All arguments must outlive the task. The intersector's scene is a form of `compiled`, and so
    /// is `in_lanes`, if rays may be traced in lanes.
    FrameTask(const CompiledScene<Real>& compiled, const Intersector& intersector, const CameraFrame& camera,
              const FrameSettings& settings, Film& film, RenderProgress& progress,
              const LaneScene<Real>* in_lanes = nullptr)
        : scene_(intersector.scene),
          intersector_(intersector),
          settings_(settings),
          film_(film),
          progress_(progress),
          lane_scene_(in_lanes),
          frame_(frame_view(compiled, camera, settings)),
          hints_(frame_hints(compiled, frame_, settings)) {
        prepare_film(film, settings, compiled, camera);
        if (!(in_lanes != nullptr ? find_camera_solids(*in_lanes, frame_)
                                  : find_camera_solids(scene_, intersector, frame_)))
            film.flags |= flag_media_overflow;
        if (settings.layers.any() && !fills_film_layers<Intersector>)
            throw Error(ErrorKind::usage, "this intersector has no layers");
        if (in_lanes != nullptr && camera_fits_lanes()) tiles_ = tile_functions(*in_lanes, settings.lanes);
        mask_ = mask_to_run(compiled.effects, settings, frame_);
        if (mask_ < effect_mask_count) mask_ = tiles_ != nullptr ? lane_masks[least_lane_mask(mask_)] : limited_mask;
    }

    /// The effects that are compiled into the code that runs.
    uint32_t effects() const { return effect_masks[mask_] & all_effects; }

    /// The number of rays that are traced at once.
    int lanes() const { return tiles_ != nullptr ? tiles_->lanes : 1; }

    /// Renders the frame; false if it was stopped.
    bool run() {
        if (tiles_ != nullptr) return goes_by_sample() ? render_samples_in_lanes() : render_in_lanes();
        if constexpr (fills_film_layers<Intersector>)
            if (settings_.layers.any()) return render_one_by_one<layered_mask>();
        return render_one_by_one<limited_mask>();
    }

  private:
    template <class E>
    using Stack = StoppableStack<StackOf<Real, E, Media>, RenderStop>;

    template <class E>
    PixelTask<E, Intersector, Stack<E>> task_for(const TilePixel& pixel, PixelWork& own, Stack<E>& stack) const {
        return {scene_, frame_, intersector_, pixel.x, pixel.y, own, stack};
    }

    /// Whether lanes can hold the solids that contain the camera.
    bool camera_fits_lanes() const {
        bool fits = true;
        for (int i = 0; i < 1 << frame_.camera_planes; ++i)
            fits &= InteriorSet::holds(frame_.camera_sides[i].media, lane_scene_->named);
        return fits;
    }

    bool stopped() const { return progress_.stop.load(std::memory_order_relaxed); }

    /// Renders one ray after the other.
    template <int mask>
    bool render_one_by_one() {
        return settings_.adaptive() ? render_adaptive<mask>() : render_grid<mask>();
    }

    /// Renders with a uniform grid of samples.
    template <int mask>
    bool render_grid() {
        using E = Effects<effect_masks[mask]>;
        return for_each_pixel([&](const TilePixel& pixel, PixelWork& own) {
            typename Stack<E>::Storage storage;
            Stack<E> stack(storage, RenderStop{progress_.stop});
            PixelTask task = task_for<E>(pixel, own, stack);
            if constexpr (mask == layered_mask) task.layers = pixel.layers;
            render_pixel(task, SampleRange(), pixel.record);
        });
    }

    /// Renders with a uniform grid of samples, many rays at once.
    bool render_in_lanes() {
        return for_each_tile([&](Tile& tile) {
            TileRenderer renderer(*tiles_, mask_, lane_scene_, frame_);
            for_each_covered(tile, [&](const TilePixel& pixel) {
                const int samples = frame_.supersample * frame_.supersample;
                renderer.add({pixel.x, pixel.y, 0, samples, {frame_.tree.threshold}, &pixel.record, pixel.layers});
            });
            renderer.render(progress_.stop, tile.counts.rays, tile.counts.flags);
        });
    }

    /// Whether each sample is rendered by itself: in frames with a cutoff or a target error.
    bool goes_by_sample() const { return frame_.tree.budget != 0 || settings_.adaptive(); }

    /// Renders sample by sample, many rays at once.
    bool render_samples_in_lanes() {
        return for_each_tile([&](Tile& tile) {
            PixelsBySample pixels(*tiles_, lane_scene_, frame_);
            for_each_covered(
                tile, [&](const TilePixel& pixel) { pixels.add(pixel.x, pixel.y, pixel.record, pixel.layers.words); });
            pixels.render(progress_.stop, tile.counts.rays, tile.counts.flags);
        });
    }

    /// Renders with a target error.
    template <int mask>
    bool render_adaptive() {
        using E = Effects<effect_masks[mask]>;
        const bool gradual = shades_gradually(scene_);
        return for_each_pixel([&](const TilePixel& pixel, PixelWork& own) {
            typename Stack<E>::Storage storage;
            Stack<E> stack(storage, RenderStop{progress_.stop});
            PixelTask task = task_for<E>(pixel, own, stack);
            std::unique_ptr<int64_t[]> samples;
            if constexpr (mask == layered_mask) {
                task.layers = pixel.layers;
                samples = std::make_unique_for_overwrite<int64_t[]>(size_t(lattice_samples) *
                                                                    size_t(frame_.layers.sample_words()));
            }
            render_adaptive_pixel(task, gradual, pixel.record, samples.get());
        });
    }

    /// Calls render(pixel, work) for each pixel of the film where the scene may be visible, in tiles.
    template <class Render>
    bool for_each_pixel(const Render& render) {
        return for_each_tile([&](Tile& tile) {
            for_each_covered(tile, [&](const TilePixel& pixel) {
                if (stopped()) return;
                PixelWork own;
                render(pixel, own);
                tile.counts.rays.add(own.rays);
                tile.counts.flags |= own.flags;
            });
        });
    }

    /// Shows finished tiles to observers as long as it exists.
    struct ShownTiles {
        ShownTiles(FinishedTiles& to, const Film& film, int side) : tiles(to) { tiles.begin(film, side); }
        ~ShownTiles() { tiles.end(); }
        ShownTiles(const ShownTiles&) = delete;
        ShownTiles& operator=(const ShownTiles&) = delete;

        FinishedTiles& tiles;
    };

    /// Calls render(tile) for each tile of the film, and puts its records into the film; false if it was stopped.
    bool for_each_tile(const std::function<void(Tile&)>& render) {
        const PixelRect rect = film_.rect;
        const int tile = settings_.tile;
        const int columns = (rect.width + tile - 1) / tile;
        const int rows = (rect.height + tile - 1) / tile;
        std::mutex totals;
        std::atomic<bool> failed{is_unreliable(film_.flags)};  // nobody wants the rest then
        const ShownTiles shown(progress_.tiles, film_, tile);
        tbb::parallel_for(tbb::blocked_range<int64_t>(0, int64_t(columns) * rows, 1), [&](const auto& range) {
            if (stopped() || failed) return;
            const DefaultRounding rounding;
            Tile own(tile);
            for (int64_t t = range.begin(); t != range.end(); ++t) {
                const int x = int(t % columns) * tile;
                const int y = int(t / columns) * tile;
                own.begin({x, y, std::min(tile, rect.width - x), std::min(tile, rect.height - y)});
                render(own);
                if (stopped() || failed) return;
                failed = failed || is_unreliable(own.counts.flags);
                own.put_into(film_);
                progress_.pixels_done += uint64_t(own.rect.width) * uint64_t(own.rect.height);
                progress_.rays += own.counts.rays.total();
                const std::lock_guard<std::mutex> lock(totals);
                film_.add(own.counts);
                progress_.tiles.finish(own.rect);
            }
        });
        return !progress_.stop.load();
    }

    /// Calls render(pixel) for each pixel of a tile where the scene may be visible, and fills the others. The pixel's
    /// record stays where it is until the tile is put into the film.
    template <class Render>
    void for_each_covered(Tile& tile, const Render& render) {
        const PixelWriter writer(film_.pixels.planes());
        const PixelRect& rect = tile.rect;
        for (int y = rect.y; y < rect.y + rect.height; ++y)
            hints_.cover.for_each_part(y, rect.x, rect.x + rect.width, [&](int begin, int end, bool covered) {
                const size_t first = size_t(y) * size_t(film_.rect.width) + size_t(begin);
                const size_t count = size_t(end - begin);
                if (!covered) {
                    hints_.fill(writer, film_.rect.x + begin, film_.rect.y + y, end - begin, first, tile.counts);
                    return fill_background_layers(film_, first, count);
                }
                film_.layers.clear(first, count);
                for (size_t i = 0; i < count; ++i)
                    render(TilePixel{film_.rect.x + begin + int(i), film_.rect.y + y, tile.record_of(first + i),
                                     PixelLayers{film_.layers.of(first + i), 1}});
            });
    }

    const DefaultRounding rounding_;  // first: what follows is computed in it
    const Scene& scene_;
    const Intersector& intersector_;
    const FrameSettings& settings_;
    Film& film_;
    RenderProgress& progress_;
    const LaneScene<Real>* const lane_scene_;
    FrameView frame_;
    const FrameHints hints_;
    int mask_ = 0;
    const TileFunctions* tiles_ = nullptr;  // of a frame that is rendered in lanes
};

}  // namespace cistula
