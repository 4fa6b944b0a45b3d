// Parts that the kernels share: storage of blocks, the intersector of each path, counting.
#pragma once

#include <algorithm>

#include "backend_cuda/kernels/frame_job.h"
#include "cistula/traversal/ball_loop.h"
#include "cistula/traversal/bvh.h"

namespace cistula {

/// A block's records and working data in shared memory, which saves registers.
template <int threads>
struct alignas(16) BlockStorage {
    PixelRecord records[threads];
    PixelWork work[threads];
};

/// Uninitialized storage: __shared__ variables must not have constructors.
template <class T>
struct alignas(T) Uninitialized {
    unsigned char bytes[sizeof(T)];
    __device__ T& get() { return reinterpret_cast<T&>(bytes); }
};

/// The number of resident threads per multiprocessor: 1,024 at capability 7.5; 1,536 or more on later devices.
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ < 800
inline constexpr int most_threads = 1024;
#else
inline constexpr int most_threads = 1536;
#endif
/// The minimum number of resident blocks per multiprocessor, for __launch_bounds__.
template <class Real>
constexpr int least_blocks(const KernelShape& shape, DevicePath path) {
    return std::min(shape.blocks(path, sizeof(Real) == sizeof(float)), most_threads / shape.threads());
}

/// The form of the scene that a path's kernels read, and their intersector.
template <class Real, DevicePath path>
struct PathTraits;
template <class Real>
struct PathTraits<Real, DevicePath::plain_loop> {
    using Scene = ConstantScene<Real>;
    using Intersector = BruteIntersector<Real, SingleInterior, Scene>;
    __device__ static Intersector intersector(const Scene& scene, uint32_t in_view) { return {scene, in_view}; }
};
template <class Real>
struct PathTraits<Real, DevicePath::ball_loop> {
    using Scene = BallScene<Real>;
    using Intersector = BallIntersector<Real>;
    __device__ static Intersector intersector(const Scene& scene, uint32_t) { return {scene}; }
};
template <class Real>
struct PathTraits<Real, DevicePath::tree> {
    using Scene = SceneView<Real>;
    using Intersector = BvhIntersector<Real, InteriorList, Scene>;
    __device__ static Intersector intersector(const Scene& scene, uint32_t) { return {scene}; }
};

/// Whether the host wants the kernel to end. The flag is read past the caches, which would keep its first value.
struct JobStop {
    const unsigned int* flag;  // FrameJob::stop

    CISTULA_INLINE bool operator()() const { return *static_cast<const volatile unsigned int*>(flag) != 0; }
};

/// The stack of a kernel's ray trees.
template <class Real, class E, DevicePath path>
using DeviceStack = StoppableStack<StackOf<Real, E, typename PathTraits<Real, path>::Intersector::Media>, JobStop>;

/// The sum over a warp's lanes, in every lane.
__device__ inline unsigned int warp_sum(unsigned int value) {
#if __CUDA_ARCH__ >= 800
    return __reduce_add_sync(0xffffffffu, value);
#else
    for (int step = warp_threads / 2; step > 0; step /= 2) value += __shfl_xor_sync(0xffffffffu, value, step);
    return value;
#endif
}

/// The greatest over a warp's lanes, in every lane.
__device__ inline unsigned int warp_most(unsigned int value) {
#if __CUDA_ARCH__ >= 800
    return __reduce_max_sync(0xffffffffu, value);
#else
    for (int step = warp_threads / 2; step > 0; step /= 2)
        value = max_or_second(value, __shfl_xor_sync(0xffffffffu, value, step));
    return value;
#endif
}

/// Adds ray counts and flags to the tally. Counts are summed over the warp first, two in a word; where they could
/// overflow, each lane adds its own.
__device__ inline void add_to_tally(DeviceTally& tally, const PixelRays& rays, unsigned int flags) {
    constexpr int half = 16;
    const unsigned int counts[4] = {rays.primary, rays.reflected, rays.transmitted, rays.shadow};
    unsigned long long* to = tally.rays[blockIdx.x % DeviceTally::slots];
    if (__any_sync(0xffffffffu, (counts[0] | counts[1] | counts[2] | counts[3]) >= (1u << half) / warp_threads)) {
        for (int i = 0; i < 4; ++i) atomicAdd(to + i, (unsigned long long)counts[i]);
    } else {
        const unsigned int lane = threadIdx.x % warp_threads;
        const unsigned int first = warp_sum(counts[0] | counts[1] << half);
        const unsigned int last = warp_sum(counts[2] | counts[3] << half);
        const unsigned int sum = (lane < 2 ? first : last) >> (lane % 2 * half) & ((1u << half) - 1);
        if (lane < 4 && sum != 0) atomicAdd(to + lane, (unsigned long long)sum);
    }
    if (flags != 0) atomicOr(&tally.flags, flags);
}

/// Adds the counts and flags of a whole block to the tally; called by one warp after all are done.
template <int threads>
__device__ void add_block_to_tally(DeviceTally& tally, const BlockStorage<threads>& block) {
    PixelRays rays;
    unsigned int flags = 0;
    unsigned int most = 0;
#pragma unroll
    for (int i = int(threadIdx.x) % warp_threads; i < threads; i += warp_threads) {
        rays.add(block.work[i].rays);
        flags |= block.work[i].flags;
        most = max_or_second(block.records[i].rays, most);
    }
    add_to_tally(tally, rays, flags);
    most = warp_most(most);
    if (threadIdx.x % warp_threads == 0) atomicMax(&tally.most_rays[blockIdx.x % DeviceTally::slots], most);
}

/// Adds what some records lost to the tally; called by one warp. As many lanes as can share each of the numbers: a
/// block ends no sooner than this, so it is to take few steps. Blocks that prune nothing are common.
__device__ inline void add_losses_to_tally(DeviceTally& tally, const PixelRecord* records, int count) {
    const int lane = threadIdx.x % warp_threads;
    int64_t pruned = 0;
    for (int k = lane; k < count; k += warp_threads)
        pruned |= records[k].pruned[0] | records[k].pruned[1] | records[k].pruned[2];
    const bool any_pruned = __any_sync(0xffffffffu, pruned != 0) != 0;
    const int first = any_pruned ? 0 : 3;  // of DeviceTally::losses
    const int lanes = any_pruned ? 4 : 8;  // for each number
    const int i = first + lane / lanes;
    Total total;
    if (i < 6) {
        const PixelLosses& of = records[lane % lanes];
        const int64_t* number = i < 3 ? of.pruned + i : of.cut + (i - 3);
        const int stride = lanes * int(sizeof(PixelRecord) / sizeof(int64_t));
#pragma unroll 4
        for (int k = 0; k < count / lanes; ++k) total.add(uint64_t(number[k * stride]));
    }
    for (int step = lanes / 2; step > 0; step /= 2) {
        Total other;
        other.low = __shfl_xor_sync(0xffffffffu, total.low, step);
        other.high = __shfl_xor_sync(0xffffffffu, total.high, step);
        other.most = __shfl_xor_sync(0xffffffffu, total.most, step);
        total.add(other);
    }
    if (lane % lanes != 0 || total.most == 0) return;
    Total& to = tally.losses[blockIdx.x % DeviceTally::slots][i];
    atomicAdd(&to.low, total.low);
    if (total.high != 0) atomicAdd(&to.high, total.high);
    atomicMax(&to.most, total.most);
}

}  // namespace cistula
