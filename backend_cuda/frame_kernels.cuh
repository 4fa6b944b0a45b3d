// The device's launcher: render_pixel over the pixels of a job, a thread a pixel, then what their trees left waiting.
#pragma once

#include "backend_cuda/cuda_check.h"
#include "backend_cuda/frame_job.h"
#include "cistula/bvh.h"

namespace cistula {

inline constexpr int warp_threads = 32, block_warps = 4, block_threads = warp_threads * block_warps;
/// A warp renders a tile of 8 x 4 pixels, a block 2 x 2 of those: neighbors see the same things.
inline constexpr int tile_width = 8, tile_height = 4;
/// Shared memory that a block has without asking.
inline constexpr int most_shared_words = (48 * 1024 - block_threads * int(sizeof(PixelRecord))) / int(sizeof(uint32_t));
static_assert(sizeof(PixelRecord) % sizeof(uint2) == 0 && 2 * sizeof(PixelRecord) % sizeof(uint4) == 0);
static_assert(strip_rows % (2 * tile_height) == 0);

/// Blocks that share a multiprocessor: what bounds the registers of a thread, at 168. 2, 4 and 5 were slower on an H200.
inline constexpr int least_blocks = 3;

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

/// The branches that wait: the latest few in shared memory, a column of words a thread, the rest in the thread's own. After
/// a number of surfaces what waits goes to the queue, so that deep trees are split over many threads; the sums being
/// integers, the order of work never shows.
template <class Real, class Media>
class SharedBranchStack {
  public:
    using Entry = Branch<Real, Media>;
    static constexpr int words = sizeof(Entry) / sizeof(uint32_t);
    static constexpr int room = most_shared_words / (words * block_threads);  // entries
    static constexpr int near = room < 4 ? room : 4;
    static constexpr int warp_words = near * words * warp_threads;
    static_assert(sizeof(Entry) % sizeof(uint32_t) == 0 && near >= 1);

    __device__ SharedBranchStack(uint32_t* warp_column, BranchQueue queue, unsigned int record, int surfaces)
        : words_(warp_column + threadIdx.x % warp_threads), queue_(queue), record_(record), left_(surfaces) {}

    __device__ void shaded() { --left_; }
    __device__ bool push(const Entry& branch) {
        if (count_ < near)
            put(count_, branch);
        else if (count_ < branch_stack)
            deep_.put(count_ - near, branch);
        else
            return false;
        ++count_;
        return true;
    }
    __device__ bool pop(Entry& branch) {
        while (count_ > 0) {
            --count_;
            if (count_ < near)
                get(count_, branch);
            else
                deep_.get(count_ - near, branch);
            if (!give_away(branch)) return true;
        }
        return false;
    }

  private:
    __device__ bool give_away(const Entry& branch) {
        if (left_ > 0 || queue_.capacity == 0) return false;
        const unsigned int place = next_place(queue_.size);
        if (place >= queue_.capacity) return false;
        static_cast<QueuedBranch<Real, Media>*>(queue_.items)[place] = {branch, record_};
        return true;
    }
    __device__ void put(int entry, const Entry& branch) {
        uint32_t copy[words];
        memcpy(copy, &branch, sizeof branch);
#pragma unroll
        for (int i = 0; i < words; ++i) words_[(entry * words + i) * warp_threads] = copy[i];
    }
    __device__ void get(int entry, Entry& branch) const {
        uint32_t copy[words];
#pragma unroll
        for (int i = 0; i < words; ++i) copy[i] = words_[(entry * words + i) * warp_threads];
        memcpy(&branch, copy, sizeof branch);
    }

    uint32_t* words_;
    BranchQueue queue_;
    unsigned int record_;
    int left_, count_ = 0;
    BranchRoom<Real, Media, branch_stack - near> deep_;
};

/// Over all lanes; for every one on devices of capability 8.0 and later, else for the first.
__device__ inline unsigned int warp_sum(unsigned int value) {
#if __CUDA_ARCH__ >= 800
    return __reduce_add_sync(0xffffffffu, value);
#else
    for (int step = warp_threads / 2; step > 0; step /= 2) value += __shfl_down_sync(0xffffffffu, value, step);
    return value;
#endif
}

__device__ inline void add_to_tally(DeviceTally& tally, const RayCounts& rays, unsigned int flags) {
    const unsigned long long counts[4] = {rays.primary, rays.reflected, rays.transmitted, rays.shadow};
    const int lane = threadIdx.x % warp_threads, slot = (blockIdx.x + blockIdx.y * 7u) % DeviceTally::slots;
    for (int i = 0; i < 4; ++i) {
        // In halves, of which 32 do not overflow.
        const unsigned long long low = warp_sum(unsigned(counts[i] & 0xffffffu));
        const unsigned long long sum = __any_sync(0xffffffffu, counts[i] >> 24 != 0)
                                           ? low + ((unsigned long long)warp_sum(unsigned(counts[i] >> 24)) << 24)
                                           : low;
        if (lane == 0 && sum != 0) atomicAdd(&tally.rays[slot][i], sum);
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

template <class Real, class E, DevicePath path>
__global__ void __launch_bounds__(block_threads, least_blocks)
    render_pixels(const __grid_constant__ FrameJob job, const __grid_constant__ typename PathTraits<Real, path>::Scene scene) {
    using Intersector = typename PathTraits<Real, path>::Intersector;
    using Media = typename Intersector::Media;
    using Stack = SharedBranchStack<Real, Media>;
    __shared__ alignas(16) uint32_t shared[block_warps][Stack::warp_words];
    __shared__ alignas(16) PixelRecord records[block_warps][warp_threads];  // registers are dearer
    const int warp = threadIdx.x / warp_threads, lane = threadIdx.x % warp_threads;
    const int left = int(blockIdx.x) * 2 * tile_width + warp % 2 * tile_width;
    const int top = int(blockIdx.y) * 2 * tile_height + warp / 2 * tile_height;
    const int column = left + lane % tile_width, row = top + lane / tile_width;
    const int y = (job.first_strip + row / strip_rows * job.strip_step) * strip_rows + row % strip_rows;
    RayCounts rays;
    unsigned int flags = 0;
    PixelRecord& record = records[warp][lane];
    if (column < job.width && row < job.rows && y < job.height) {
        Stack stack(shared[warp], job.to, unsigned(row) * unsigned(job.width) + unsigned(column), job.surfaces);
        flags = render_pixel<Real, E>(scene, job.frame, Intersector{scene}, job.x + column, job.y + y, record, rays, stack);
    }
    __syncwarp();
    PixelRecord* to = job.records + size_t(top) * size_t(job.width) + left;
    // In pairs of records all is aligned to 16 bytes.
    if (job.width - left >= tile_width && job.width % 2 == 0)
        write_tile<uint4>(records[warp], to, tile_width, job.width);
    else
        write_tile<uint2>(records[warp], to, job.width - left < tile_width ? job.width - left : tile_width, job.width);
    add_to_tally(*job.tally, rays, flags);
}

template <class Real, class E, DevicePath path>
__global__ void __launch_bounds__(block_threads, least_blocks)
    render_branches(const __grid_constant__ FrameJob job, const __grid_constant__ typename PathTraits<Real, path>::Scene scene) {
    using Intersector = typename PathTraits<Real, path>::Intersector;
    using Media = typename Intersector::Media;
    using Stack = SharedBranchStack<Real, Media>;
    __shared__ alignas(16) uint32_t shared[block_warps][Stack::warp_words];
    const unsigned int count = min(*job.from.size, job.from.capacity);
    RayCounts rays;
    unsigned int flags = 0;
    for (unsigned int i = blockIdx.x * block_threads + threadIdx.x; i < count; i += gridDim.x * block_threads) {
        QueuedBranch<Real, Media> item = static_cast<const QueuedBranch<Real, Media>*>(job.from.items)[i];
        PixelRecord part;
        Stack stack(shared[threadIdx.x / warp_threads], job.to, item.record, job.surfaces);
        flags |= resume_branch<Real, E>(scene, job.frame, Intersector{scene}, item.branch, part, rays, stack);
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
    const dim3 grid(unsigned(job.width + 2 * tile_width - 1) / (2 * tile_width), unsigned(job.rows / (2 * tile_height)));
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
