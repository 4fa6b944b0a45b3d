// The device's launcher: render_pixel over the pixels of a job, a thread a pixel, then what their trees left waiting.
#pragma once

#include "backend_cuda/cuda_check.h"
#include "backend_cuda/frame_job.h"
#include "cistula/bvh.h"

namespace cistula {

inline constexpr int warp_threads = 32, block_warps = 4, block_threads = warp_threads * block_warps;
/// A warp renders a tile of 8 x 4 pixels, a block 2 x 2 of those: neighbors see the same things.
inline constexpr int tile_width = 8, tile_height = 4;
inline constexpr int record_words = sizeof(PixelRecord) / sizeof(unsigned long long);
static_assert(sizeof(PixelRecord) % sizeof(unsigned long long) == 0 && strip_rows % (2 * tile_height) == 0);

template <class Real, DevicePath path>
struct PathTraits;
template <class Real>
struct PathTraits<Real, DevicePath::plain_loop> {
    using Intersector = BruteIntersector<Real, OneMedium>;
};
template <class Real>
struct PathTraits<Real, DevicePath::tree> {
    using Intersector = BvhIntersector<Real, MediaList>;
};

template <class Real, class Media>
struct QueuedBranch {
    Branch<Real, Media> branch;
    unsigned int record;
};

/// Lets a thread follow its tree up to a number of surfaces. What waits then goes to the queue, so that deep trees are
/// split over many threads; the sums being integers, the order of work never shows.
template <class Real, class Media>
struct QueueTaker {
    BranchQueue queue;
    unsigned int record;
    int left;

    __device__ void shaded() { --left; }
    __device__ bool take(const Branch<Real, Media>& branch) {
        if (left > 0 || queue.capacity == 0) return false;
        const unsigned int place = atomicAdd(queue.size, 1u);
        if (place >= queue.capacity) return false;
        static_cast<QueuedBranch<Real, Media>*>(queue.items)[place] = {branch, record};
        return true;
    }
};

__device__ inline void add_to_tally(DeviceTally& tally, const RayCounts& rays, unsigned int flags) {
    const unsigned long long counts[4] = {rays.primary, rays.reflected, rays.transmitted, rays.shadow};
    const int lane = threadIdx.x % warp_threads, slot = (blockIdx.x + blockIdx.y * 7u) % DeviceTally::slots;
    for (int i = 0; i < 4; ++i) {
        unsigned long long sum = counts[i];
        for (int step = warp_threads / 2; step > 0; step /= 2) sum += __shfl_down_sync(0xffffffffu, sum, step);
        if (lane == 0 && sum != 0) atomicAdd(&tally.rays[slot][i], sum);
    }
    if (flags != 0) atomicOr(&tally.flags, flags);
}

template <class Real, class E, DevicePath path>
__global__ void __launch_bounds__(block_threads) render_pixels(const __grid_constant__ FrameJob<Real> job) {
    using Intersector = typename PathTraits<Real, path>::Intersector;
    using Media = typename Intersector::Media;
    __shared__ unsigned long long staged[block_warps][warp_threads * record_words];
    const int warp = threadIdx.x / warp_threads, lane = threadIdx.x % warp_threads;
    const int left = int(blockIdx.x) * 2 * tile_width + warp % 2 * tile_width;
    const int top = int(blockIdx.y) * 2 * tile_height + warp / 2 * tile_height;
    const int column = left + lane % tile_width, row = top + lane / tile_width;
    const int y = (job.first_strip + row / strip_rows * job.strip_step) * strip_rows + row % strip_rows;
    RayCounts rays;
    unsigned int flags = 0;
    PixelRecord record;
    if (column < job.width && row < job.rows && y < job.height) {
        const QueueTaker<Real, Media> taker{job.to, unsigned(row) * unsigned(job.width) + unsigned(column), job.surfaces};
        flags = render_pixel<Real, E>(job.scene, job.frame, Intersector{job.scene}, job.x + column, job.y + y, record, rays,
                                      taker);
    }
    // Through shared memory, so that a warp writes whole lines.
    memcpy(&staged[warp][lane * record_words], &record, sizeof record);
    __syncwarp();
    const int columns = min(tile_width, job.width - left);
    for (int r = 0; r < tile_height; ++r) {
        auto* to = reinterpret_cast<unsigned long long*>(job.records + size_t(top + r) * size_t(job.width) + left);
        for (int word = lane; word < columns * record_words; word += warp_threads)
            to[word] = staged[warp][r * tile_width * record_words + word];
    }
    add_to_tally(*job.tally, rays, flags);
}

template <class Real, class E, DevicePath path>
__global__ void __launch_bounds__(block_threads) render_branches(const __grid_constant__ FrameJob<Real> job) {
    using Intersector = typename PathTraits<Real, path>::Intersector;
    using Media = typename Intersector::Media;
    const unsigned int count = min(*job.from.size, job.from.capacity);
    RayCounts rays;
    unsigned int flags = 0;
    for (unsigned int i = blockIdx.x * block_threads + threadIdx.x; i < count; i += gridDim.x * block_threads) {
        QueuedBranch<Real, Media> item = static_cast<const QueuedBranch<Real, Media>*>(job.from.items)[i];
        PixelRecord part;
        const QueueTaker<Real, Media> taker{job.to, item.record, job.surfaces};
        flags |= resume_branch<Real, E>(job.scene, job.frame, Intersector{job.scene}, item.branch, part, rays, taker);
        PixelRecord& record = job.records[item.record];
        for (int c = 0; c < 3; ++c) {
            const auto add = [](int64_t& to, int64_t value) {
                if (value != 0) atomicAdd(reinterpret_cast<unsigned long long*>(&to), (unsigned long long)value);
            };
            add(record.radiance[c], part.radiance[c]);
            add(record.pruned[c], part.pruned[c]);
            add(record.cut[c], part.cut[c]);
        }
        atomicAdd(&record.rays, part.rays);
    }
    add_to_tally(*job.tally, rays, flags);
}

/// Blocks of a grid that keeps the device full: passes over queues find out there how much there is to do.
template <class Kernel>
unsigned int filling_blocks(const Kernel& kernel) {
    int device = 0, multiprocessors = 0, blocks = 0;
    CISTULA_CUDA_CHECK(cudaGetDevice(&device));
    CISTULA_CUDA_CHECK(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device));
    CISTULA_CUDA_CHECK(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, block_threads, 0));
    return unsigned(multiprocessors) * unsigned(blocks > 0 ? blocks : 1);
}

/// The kernels of one mask of effects.
template <class Real, int mask>
void launch_mask(DevicePath path, bool branches, const FrameJob<Real>& job, cudaStream_t stream) {
    using E = Effects<effect_masks[mask]>;
    const dim3 grid(unsigned(job.width + 2 * tile_width - 1) / (2 * tile_width), unsigned(job.rows / (2 * tile_height)));
    const auto launch = [&](auto pixels_kernel, auto branches_kernel) {
        if (branches)
            branches_kernel<<<filling_blocks(branches_kernel), block_threads, 0, stream>>>(job);
        else
            pixels_kernel<<<grid, block_threads, 0, stream>>>(job);
    };
    if (path == DevicePath::plain_loop)
        launch(render_pixels<Real, E, DevicePath::plain_loop>, render_branches<Real, E, DevicePath::plain_loop>);
    else
        launch(render_pixels<Real, E, DevicePath::tree>, render_branches<Real, E, DevicePath::tree>);
    check_cuda(cudaGetLastError(), branches ? "launch of render_branches" : "launch of render_pixels");
}

}  // namespace cistula
