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
            int pixel = 0;
            int i = 0;
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
          first_((blockIdx.x * adaptive_shape.warps + threadIdx.x / warp_threads) * warp_pixels),
          storage_(job.storage + first_) {}

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

    /// Calls take(x, y, pixel, slot, sight) for one wanted sample per lane; false if no lane has any.
    template <class Take>
    __device__ bool take_samples(const Take& take) {
        const WarpScheduler pieces = WarpScheduler::of(wanted_ - given_);
        if (pieces.total == 0) return false;
        int pixel = 0;
        int i = 0;
        pieces.find(lane_, pixel, i);
        const int x = __shfl_sync(whole_warp, x_, pixel);
        const int y = __shfl_sync(whole_warp, y_, pixel);
        const unsigned int record = __shfl_sync(whole_warp, record_, pixel);
        i += __shfl_sync(whole_warp, given_, pixel);
        if (lane_ < pieces.total) take(x, y, pixel, storage_[pixel].pixel.wanted(i), job_.records.sights[record]);
        __syncwarp();
        given_ += clamped(warp_threads - pieces.before, 0, wanted_ - given_);
        return true;
    }

    /// What is stored of a pixel's samples, and a sample's layers.
    __device__ LatticeStorage& storage(int pixel) const { return storage_[pixel]; }
    __device__ int64_t* layers_of(int pixel, int slot) const {
        const size_t sample = size_t(first_ + unsigned(pixel)) * lattice_samples + unsigned(slot);
        return job_.sample_layers + sample * unsigned(job_.frame.layers.sample_words());
    }

    /// Lets pixels that have all samples of their round decide which samples they want next, and writes the sums of
    /// those that are finished. `layered`: their layers too.
    template <bool layered>
    __device__ void finish_round([[maybe_unused]] uint32_t& flags) {
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
            int pixel = 0;
            int i = 0;
            standing.find(j, pixel, i);
            const unsigned int place = __shfl_sync(whole_warp, record, pixel);
            if (j >= standing.total) continue;
            // Summed locally: reading the next sample right after an atomic addition would wait for it.
            PixelRecord cell = PixelRecord();
            storage_[pixel].pixel.accumulate(
                i, [&](int slot, int weight) { storage_[pixel].samples[slot].give(cell, weight, Plus()); });
            cell.give(job_.records.radiance[place], job_.records.losses[place], AtomicAdd());
        }
        if constexpr (layered) {
            for (unsigned int left = __ballot_sync(whole_warp, done); left != 0; left &= left - 1) {
                const int pixel = __ffs(int(left)) - 1;
                fill_layers(pixel, __shfl_sync(whole_warp, cells_, pixel), __shfl_sync(whole_warp, record_, pixel),
                            flags);
            }
            __syncwarp();
        }
        if (done) storage_[lane_].pixel.describe(job_.records.radiance[record_]);
    }

  private:
    __device__ void begin(unsigned int place) {
        const BlockPlace tile = job_.blocks[place / warp_threads];
        const PixelPlace in_tile = BlockPlan{PixelMapping::shared_tile}.place_of(int(place % warp_threads));
        const int column = tile.column * tile_width + in_tile.column;
        const int row = tile.row * tile_height + in_tile.row;
        record_ = place;
        job_.records.put(record_, PixelRecord());  // also beyond the rectangle: whole tiles are copied
        if (column >= job_.width || row >= job_.height) return;
        x_ = job_.x + column;
        y_ = job_.y + row;
        storage_[lane_].pixel.begin(is_checked(x_, y_));
        note_wishes();
    }

    /// Fills the layers of a finished pixel from those of its samples: a lane adds up a word, so that the loads of a
    /// warp lie side by side.
    __device__ void fill_layers(int pixel, int cells, unsigned int record, uint32_t& flags) const {
        const LayerPlan& plan = job_.frame.layers;
        const LatticePixel& lattice = storage_[pixel].pixel;
        int64_t* to = job_.layers_of(record).words;
        for (int word = lane_; word < plan.sums(); word += warp_threads) {
            int64_t sum = 0;
            for (int i = 0; i < cells; ++i)
                lattice.accumulate(i, [&](int slot, int weight) { sum += weight * layers_of(pixel, slot)[word]; });
            to[word] = sum;
        }
        if (plan.sample_words() == plan.sums()) return;
        for (int i = lane_; i < cells; i += warp_threads)
            lattice.accumulate(i, [&](int slot, int weight) {
                if (!give_first_hit(plan, layers_of(pixel, slot), weight, LatticePixel::is_chosen(slot), to))
                    flags |= flag_objects_overflow;
            });
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
    const unsigned int first_;   // of the pixels in the job's storage
    LatticeStorage* const storage_;
    bool more_ = true;  // whether there are pixels that no warp has started
    int x_ = 0;
    int y_ = 0;
    unsigned int record_ = 0;
    // samples of this round: taken by lanes, and all; wanted 0: no pixel
    int given_ = 0;
    int wanted_ = 0;
    int cells_ = 0;
};

template <class Real, int mask, DevicePath path>
__global__ void __launch_bounds__(adaptive_shape.threads(), least_blocks<Real>(adaptive_shape, path))
    render_adaptive(const __grid_constant__ FrameJob job,
                    const __grid_constant__ typename PathTraits<Real, path>::Scene scene) {
    using E = Effects<effect_masks[mask]>;
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
        const bool any = pixels.take_samples([&](int x, int y, int pixel, int slot, PixelSight& sight) {
            LatticeStorage& storage = pixels.storage(pixel);
            TreeThreshold threshold{LatticePixel::first_threshold(job.frame.tree, storage.samples, slot)};
            PixelTask<E, Intersector, Stack> task{scene, job.frame, intersector, x, y, own, stack};
            if constexpr (E::has(fills_layers)) task.layers = {pixels.layers_of(pixel, slot)};
            const uint32_t hash = take_sample(task, slot, gradual, threshold, taken);
            storage.samples[slot].keep(taken, hash, threshold.share);
            AtomicAdd()(sight.rays, taken.rays);
            if (LatticePixel::is_chosen(slot)) choose_sample(taken, sight);
        });
        if (!any || __any_sync(whole_warp, ends)) break;
        pixels.template finish_round<E::has(fills_layers)>(own.flags);
    }
    add_to_tally(*job.tally, own.rays, own.flags);
}

}  // namespace cistula
