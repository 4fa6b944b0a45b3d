// The kernel for uniformly sampled pixels, which runs render_pixel's loop with a thread per pixel, and the launches of
// both kernels.
#pragma once

#include "backend_cuda/host/cuda_check.h"
#include "backend_cuda/kernels/adaptive_kernel.cuh"

namespace cistula {

/// Copies a part of a block's first `count` records from shared memory to global memory, if it is kept; 16 bytes at a
/// time where a part is made of them.
template <class Part, int count, int threads>
__device__ void write_part(const PixelRecord* staged, Part* to) {
    using Word = unsigned long long;
    constexpr int words = sizeof(Part) % 16 == 0 ? 2 : 1;  // of a chunk
    struct alignas(words * sizeof(Word)) Chunk {
        Word word[words];
    };
    constexpr int chunks = int(sizeof(Part) / sizeof(Chunk));
    if (to == nullptr) return;
#pragma unroll
    for (int i = 0; i < count * chunks; i += threads) {
        const int chunk = i + int(threadIdx.x);
        if (i + threads > count * chunks && chunk >= count * chunks) break;
        const Part* part = staged + chunk / chunks;
        Chunk copied;
        for (int k = 0; k < words; ++k)
            copied.word[k] = reinterpret_cast<const Word*>(part)[chunk % chunks * words + k];
        reinterpret_cast<Chunk*>(to)[chunk] = copied;
    }
}

/// Copies a block's first `count` records to global memory, from record `first` on.
template <int count, int threads>
__device__ void write_records(const PixelRecord* staged, const PixelPlanes& to, size_t first) {
    write_part<PixelRadiance, count, threads>(staged, to.radiance + first);
    write_part<PixelLosses, count, threads>(staged, to.losses == nullptr ? nullptr : to.losses + first);
    write_part<PixelSight, count, threads>(staged, to.sights == nullptr ? nullptr : to.sights + first);
}

template <class Real, int mask, DevicePath path>
__global__ void __launch_bounds__(kernel_shapes[mask].threads(), least_blocks<Real>(kernel_shapes[mask], path))
    render_pixels(const __grid_constant__ FrameJob job,
                  const __grid_constant__ typename PathTraits<Real, path>::Scene scene) {
    using E = Effects<effect_masks[mask]>;
    using Stack = DeviceStack<Real, E, path>;
    constexpr int warps = kernel_shapes[mask].warps;
    static_assert(warps % 4 == 0, "four warps' losses are added up by one");
    constexpr int threads = kernel_shapes[mask].threads();
    __shared__ Uninitialized<BlockStorage<threads>> memory;
    BlockStorage<threads>& block_storage = memory.get();
    const int warp = threadIdx.x / warp_threads;
    const int lane = threadIdx.x % warp_threads;
    const bool shared_tile = job.mapping == PixelMapping::shared_tile;
    const BlockPlace block = job.blocks[blockIdx.x];
    const BlockPlan plan{job.mapping, warps};
    const BlockShape shape = plan.shape();
    const PixelPlace place = plan.place_of(shared_tile ? lane : int(threadIdx.x));
    const int column = block.column * shape.width + place.column;
    const int row = block.row * shape.height + place.row;
    PixelWork& own = block_storage.work[threadIdx.x] = PixelWork();
    PixelRecord& record = block_storage.records[threadIdx.x];
    typename Stack::Storage branches;
    Stack stack(branches, JobStop{job.stop});
    using Intersector = typename PathTraits<Real, path>::Intersector;
    const Intersector intersector = PathTraits<Real, path>::intersector(scene, block.in_view);
    PixelTask<E, Intersector, Stack> task{scene, job.frame, intersector, job.x + column, job.y + row, own, stack};
    if constexpr (E::has(fills_layers))
        task.layers = job.layers_of(blockIdx.x * unsigned(shape.pixels()) + (shared_tile ? lane : threadIdx.x));
    const bool is_inside = column < job.width && row < job.height;
    const int samples = job.frame.supersample * job.frame.supersample;
    begin_pixel(record);  // also beyond the rectangle, since all are counted
    for (int round = 0; round < samples; round += warps) {
        // Where samples start together the warps of a block do much the same at a time and share the instructions and
        // constants that are fetched.
        if (kernel_shapes[mask].together && round != 0) __syncthreads();
        const int i = round + (shared_tile ? warp : 0);
        if (is_inside && i < samples) add_sample(task, i, record);
    }
    if (is_inside) end_pixel(record, own);
    int64_t lost = 0;
    for (int c = 0; c < 3; ++c) lost |= record.pruned[c] | record.cut[c];
    const bool any_lost = __syncthreads_or(lost != 0) != 0;
    static_assert(BlockPlan::shared_shape.pixels() == warp_threads);
    if (shared_tile) {
        if (warp == 0)
            for (int other = 1; other < warps; ++other) record.add(block_storage.records[other * warp_threads + lane]);
        __syncthreads();
    }
    if (warp == 0) add_block_to_tally(*job.tally, block_storage);
    if (any_lost && warp % 4 == 3 && (!shared_tile || warp == 3)) {
        const int count = shared_tile ? warp_threads : 4 * warp_threads;
        add_losses_to_tally(*job.tally, block_storage.records + warp / 4 * count, count);
    }
    const size_t first = size_t(blockIdx.x) * size_t(shape.pixels());
    if (shared_tile)
        write_records<BlockPlan::shared_shape.pixels(), threads>(block_storage.records, job.records, first);
    else
        write_records<threads, threads>(block_storage.records, job.records, first);
}

/// The number of a kernel's blocks that fill this thread's current device.
template <class Kernel>
unsigned int filling_blocks(const Kernel& kernel, int threads) {
    int device = 0;
    int multiprocessors = 0;
    int blocks = 0;
    CISTULA_CUDA_CHECK(cudaGetDevice(&device));
    CISTULA_CUDA_CHECK(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device));
    CISTULA_CUDA_CHECK(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, threads, 0));
    return unsigned(multiprocessors) * unsigned(max_or_second(blocks, 1));
}

/// Whether adaptive sampling is compiled for this mask: for all effects with a budget only, with and without layers.
constexpr bool samples_adaptively(int mask) {
    return mask == limited_mask || mask == layered_mask;
}

template <class Real, int mask>
void launch_mask(Sampling sampling, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
                 cudaStream_t stream) {
    const auto launch = [&]<DevicePath here>(const auto& own) {
        if (sampling == Sampling::uniform) {
            render_pixels<Real, mask, here><<<job.block_count, kernel_shapes[mask].threads(), 0, stream>>>(job, own);
            check_cuda(cudaGetLastError(), "launch of render_pixels");
        } else if constexpr (samples_adaptively(mask)) {
            constexpr int threads = adaptive_shape.threads();
            const auto kernel = render_adaptive<Real, mask, here>;
            kernel<<<min_or_second(filling_blocks(kernel, threads), job.storage_blocks), threads, 0, stream>>>(job,
                                                                                                               own);
            check_cuda(cudaGetLastError(), "launch of render_adaptive");
        }
    };
    if (path == DevicePath::tree) return launch.template operator()<DevicePath::tree>(scene.view);
    if constexpr (mask != layered_mask)
        if (path == DevicePath::plain_loop) return launch.template operator()<DevicePath::plain_loop>(scene.constant);
    if constexpr (mask == ball_mask) return launch.template operator()<DevicePath::ball_loop>(scene.balls);
    throw Error(ErrorKind::failed, "internal error: layers need the tree, as balls do without their mask");
}

}  // namespace cistula
