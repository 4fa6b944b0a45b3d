// The device's launcher: render_pixel over the pixels of a job, a thread a pixel, then what their trees left waiting.
#pragma once

#include "backend_cuda/adaptive_kernel.cuh"
#include "backend_cuda/cuda_check.h"

namespace cistula {

template <class Entry>
struct QueuedBranch {
    WaitingBranch<Entry> branch;
    unsigned long long record;  // an unsigned int, widened: padding would be copied unset
};

/// A place in a queue for every lane that is here: one addition for all of them.
__device__ inline unsigned int next_place(unsigned int* size) {
    const unsigned int here = __activemask(), lane = threadIdx.x % warp_threads;
    const int leader = __ffs(int(here)) - 1;
    unsigned int first = 0;
    if (int(lane) == leader) first = atomicAdd(size, unsigned(__popc(here)));
    return __shfl_sync(here, first, leader) + unsigned(__popc(here & ((1u << lane) - 1u)));
}

/// The branches that wait, in the thread's own memory; from a depth on they go to the queue while that has room, so
/// that deep trees are split over many threads. The sums being integers, the order of work never shows.
template <class Entry>
class GivingBranchStack {
  public:
    /// Apart from the rest, so that this stays in registers.
    using Room = BranchRoom<Entry, branch_stack>;

    __device__ GivingBranchStack(Room& room, const FrameJob& job, unsigned int record)
        : room_(room), job_(job), record_(record) {}

    __device__ bool push(const Entry& branch) {
        if (count_ == branch_stack) return false;
        room_.put(count_++, branch);
        if (int(branch.depth) >= job_.split_depth) count_ -= give_away(&room_, count_ - 1, &job_.to, record_);
        return true;
    }
    __device__ bool pop(Entry& branch) {
        if (count_ == 0) return false;
        room_.get(--count_, branch);
        return true;
    }
    __device__ void clear() { count_ = 0; }
    __device__ bool stopped() const { return cistula::stopped(job_); }

  private:
    /// Whether the queue has room for entry i, which it then has. Called, so that this seldom thing is nowhere in the
    /// way.
    __device__ __noinline__ static bool give_away(const Room* room, int i, const BranchQueue* queue,
                                                  unsigned int record) {
        const unsigned int place = next_place(queue->size);
        if (place >= queue->capacity) {
            atomicSub(queue->size, 1u);  // it stays full, and never wraps
            return false;
        }
        static_assert(sizeof(QueuedBranch<Entry>) == sizeof(WaitingBranch<Entry>) + sizeof(unsigned long long));
        static_cast<QueuedBranch<Entry>*>(queue->items)[place] = {room->waiting(i), record};
        return true;
    }

    Room& room_;
    const FrameJob& job_;
    unsigned int record_;
    int count_ = 0;
};

/// The same of trees that do not fork.
template <class Entry>
class KeepingBranch : public OneBranch<Entry> {
  public:
    struct Room {};
    __device__ KeepingBranch(Room&, const FrameJob&, unsigned int) {}
};

template <class Real, class E, class Media>
using DeviceStack = std::conditional_t<E::has(effect_transmission), GivingBranchStack<BranchOf<Real, E, Media>>,
                                       KeepingBranch<BranchOf<Real, E, Media>>>;

/// A block's threads copy its first records from shared memory to where they belong.
template <int count, int threads, class Record>
__device__ void write_records(const Record* staged, Record* to) {
    constexpr int words = count * int(sizeof(Record)) / int(sizeof(uint4));
    static_assert(count * sizeof(Record) % sizeof(uint4) == 0);
#pragma unroll
    for (int i = 0; i < words; i += threads)
        if (i + threads <= words || i + int(threadIdx.x) < words)
            reinterpret_cast<uint4*>(to)[i + int(threadIdx.x)] =
                reinterpret_cast<const uint4*>(staged)[i + int(threadIdx.x)];
}

template <class Real, class E, DevicePath path>
__global__ void __launch_bounds__(pixel_threads<E>, least_blocks<Real, E, path>* block_threads / pixel_threads<E>)
    render_pixels(const __grid_constant__ FrameJob job,
                  const __grid_constant__ typename PathTraits<Real, E, path>::Scene scene) {
    using Intersector = typename PathTraits<Real, E, path>::Intersector;
    using Media = typename Intersector::Media;
    using Stack = DeviceStack<Real, E, Media>;
    using Record = RecordOf<E>;
    constexpr int threads = pixel_threads<E>, warps = threads / warp_threads;
    __shared__ Unset<BlockRoom<Record, threads>> memory;
    BlockRoom<Record, threads>& room = memory.get();
    const int warp = threadIdx.x / warp_threads, lane = threadIdx.x % warp_threads;
    const bool shares = job.mapping == PixelMapping::shared_tile;
    const BlockPlace block = job.blocks[blockIdx.x];
    const BlockPlan plan{job.mapping, warps};
    const BlockShape shape = plan.shape();
    const PixelPlace place = plan.place_of(shares ? lane : int(threadIdx.x));
    const int column = block.column * shape.width + place.column, row = block.row * shape.height + place.row;
    const unsigned int first = blockIdx.x * unsigned(shape.pixels());  // of the block's records
    PixelWork& own = room.work[threadIdx.x] = PixelWork();
    Record& record = room.records[threadIdx.x];
    typename Stack::Room branches;
    Stack stack(branches, job, first + (shares ? unsigned(lane) : threadIdx.x));
    const Intersector intersector = PathTraits<Real, E, path>::intersector(scene, block.in_view);
    const bool is_inside = column < job.width && row < job.height;
    const int samples = job.frame.supersample * job.frame.supersample;
    if (is_inside) begin_pixel(record);
    for (int round = 0; round < samples; round += warps) {
        // Samples begin together: the warps of a block then do much the same at a time and share the instructions and
        // constants that are fetched.
        if (round != 0) __syncthreads();
        const int i = round + (shares ? warp : 0);
        if (is_inside && i < samples)
            add_sample<Real, E>(scene, job.frame, intersector, job.x + column, job.y + row, i, record, own, stack);
    }
    if (is_inside) end_pixel(record, own);
    __syncthreads();
    if (shares) {
        if (warp == 0)
            for (int other = 1; other < warps; ++other) record.add(room.records[other * warp_threads + lane]);
        __syncthreads();
    }
    if (warp == 0) add_block_to_tally(*job.tally, room.work);
    Record* to = static_cast<Record*>(job.records) + first;
    if (shares)
        write_records<BlockPlan::shared_shape.pixels(), threads>(room.records, to);
    else
        write_records<threads, threads>(room.records, to);
}

template <class Real, class E, DevicePath path>
__global__ void __launch_bounds__(block_threads, least_blocks<Real>)
    render_branches(const __grid_constant__ FrameJob job,
                    const __grid_constant__ typename PathTraits<Real, E, path>::Scene scene) {
    using Intersector = typename PathTraits<Real, E, path>::Intersector;
    using Media = typename Intersector::Media;
    using Item = QueuedBranch<BranchOf<Real, E, Media>>;
    using Stack = DeviceStack<Real, E, Media>;
    const unsigned int count = min(*job.from.size, job.from.capacity);
    PixelRays rays;  // of many pixels, and yet far from 2^32: a part of a frame
    unsigned int flags = 0;
    for (unsigned int i = blockIdx.x * block_threads + threadIdx.x; i < count && !stopped(job);
         i += gridDim.x * block_threads) {
        const Item item = static_cast<const Item*>(job.from.items)[i];
        BranchOf<Real, E, Media> branch;
        item.branch.give(branch);
        PixelRecord part;
        PixelWork own;
        typename Stack::Room room;
        Stack stack(room, job, item.record);
        resume_branch<Real, E>(scene, job.frame, Intersector{scene}, branch, part, own, stack);
        rays.add(own.rays);
        flags |= own.flags;
        PixelRecord& record = static_cast<PixelRecord*>(job.records)[item.record];
        part.give(record, AtomicAdd());
        atomicAdd(&record.rays, part.rays);
    }
    add_to_tally(*job.tally, rays, flags);
}

/// Of this thread's current device.
inline int device_attribute(cudaDeviceAttr attribute) {
    int device = 0, value = 0;
    CISTULA_CUDA_CHECK(cudaGetDevice(&device));
    CISTULA_CUDA_CHECK(cudaDeviceGetAttribute(&value, attribute, device));
    return value;
}

/// Blocks of a kernel that share a multiprocessor.
template <class Kernel>
int sharing_blocks(const Kernel& kernel, int threads) {
    int blocks = 0;
    CISTULA_CUDA_CHECK(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, threads, 0));
    return blocks;
}

/// Blocks of a grid that keeps the device full: passes over queues find out there how much there is to do.
template <class Kernel>
unsigned int filling_blocks(const Kernel& kernel) {
    return unsigned(device_attribute(cudaDevAttrMultiProcessorCount)) *
           unsigned(greatest(sharing_blocks(kernel, block_threads), 1));
}

template <class Kernel>
KernelResources resources_of(const char* name, const Kernel& kernel, int threads = block_threads) {
    cudaFuncAttributes attributes;
    CISTULA_CUDA_CHECK(cudaFuncGetAttributes(&attributes, kernel));
    KernelResources r{};
    r.name = name;
    r.registers = attributes.numRegs;
    r.local_bytes = attributes.localSizeBytes;
    r.blocks = sharing_blocks(kernel, threads);
    r.occupancy = double(r.blocks) * threads / device_attribute(cudaDevAttrMaxThreadsPerMultiProcessor);
    return r;
}

template <class Real, int mask, DevicePath path>
void list_resources(std::vector<KernelResources>& list) {
    using E = Effects<effect_masks[mask]>;
    const auto add = [&](KernelResources r) {
        r.precision = RealTraits<Real>::name;
        r.path = path == DevicePath::plain_loop ? "loop" : "tree";
        r.mask = E::mask;
        list.push_back(r);
    };
    add(resources_of("render_pixels", render_pixels<Real, E, path>, pixel_threads<E>));
    if constexpr (mask != unshadowed_mask) add(resources_of("render_adaptive", render_adaptive<Real, E, path>));
    if constexpr (trees_fork(mask)) add(resources_of("render_branches", render_branches<Real, E, path>));
}

/// Of the kernels of one mask of effects.
template <class Real, int mask>
void list_resources_of_mask(std::vector<KernelResources>& list) {
    list_resources<Real, mask, DevicePath::plain_loop>(list);
    list_resources<Real, mask, DevicePath::tree>(list);
}

/// The kernels of one mask of effects.
template <class Real, int mask>
void launch_mask(DevicePath path, Pass pass, const DeviceScene<Real>& scene, const FrameJob& job, cudaStream_t stream) {
    using E = Effects<effect_masks[mask]>;
    const auto launch = [&]<DevicePath here>(const auto& own) {
        if (pass == Pass::pixels)
            render_pixels<Real, E, here><<<job.block_count, pixel_threads<E>, 0, stream>>>(job, own);
        const auto fill = [&](auto kernel, unsigned int most) {
            kernel<<<least(filling_blocks(kernel), most), block_threads, 0, stream>>>(job, own);
        };
        if constexpr (mask != unshadowed_mask)
            if (pass == Pass::adaptive_pixels) fill(render_adaptive<Real, E, here>, job.room_blocks);
        if constexpr (trees_fork(mask))
            if (pass == Pass::branches) fill(render_branches<Real, E, here>, ~0u);
    };
    if (path == DevicePath::tree)
        launch.template operator()<DevicePath::tree>(scene.view);
    else
        launch.template operator()<DevicePath::plain_loop>(scene.small);
    check_cuda(cudaGetLastError(), pass == Pass::branches ? "launch of render_branches"
                                   : pass == Pass::pixels ? "launch of render_pixels"
                                                          : "launch of render_adaptive");
}

}  // namespace cistula
