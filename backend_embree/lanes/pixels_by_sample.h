// Pixels of frames with a cutoff or a target error, rendered in lanes: each sample by itself, until its threshold
// holds.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "backend_embree/lanes/lane_renderer.h"
#include "cistula/adaptive/adaptive_pixel.h"

namespace cistula {

class PixelsBySample {
  public:
    /// The scene, a LaneScene of the precision of `functions`, and the frame must outlive this.
    PixelsBySample(const TileFunctions& functions, const void* scene, const FrameView& frame)
        : frame_(frame), renderer_(functions, scene, frame) {
        if (frame.layers.words > 0) layered_.emplace(functions, layered_mask, scene, frame);
    }

    /// Adds a pixel of the frame.
    void add(int x, int y, PixelRecord& record, int64_t* layers) { pixels_.push_back({x, y, &record, layers}); }

    /// Renders the pixels, unless it is stopped, and adds what they count.
    void render(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) {
        const bool adaptive = frame_.lattice.target != 0;
        const size_t together = adaptive ? most_pixels : std::max<size_t>(most_samples / grid_samples(), 1);
        for (first_ = 0; first_ < pixels_.size() && !stop; first_ += together) {
            count_ = std::min(pixels_.size() - first_, together);
            if (adaptive)
                render_adaptively(stop, rays, flags);
            else
                render_grid(stop, rays, flags);
        }
        pixels_.clear();
    }

  private:
    // Pixels and samples at a time: an adaptive pixel has some 24 KiB of samples, and a sample 150 bytes.
    static constexpr size_t most_pixels = 256;
    static constexpr size_t most_samples = 4096;

    struct Pixel {
        int x, y;
        PixelRecord* record;
        int64_t* layers;
    };
    /// A sample that is under way, or that is to be entered into layers.
    struct Taken {
        size_t pixel;
        int slot, weight;
        PixelRecord record;
        LaneSample sample;
    };

    size_t grid_samples() const { return size_t(frame_.supersample) * size_t(frame_.supersample); }
    const Pixel& pixel(size_t i) const { return pixels_[first_ + i]; }

    void want(size_t pixel, int slot, const TreeThreshold& threshold, int weight = 1) {
        taken_.push_back({pixel, slot, weight, {}, {threshold}});
    }

    /// Renders all samples of the grid.
    void render_grid(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) {
        taken_.clear();
        for (size_t i = 0; i < count_; ++i)
            for (int slot = 0; slot < int(grid_samples()); ++slot) want(i, slot, {frame_.tree.threshold});
        take_samples(stop, rays, flags);
        for (size_t i = 0; i < count_; ++i) begin_pixel(*pixel(i).record);
        for (const Taken& taken : taken_) pixel(taken.pixel).record->add(taken.record);
        fill_layers(stop, flags);
    }

    /// Renders the samples that each pixel wants, in rounds of all.
    void render_adaptively(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) {
        if (!adaptive_) adaptive_ = std::make_unique_for_overwrite<AdaptivePixel[]>(most_pixels);
        for (size_t i = 0; i < count_; ++i) adaptive_[i].begin(is_checked(pixel(i).x, pixel(i).y), *pixel(i).record);
        for (;;) {
            taken_.clear();
            for (size_t i = 0; i < count_; ++i)
                for (int k = 0; k < adaptive_[i].wanted(); ++k)
                    want(i, adaptive_[i].wanted(k),
                         {adaptive_[i].first_threshold(frame_.tree, adaptive_[i].wanted(k))});
            if (taken_.empty()) break;
            take_samples(stop, rays, flags);
            if (stop) return;
            for (const Taken& taken : taken_)
                adaptive_[taken.pixel].keep(taken.slot, taken.record, taken.sample.path_hash,
                                            taken.sample.threshold.share, *pixel(taken.pixel).record);
            for (size_t i = 0; i < count_; ++i)
                if (adaptive_[i].wanted() > 0) adaptive_[i].end_round(frame_.lattice);
        }
        for (size_t i = 0; i < count_; ++i)
            adaptive_[i].finish(*pixel(i).record, [&](int slot, int weight, float threshold) {
                if (layered_) want(i, slot, {threshold}, weight);
            });
        fill_layers(stop, flags);
    }

    /// Takes the samples that are wanted; those whose thresholds do not hold once more, and so on.
    void take_samples(const std::atomic<bool>& stop, RayCounts& rays, uint32_t& flags) {
        const auto fails = [](const Taken& taken) { return !taken.sample.holds; };
        while (!stop && std::any_of(taken_.begin(), taken_.end(), fails)) {
            for (Taken& taken : taken_)
                if (fails(taken)) add_to(renderer_, taken, {});
            renderer_.render(stop, rays, flags);
        }
    }

    /// Enters samples into the layers, by tracing them again.
    void fill_layers(const std::atomic<bool>& stop, uint32_t& flags) {
        if (!layered_ || stop) return;
        for (Taken& taken : taken_) {
            taken.sample.threshold.has_grown = true;  // it has held
            add_to(*layered_, taken, {pixel(taken.pixel).layers, taken.weight});
        }
        RayCounts counted;
        uint32_t flagged = 0;
        layered_->render(stop, counted, flagged);
        flags |= flagged & flag_objects_overflow;
    }

    void add_to(TileRenderer& renderer, Taken& taken, const PixelLayers& layers) const {
        const Pixel& of = pixel(taken.pixel);
        renderer.add({of.x, of.y, taken.slot, 1, taken.sample.threshold, &taken.record, layers, &taken.sample});
    }

    const FrameView& frame_;
    TileRenderer renderer_;
    std::optional<TileRenderer> layered_;  // of frames with layers
    std::vector<Pixel> pixels_;
    // of the pixels under way
    size_t first_ = 0;
    size_t count_ = 0;
    std::vector<Taken> taken_;
    std::unique_ptr<AdaptivePixel[]> adaptive_;
};

}  // namespace cistula
