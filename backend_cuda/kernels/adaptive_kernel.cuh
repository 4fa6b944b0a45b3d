// The kernel for adaptively sampled pixels, which take from 5 to 256 samples with ray trees of all sizes. A warp works
// on several neighboring pixels, and its lanes take the samples that these want at the time, so that no lane waits for
// one pixel.
#pragma once

#include "backend_cuda/kernels/kernel_parts.cuh"
#include "cistula/adaptive/adaptive_pixel.h"

namespace cistula {

inline constexpr int warp_pixels = pixels_at_work / adaptive_shape.warps;
inline constexpr unsigned int whole_warp = 0xffffffffu;

/// Distributes the work items of a warp's pixels over its lanes: lane s holds the number of items before pixel s's.
struct WarpScheduler {
    int before, total;

    /// `count`: in lane s the number of items of pixel s; in the remaining lanes 0.
    __device__ static WarpScheduler of(int count) {
        const int lane = threadIdx.x % warp_threads;
        int sum = count;
        for (int step = 1; step < warp_pixels; step *= 2) {
            const int other = __shfl_up_sync(whole_warp, sum, step);
            if (lane >= step) sum += other;
        }
        return {sum - count, __shfl_sync(whole_warp, sum, warp_pixels - 1)};
    }

    /// Finds the pixel and the index in it of work item j < total. All lanes must call it.
    __device__ void find(int j, int& pixel, int& i) const {
        for (int s = 0; s < warp_pixels; ++s) {
            const int first = __shfl_sync(whole_warp, before, s);
            if (first <= j) pixel = s, i = j - first;
        }
    }

    /// Calls visit(pixel, i) for all items, each in one lane.
    template <class Visit>
    __device__ void for_each(const Visit& visit) const {
        for (int j = threadIdx.x % warp_threads; __any_sync(whole_warp, j < total); j += warp_threads) {
            int pixel = 0, i = 0;
            find(j, pixel, i);
            if (j < total) visit(pixel, i);
        }
        __syncwarp();
    }
};

/// An atomic addition, for sums to which several lanes add.
struct AtomicAdd {
    __device__ void operator()(int64_t& to, int64_t value) const {
        if (value != 0) atomicAdd(reinterpret_cast<unsigned long long*>(&to), (unsigned long long)value);
    }
    __device__ void operator()(uint32_t& to, uint32_t value) const {
        if (value != 0) atomicAdd(&to, value);
    }
};

/// The pixels that a warp works on: lane s < warp_pixels holds the s-th.
class WarpPixels {
  public:
    __device__ WarpPixels(const FrameJob& job)
        : job_(job),
          lane_(threadIdx.x % warp_threads),
          places_(job.block_count * warp_threads),
          at_once_(clamped(int(places_ / (gridDim.x * adaptive_shape.warps)), 1, warp_pixels)),
          storage_(job.storage + (blockIdx.x * adaptive_shape.warps + threadIdx.x / warp_threads) * warp_pixels) {}

    /// Starts new pixels in place of finished ones while fewer samples are wanted than there are lanes.
    __device__ void refill() {
        while (more_) {
            const int waiting = int(warp_sum(unsigned(wanted_ - given_)));
            const unsigned int free = __ballot_sync(whole_warp, lane_ < at_once_ && wanted_ == 0);
            if (waiting >= warp_threads || free == 0) break;
            const int take = min_or_second(
                __popc(free), (warp_threads - waiting + least_lattice_samples - 1) / least_lattice_samples);
            unsigned int first = 0;
            if (lane_ == 0) first = atomicAdd(job_.next, unsigned(take));
            first = __shfl_sync(whole_warp, first, 0);
            more_ = first + unsigned(take) < places_;
            const int rank = __popc(free & ((1u << lane_) - 1u));
            if ((free >> lane_ & 1u) != 0 && rank < take && first + unsigned(rank) < places_)
                begin(first + unsigned(rank));
        }
        __syncwarp();
    }

    /// Calls take(x, y, storage, slot, sight) for one wanted sample per lane; false if no lane has any.
    template <class Take>
    __device__ bool take_samples(const Take& take) {
        const WarpScheduler pieces = WarpScheduler::of(wanted_ - given_);
        if (pieces.total == 0) return false;
        int pixel = 0, i = 0;
        pieces.find(lane_, pixel, i);
        const int x = __shfl_sync(whole_warp, x_, pixel), y = __shfl_sync(whole_warp, y_, pixel);
        const unsigned int record = __shfl_sync(whole_warp, record_, pixel);
        i += __shfl_sync(whole_warp, given_, pixel);
        if (lane_ < pieces.total)
            take(x, y, storage_[pixel], storage_[pixel].pixel.wanted(i), job_.records.sights[record]);
        __syncwarp();
        given_ += clamped(warp_threads - pieces.before, 0, wanted_ - given_);
        return true;
    }

    /// Lets pixels that have all samples of their round decide which samples they want next, and writes the sums of
    /// those that are finished. stands_for(x, y, record, slot, weight, threshold) is told of their samples if it is
    /// `wanted`.
    template <class StandsFor>
    __device__ void finish_round(const StandsFor& stands_for) {
        const bool ready = wanted_ != 0 && given_ == wanted_;
        if (!__any_sync(whole_warp, ready)) return;
        const LatticeSettings& settings = job_.frame.lattice;
        const WarpScheduler cells = WarpScheduler::of(ready ? cells_ : 0);
        cells.for_each([&](int pixel, int i) { storage_[pixel].pixel.judge(settings, storage_[pixel].samples, i); });
        if (ready) {
            storage_[lane_].pixel.divide(settings, storage_[lane_].samples);
            note_wishes();
        }
        __syncwarp();
        const bool done = ready && wanted_ == 0;
        const WarpScheduler standing = WarpScheduler::of(done ? cells_ : 0);
        const unsigned int record = record_;
        for (int j = lane_; __any_sync(whole_warp, j < standing.total); j += warp_threads) {
            int pixel = 0, i = 0;
            standing.find(j, pixel, i);
            const unsigned int place = __shfl_sync(whole_warp, record, pixel);
            int x = 0, y = 0;
            if constexpr (StandsFor::wanted) {
                x = __shfl_sync(whole_warp, x_, pixel);
                y = __shfl_sync(whole_warp, y_, pixel);
            }
            if (j >= standing.total) continue;
            // Summed locally: reading the next sample right after an atomic addition would wait for it.
            PixelRecord cell = PixelRecord();
            storage_[pixel].pixel.accumulate(i, [&](int slot, int weight) {
                storage_[pixel].samples[slot].give(cell, weight, Plus());
                if constexpr (StandsFor::wanted)
                    stands_for(x, y, place, slot, weight, storage_[pixel].samples[slot].threshold);
            });
            cell.give(job_.records.radiance[place], job_.records.losses[place], AtomicAdd());
        }
        if (done) storage_[lane_].pixel.describe(job_.records.radiance[record_]);
    }

  private:
    __device__ void begin(unsigned int place) {
        const BlockPlace tile = job_.blocks[place / warp_threads];
        const PixelPlace in_tile = BlockPlan{PixelMapping::shared_tile}.place_of(int(place % warp_threads));
        const int column = tile.column * tile_width + in_tile.column, row = tile.row * tile_height + in_tile.row;
        record_ = place;
        job_.records.put(record_, PixelRecord());  // also beyond the rectangle: whole tiles are copied
        if (column >= job_.width || row >= job_.height) return;
        x_ = job_.x + column;
        y_ = job_.y + row;
        storage_[lane_].pixel.begin(is_checked(x_, y_));
        note_wishes();
    }

    /// Reads the pixel's wishes right after it has decided, while they are in cache.
    __device__ void note_wishes() {
        given_ = 0;
        wanted_ = storage_[lane_].pixel.wanted();
        cells_ = storage_[lane_].pixel.cells();
    }

    const FrameJob& job_;
    const int lane_;
    const unsigned int places_;  // number of pixels: a block is a tile
    const int at_once_;          // pixels; fewer in a small frame, so that all warps have some
    LatticeStorage* const storage_;
    bool more_ = true;  // whether there are pixels that no warp has started
    int x_ = 0, y_ = 0;
    unsigned int record_ = 0;
    int given_ = 0, wanted_ = 0;  // samples of this round: taken by lanes, and all; wanted 0: no pixel
    int cells_ = 0;
};

/// What happens to samples that count in the end: nothing more.
struct NoLayers {
    static constexpr bool wanted = false;
};
/// What happens to samples that count in the end: they are traced again into the layers of their pixel.
template <class Real, class Intersector, class Stack>
struct IntoLayers {
    static constexpr bool wanted = true;
    using E = Effects<effect_masks[layered_mask]>;
    const FrameJob& job;
    const typename Intersector::Scene& scene;
    const Intersector& intersector;
    PixelWork& own;
    Stack& stack;

    __device__ void operator()(int x, int y, unsigned int record, int slot, int weight, float threshold) const {
        add_layers(
            PixelTask<E, Intersector, Stack>{scene, job.frame, intersector, x, y, own, stack, job.layers_of(record)},
            slot, weight, threshold);
    }
};

template <class Real, DevicePath path, bool layered>
__global__ void __launch_bounds__(adaptive_shape.threads(), least_blocks<Real>(adaptive_shape, path))
    render_adaptive(const __grid_constant__ FrameJob job,
                    const __grid_constant__ typename PathTraits<Real, path>::Scene scene) {
    using E = Effects<effect_masks[limited_mask]>;
    using Stack = DeviceStack<Real, E, path>;
    __shared__ Uninitialized<BlockStorage<adaptive_shape.threads()>> memory;
    PixelWork& own = memory.get().work[threadIdx.x] = PixelWork();
    PixelRecord& taken = memory.get().records[threadIdx.x];
    typename Stack::Storage branches;
    Stack stack(branches, JobStop{job.stop});
    using Intersector = typename PathTraits<Real, path>::Intersector;
    const Intersector intersector{scene};
    const bool gradual = shades_gradually(scene);
    WarpPixels pixels(job);
    for (;;) {
        pixels.refill();
        const bool ends = stack.stopped();  // read early: the load takes a while
        const bool any = pixels.take_samples([&](int x, int y, LatticeStorage& pixel, int slot, PixelSight& sight) {
            TreeThreshold threshold{LatticePixel::first_threshold(job.frame.tree, pixel.samples, slot)};
            const uint32_t hash =
                take_sample(PixelTask<E, Intersector, Stack>{scene, job.frame, intersector, x, y, own, stack}, slot,
                            gradual, threshold, taken);
            pixel.samples[slot].keep(taken, hash, threshold.share);
            AtomicAdd()(sight.rays, taken.rays);
            if (LatticePixel::is_chosen(slot)) choose_sample(taken, sight);
        });
        if (!any || __any_sync(whole_warp, ends)) break;
        if constexpr (layered)
            pixels.finish_round(IntoLayers<Real, Intersector, Stack>{job, scene, intersector, own, stack});
        else
            pixels.finish_round(NoLayers());
    }
    add_to_tally(*job.tally, own.rays, own.flags);
}

}  // namespace cistula
