// The device's launcher of adaptively sampled pixels. They want from 4 samples to 256 of trees of all sizes: a warp has
// a few pixels at work, next to each other, and its lanes take what these want at the time, so that no lane waits for
// one pixel.
#pragma once

#include "backend_cuda/kernels/kernel_parts.cuh"
#include "cistula/adaptive/adaptive_pixel.h"

namespace cistula {

inline constexpr int warp_pixels = pixels_at_work / adaptive_shape.warps;
inline constexpr unsigned int whole_warp = 0xffffffffu;

/// Deals the pieces of work of a warp's pixels to its lanes: lane s knows how many pieces come before pixel s's.
struct WarpScheduler {
    int before, total;

    /// `count`: lane s's is pixel s's, others' are 0.
    __device__ static WarpScheduler of(int count) {
        const int lane = threadIdx.x % warp_threads;
        int sum = count;
        for (int step = 1; step < warp_pixels; step *= 2) {
            const int other = __shfl_up_sync(whole_warp, sum, step);
            if (lane >= step) sum += other;
        }
        return {sum - count, __shfl_sync(whole_warp, sum, warp_pixels - 1)};
    }

    /// Piece j < total is piece i of `pixel`. All lanes must ask.
    __device__ void find(int j, int& pixel, int& i) const {
        for (int s = 0; s < warp_pixels; ++s) {
            const int first = __shfl_sync(whole_warp, before, s);
            if (first <= j) pixel = s, i = j - first;
        }
    }

    /// visit(pixel, i) for all pieces, each in one lane.
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

/// Adds to what other lanes add to.
struct AtomicAdd {
    __device__ void operator()(int64_t& to, int64_t value) const {
        if (value != 0) atomicAdd(reinterpret_cast<unsigned long long*>(&to), (unsigned long long)value);
    }
    __device__ void operator()(uint32_t& to, uint32_t value) const {
        if (value != 0) atomicAdd(&to, value);
    }
};

/// The pixels that a warp has at work: lane s < warp_pixels has the s-th.
class WarpPixels {
  public:
    __device__ WarpPixels(const FrameJob& job)
        : job_(job),
          records_(job.records),
          lane_(threadIdx.x % warp_threads),
          places_(job.block_count * warp_threads),
          at_once_(clamped(int(places_ / (gridDim.x * adaptive_shape.warps)), 1, warp_pixels)),
          storage_(job.storage + (blockIdx.x * adaptive_shape.warps + threadIdx.x / warp_threads) * warp_pixels) {}

    /// New pixels for those that are done, while less than a sample a lane is wanted.
    __device__ void refill() {
        while (more_) {
            const int waiting = int(warp_sum(unsigned(wanted_ - given_)));
            const unsigned int free = __ballot_sync(whole_warp, lane_ < at_once_ && wanted_ == 0);
            if (waiting >= warp_threads || free == 0) break;
            const int take =
                least(__popc(free), (warp_threads - waiting + least_lattice_samples - 1) / least_lattice_samples);
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

    /// Calls take(x, y, storage, slot, record) for one wanted sample a lane; false if there is none for any.
    template <class Take>
    __device__ bool take_samples(const Take& take) {
        const WarpScheduler pieces = WarpScheduler::of(wanted_ - given_);
        if (pieces.total == 0) return false;
        int pixel = 0, i = 0;
        pieces.find(lane_, pixel, i);
        const int x = __shfl_sync(whole_warp, x_, pixel), y = __shfl_sync(whole_warp, y_, pixel);
        const unsigned int record = __shfl_sync(whole_warp, record_, pixel);
        i += __shfl_sync(whole_warp, given_, pixel);
        if (lane_ < pieces.total) take(x, y, storage_[pixel], storage_[pixel].pixel.wanted(i), records_[record]);
        __syncwarp();
        given_ += clamped(warp_threads - pieces.before, 0, wanted_ - given_);
        return true;
    }

    /// Lets those that have all that they wanted in their round decide what they want next.
    __device__ void finish_round() {
        const bool ready = wanted_ != 0 && given_ == wanted_;
        if (!__any_sync(whole_warp, ready)) return;
        const LatticeSettings& settings = job_.frame.lattice;
        const WarpScheduler cells = WarpScheduler::of(ready ? cells_ : 0);
        cells.for_each([&](int pixel, int i) { storage_[pixel].pixel.judge(settings, storage_[pixel].samples, i); });
        if (ready) {
            storage_[lane_].pixel.divide(settings);
            note_wishes();
        }
        __syncwarp();
        const bool done = ready && wanted_ == 0;
        const WarpScheduler standing = WarpScheduler::of(done ? cells_ : 0);
        const unsigned int record = record_;
        for (int j = lane_; __any_sync(whole_warp, j < standing.total); j += warp_threads) {
            int pixel = 0, i = 0;
            standing.find(j, pixel, i);
            PixelRecord& to = records_[__shfl_sync(whole_warp, record, pixel)];
            if (j >= standing.total) continue;
            // In one sum: to read the next sample after adding where others add would be to wait for it.
            PixelRecord cell = PixelRecord();
            storage_[pixel].pixel.accumulate(
                settings, i, [&](int slot, int weight) { storage_[pixel].samples[slot].give(cell, weight, Plus()); });
            cell.give(to, AtomicAdd());
        }
        if (!done) return;
        const uint32_t taken = uint32_t(storage_[lane_].pixel.taken()), unmet = storage_[lane_].pixel.unmet();
        records_[record_].samples = taken;
        records_[record_].unmet = unmet;
    }

  private:
    __device__ void begin(unsigned int place) {
        const BlockPlace tile = job_.blocks[place / warp_threads];
        const PixelPlace in_tile = BlockPlan{PixelMapping::shared_tile}.place_of(int(place % warp_threads));
        const int column = tile.column * tile_width + in_tile.column, row = tile.row * tile_height + in_tile.row;
        record_ = place;
        records_[record_] = PixelRecord();  // beyond the rectangle too: all of a tile are copied
        if (column >= job_.width || row >= job_.height) return;
        x_ = job_.x + column;
        y_ = job_.y + row;
        storage_[lane_].pixel.begin(job_.frame.lattice);
        note_wishes();
    }

    /// Right after the pixel has decided, while it is at hand.
    __device__ void note_wishes() {
        given_ = 0;
        wanted_ = storage_[lane_].pixel.wanted();
        cells_ = storage_[lane_].pixel.cells();
    }

    const FrameJob& job_;
    PixelRecord* const records_;
    const int lane_;
    const unsigned int places_;  // of pixels: blocks are tiles
    const int at_once_;          // pixels: of a small frame fewer, so that all warps have some
    LatticeStorage* const storage_;
    bool more_ = true;  // pixels that nobody has begun
    int x_ = 0, y_ = 0;
    unsigned int record_ = 0;
    int given_ = 0, wanted_ = 0;  // samples of this round that lanes took, and all of them; none wanted: no pixel
    int cells_ = 0;
};

template <class Real, DevicePath path>
__global__ void __launch_bounds__(adaptive_shape.threads(), least_blocks<Real>(adaptive_shape, path))
    render_adaptive(const __grid_constant__ FrameJob job,
                    const __grid_constant__ typename PathTraits<Real, path>::Scene scene) {
    using E = Effects<all_effects>;
    using Stack = DeviceStack<Real, E, path>;
    __shared__ Unset<BlockStorage<adaptive_shape.threads()>> memory;
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
        const bool ends = stack.stopped();  // asked ahead: the answer takes a while
        const bool any = pixels.take_samples([&](int x, int y, LatticeStorage& pixel, int slot, PixelRecord& record) {
            const uint32_t hash =
                take_sample(PixelTask<E, Intersector, Stack>{scene, job.frame, intersector, x, y, own, stack}, slot,
                            gradual, taken);
            pixel.samples[slot].keep(taken, hash);
            AtomicAdd()(record.rays, taken.rays);
            if (LatticePixel::is_chosen(job.frame.lattice, slot)) choose_sample(taken, record);
        });
        if (!any || __any_sync(whole_warp, ends)) break;
        pixels.finish_round();
    }
    add_to_tally(*job.tally, own.rays, own.flags);
}

}  // namespace cistula
