// The device's launcher: render_pixel over the pixels of a job, a thread a pixel, then what their trees left waiting.
#pragma once

#include "backend_cuda/cuda_check.h"
#include "backend_cuda/frame_job.h"
#include "cistula/bvh.h"

namespace cistula {

inline constexpr int warp_threads = 32, block_warps = 4, block_threads = warp_threads * block_warps;
/// A warp renders a tile of 8 x 4 pixels, a block 2 x 2 of those: neighbors see the same things.
inline constexpr int tile_width = 8, tile_height = 4;
static_assert(sizeof(PixelRecord) % sizeof(uint2) == 0 && 2 * sizeof(PixelRecord) % sizeof(uint4) == 0);
static_assert(strip_rows % (2 * tile_height) == 0);

/// Blocks that share a multiprocessor: what bounds the registers of a thread, at 96 and 128. Others were slower on an H200.
template <class Real>
inline constexpr int least_blocks = sizeof(Real) == sizeof(float) ? 5 : 4;

template <class Real, DevicePath path>
struct PathTraits;
template <class Real>
struct PathTraits<Real, DevicePath::plain_loop> {
    using Scene = SmallScene<Real>;
    using Intersector = BruteIntersector<Real, OneMedium, Scene>;
};
template <class Real>
struct PathTraits<Real, DevicePath::tree> {
    using Scene = SceneView<Real>;
    using Intersector = BvhIntersector<Real, MediaList, Scene>;
};

template <class Real, class Media>
struct QueuedBranch {
    Branch<Real, Media> branch;
    unsigned int record;
};

/// A place in a queue for every lane that is here: one addition for all of them.
__device__ inline unsigned int next_place(unsigned int* size) {
    const unsigned int here = __activemask(), lane = threadIdx.x % warp_threads;
    const int leader = __ffs(int(here)) - 1;
    unsigned int first = 0;
    if (int(lane) == leader) first = atomicAdd(size, unsigned(__popc(here)));
    return __shfl_sync(here, first, leader) + unsigned(__popc(here & ((1u << lane) - 1u)));
}

/// The branches that wait, in the thread's own memory. After a number of surfaces what waits goes to the queue, so that
/// deep trees are split over many threads; the sums being integers, the order of work never shows.
template <class Real, class Media>
class GivingBranchStack {
  public:
    using Entry = Branch<Real, Media>;
    /// Apart from the rest, so that this stays in registers.
    using Room = BranchRoom<Real, Media, branch_stack>;

    __device__ GivingBranchStack(Room& room, const BranchQueue& queue, unsigned int record, int surfaces)
        : room_(room), queue_(queue), record_(record), left_(queue.capacity != 0 ? surfaces : 0x7fffffff) {}

    __device__ void shaded() { --left_; }
    __device__ bool push(const Entry& branch) {
        if (count_ == branch_stack) return false;
        room_.put(count_++, branch);
        return true;
    }
    __device__ bool pop(Entry& branch) {
        if (left_ <= 0 && count_ > 0) count_ = give_away(&room_, count_, &queue_, record_);
        if (count_ == 0) return false;
        room_.get(--count_, branch);
        return true;
    }

  private:
    /// Moves what waits to the queue while that has room; how many are left. Called: a seldom thing, and long.
    __device__ __noinline__ static int give_away(const Room* room, int count, const BranchQueue* queue, unsigned int record) {
        for (; count > 0; --count) {
            const unsigned int place = next_place(queue->size);
            if (place >= queue->capacity) break;
            QueuedBranch<Real, Media> item;
            room->get(count - 1, item.branch);
            item.record = record;
            static_cast<QueuedBranch<Real, Media>*>(queue->items)[place] = item;
        }
        return count;
    }

    Room& room_;
    const BranchQueue& queue_;
    unsigned int record_;
    int left_, count_ = 0;
};

/// Over all lanes, for every one.
__device__ inline unsigned int warp_sum(unsigned int value) {
#if __CUDA_ARCH__ >= 800
    return __reduce_add_sync(0xffffffffu, value);
#else
    for (int step = warp_threads / 2; step > 0; step /= 2) value += __shfl_xor_sync(0xffffffffu, value, step);
    return value;
#endif
}

/// Sums over the warp first, in words; where they could overflow, each lane by itself.
__device__ inline void add_to_tally(DeviceTally& tally, const PixelRays& rays, unsigned int flags) {
    const unsigned int counts[4] = {rays.primary, rays.reflected, rays.transmitted, rays.shadow};
    unsigned long long* to = tally.rays[(blockIdx.x + blockIdx.y * 7u) % DeviceTally::slots];
    if (__any_sync(0xffffffffu, (counts[0] | counts[1] | counts[2] | counts[3]) >> 27 != 0)) {
        for (int i = 0; i < 4; ++i) atomicAdd(to + i, (unsigned long long)counts[i]);
    } else {
        const int lane = threadIdx.x % warp_threads;
        unsigned int sum = 0;
        for (int i = 0; i < 4; ++i) {
            const unsigned int whole = warp_sum(counts[i]);
            if (lane == i) sum = whole;
        }
        if (lane < 4 && sum != 0) atomicAdd(to + lane, (unsigned long long)sum);
    }
    if (flags != 0) atomicOr(&tally.flags, flags);
}

/// A warp writes its tile's records, whole lines at a time.
template <class Word>
__device__ void write_tile(const PixelRecord* staged, PixelRecord* to, int columns, int width) {
    const int lane = threadIdx.x % warp_threads, words = columns * int(sizeof(PixelRecord)) / int(sizeof(Word));
#pragma unroll 2
    for (int r = 0; r < tile_height; ++r) {
        const auto* from_row = reinterpret_cast<const Word*>(staged + r * tile_width);
        auto* to_row = reinterpret_cast<Word*>(to + size_t(r) * size_t(width));
        for (int i = lane; i < words; i += warp_threads) to_row[i] = from_row[i];
    }
}

/// A block has 2 x 2 tiles, one a warp. Where pixels have several samples, all its warps share one tile's, so that no thread
/// is long at work.
__host__ __device__ inline bool shares_tiles(const FrameView& frame) {
    return frame.supersample > 1;
}

template <class Real, class E, DevicePath path>
__global__ void __launch_bounds__(block_threads, least_blocks<Real>)
    render_pixels(const __grid_constant__ FrameJob job, const __grid_constant__ typename PathTraits<Real, path>::Scene scene) {
    using Intersector = typename PathTraits<Real, path>::Intersector;
    using Media = typename Intersector::Media;
    using Stack = GivingBranchStack<Real, Media>;
    // Registers are dearer.
    __shared__ alignas(16) PixelRecord records[block_warps][warp_threads];
    __shared__ PixelWork work[block_warps][warp_threads];
    const int warp = threadIdx.x / warp_threads, lane = threadIdx.x % warp_threads;
    const bool shares = shares_tiles(job.frame);
    const int left = (shares ? int(blockIdx.x) : int(blockIdx.x) * 2 + warp % 2) * tile_width;
    const int top = (shares ? int(blockIdx.y) : int(blockIdx.y) * 2 + warp / 2) * tile_height;
    const int column = left + lane % tile_width, row = top + lane / tile_width;
    const int y = (job.first_strip + row / strip_rows * job.strip_step) * strip_rows + row % strip_rows;
    PixelWork& own = work[warp][lane] = PixelWork();
    PixelRecord& record = records[warp][lane];
    if (column < job.width && row < job.rows && y < job.height) {
        typename Stack::Room room;
        Stack stack(room, job.to, unsigned(row) * unsigned(job.width) + unsigned(column), job.surfaces);
        const SampleRange samples{shares ? warp : 0, shares ? block_warps : 1};
        render_pixel<Real, E>(scene, job.frame, Intersector{scene}, job.x + column, job.y + y, samples, record, own, stack);
    }
    if (shares) {
        __syncthreads();
        if (warp == 0)
            for (int other = 1; other < block_warps; ++other) record.add(records[other][lane]);
    }
    __syncwarp();
    if (warp == 0 || !shares) {
        PixelRecord* to = job.records + size_t(top) * size_t(job.width) + left;
        // In pairs of records all is aligned to 16 bytes.
        if (job.width - left >= tile_width && job.width % 2 == 0)
            write_tile<uint4>(records[warp], to, tile_width, job.width);
        else
            write_tile<uint2>(records[warp], to, job.width - left < tile_width ? job.width - left : tile_width, job.width);
    }
    add_to_tally(*job.tally, own.rays, own.flags);
}

template <class Real, class E, DevicePath path>
__global__ void __launch_bounds__(block_threads, least_blocks<Real>)
    render_branches(const __grid_constant__ FrameJob job, const __grid_constant__ typename PathTraits<Real, path>::Scene scene) {
    using Intersector = typename PathTraits<Real, path>::Intersector;
    using Media = typename Intersector::Media;
    using Stack = GivingBranchStack<Real, Media>;
    const unsigned int count = min(*job.from.size, job.from.capacity);
    PixelRays rays;  // of many pixels, and yet far from 2^32: a part of a frame
    unsigned int flags = 0;
    for (unsigned int i = blockIdx.x * block_threads + threadIdx.x; i < count; i += gridDim.x * block_threads) {
        QueuedBranch<Real, Media> item = static_cast<const QueuedBranch<Real, Media>*>(job.from.items)[i];
        PixelRecord part;
        PixelWork own;
        typename Stack::Room room;
        Stack stack(room, job.to, item.record, job.surfaces);
        resume_branch<Real, E>(scene, job.frame, Intersector{scene}, item.branch, part, own, stack);
        rays.add(own.rays);
        flags |= own.flags;
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
void launch_mask(DevicePath path, bool branches, const DeviceScene<Real>& scene, const FrameJob& job, cudaStream_t stream) {
    using E = Effects<effect_masks[mask]>;
    const int tiles = shares_tiles(job.frame) ? 1 : 2;  // of a block, across and down
    const dim3 grid(unsigned(job.width + tiles * tile_width - 1) / unsigned(tiles * tile_width),
                    unsigned(job.rows / (tiles * tile_height)));
    const auto launch = [&](auto pixels_kernel, auto branches_kernel, const auto& own) {
        if (branches)
            branches_kernel<<<filling_blocks(branches_kernel), block_threads, 0, stream>>>(job, own);
        else
            pixels_kernel<<<grid, block_threads, 0, stream>>>(job, own);
    };
    if (path == DevicePath::plain_loop)
        launch(render_pixels<Real, E, DevicePath::plain_loop>, render_branches<Real, E, DevicePath::plain_loop>,
               scene.small);
    else
        launch(render_pixels<Real, E, DevicePath::tree>, render_branches<Real, E, DevicePath::tree>, scene.view);
    check_cuda(cudaGetLastError(), branches ? "launch of render_branches" : "launch of render_pixels");
}

}  // namespace cistula
