#include "backend_cuda/device_worker.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <thread>

#include "scene/put_pixels.h"
#include "scene/shadow_plan.h"

namespace cistula {
namespace {

constexpr size_t staging_bytes = size_t{32} << 20;
constexpr int blocks_together = 16;  // that a thread of the host unpacks
/// Blocks of a kernel that samples adaptively that a multiprocessor has at work, at the most.
constexpr int most_blocks = 6;
/// So long the host asks again and again whether a part is done, then every hundredth of the time that it has waited.
constexpr double patience = 5e-3, longest_nap = 1e-3;  // seconds

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// False once `stop` is set, which no call of CUDA's would look at.
bool await(const CudaEvent& done, const std::atomic<bool>& stop) {
    const auto start = std::chrono::steady_clock::now();
    while (!done.happened()) {
        if (stop.load(std::memory_order_relaxed)) return false;
        const double waited = seconds_since(start);
        if (waited < patience)
            std::this_thread::yield();
        else
            std::this_thread::sleep_for(std::chrono::duration<double>(std::min(waited / 100, longest_nap)));
    }
    return true;
}

constexpr size_t most_records = most_warps * warp_threads;  // of a block
using RecordOrder = std::array<uint8_t, most_records>;
static_assert(most_records - 1 <= UINT8_MAX);

/// The records of a block, row by row of its pixels.
RecordOrder rows_of_records(const BlockPlan& plan) {
    const BlockShape shape = plan.shape();
    RecordOrder records{};
    for (int i = 0; i < shape.pixels(); ++i) {
        const PixelPlace place = plan.place_of(i);
        records[size_t(place.row * shape.width + place.column)] = uint8_t(i);
    }
    return records;
}

/// Puts a block's records into the film.
void unpack(const PixelRecord* from, const RecordOrder& records, BlockShape shape, const BlockPlace& block, Film& film,
            const PixelWriter& writer) {
    const int left = block.column * shape.width, top = block.row * shape.height;
    const int width = std::min(shape.width, film.rect.width - left),
              height = std::min(shape.height, film.rect.height - top);
    for (int row = 0; row < height; ++row) {
        PixelRecord* to = &film.pixels[size_t(top + row) * size_t(film.rect.width) + size_t(left)];
        for (int column = 0; column < width; ++column)
            writer.put(to[column], from[records[size_t(row * shape.width + column)]]);
    }
}

}  // namespace

void use_device(int device) {
    CISTULA_CUDA_CHECK(cudaSetDevice(device));
}

template <class Real>
DeviceWorker<Real>::DeviceWorker(int device, const SceneArena<Real>& scene, const SceneView<Real>& here,
                                 DevicePath path)
    : device_(device), path_(path) {
    arena_.reserve(std::max<size_t>(scene.bytes().size(), 1));
    CISTULA_CUDA_CHECK(cudaMemcpyAsync(arena_.as<void>(), scene.bytes().data(), scene.bytes().size(),
                                       cudaMemcpyHostToDevice, compute_));
    next_.reserve(next_bytes);
    stop_.reserve(sizeof(unsigned int));
    CISTULA_CUDA_CHECK(cudaMemsetAsync(stop_.as<void>(), 0, sizeof(unsigned int), compute_));
    one_.reserve(sizeof(unsigned int));
    *one_.as<unsigned int>() = 1;
    for (PartSlot& slot : slots_) {
        slot.tally.reserve(sizeof(DeviceTally));
        slot.tally_copy.reserve(sizeof(DeviceTally));
    }
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(compute_));
    scene_.view = scene.at(arena_.as<void>());
    if (path_ != DevicePath::plain_loop) return;
    scene_.small = *small_scene(here, scene_.view);
    primitives_.assign(here.solids.size, 0);
    for (uint32_t i = 0; i < here.convex.size; ++i) primitives_[here.convex[i]] |= 1u << i;
    for (uint32_t i = 0; i < here.clusters.size; ++i)
        primitives_[here.clusters[i].solid] |= 1u << (ShadowPlan::first_cluster + i);
}

/// For as many blocks as the device can have at work, or half as many until there is memory.
template <class Real>
void DeviceWorker<Real>::reserve_storage() {
    if (storage_blocks_ != 0) return;
    int multiprocessors = 0;
    CISTULA_CUDA_CHECK(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device_));
    constexpr size_t block = pixels_at_work * sizeof(LatticeStorage);
    unsigned int blocks = unsigned(multiprocessors * most_blocks);
    while (blocks > 1 && !storage_.try_reserve(blocks * block)) blocks /= 2;
    storage_.reserve(blocks * block);
    storage_blocks_ = blocks;
}

/// A kernel's first launch takes memory for its threads' stacks: over a gigabyte on a large device. It must come before
/// the pixels', which can do with less. It may also wait for other kernels, which must not be endless then.
template <class Real>
void DeviceWorker<Real>::prime(Sampling sampling, int mask) {
    const int kernel = 2 * mask + int(sampling);
    if (primed_ >> kernel & 1u) return;
    PartSlot& slot = slots_[0];
    slot.records.reserve(most_records * sizeof(PixelRecord));
    FrameJob job;  // of a rectangle without height: no pixel of its block is rendered
    job.records = slot.records.as<PixelRecord>();
    job.tally = slot.tally.as<DeviceTally>();
    job.next = next_.as<unsigned int>();
    job.blocks = next_.as<BlockPlace>();
    job.block_count = 1;
    job.stop = stop_.as<unsigned int>();
    if (sampling == Sampling::adaptive) reserve_storage();
    job.storage = storage_.as<LatticeStorage>();
    job.storage_blocks = storage_blocks_;
    CISTULA_CUDA_CHECK(cudaMemsetAsync(next_.as<void>(), 0, next_bytes, compute_));
    launch(sampling, mask, path_, scene_, job, compute_);
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(compute_));
    primed_ |= 1u << kernel;
}

template <class Real>
bool DeviceWorker<Real>::reserve(size_t pixels, size_t memory_limit, Sampling sampling, int mask) {
    use_device(device_);
    prime(sampling, mask);
    const size_t bytes = pixels * sizeof(PixelRecord);
    if (memory_limit != 0 && slots * bytes > memory_limit) return false;
    bool room = true;
    // A block a tile at the most.
    const size_t list_bytes = pixels / (tile_width * tile_height) * sizeof(BlockPlace);
    for (PartSlot& slot : slots_) {
        room = room && slot.records.try_reserve(bytes) && slot.blocks.try_reserve(list_bytes);
        slot.blocks_copy.reserve(list_bytes);
    }
    if (room) return true;
    // What one has got would be missing when the others ask for less.
    for (PartSlot& slot : slots_) slot.records.free();
    return false;
}

template <class Real>
void DeviceWorker<Real>::start(const FramePart& part, int index) {
    use_device(device_);
    PartSlot& slot = slots_[index];
    slot.part = part;
    slot.list = BlockList(part.hints->cover, primitives_, part.strips, part.plan);
    const std::vector<BlockPlace>& places = slot.list.places();
    std::copy(places.begin(), places.end(), slot.blocks_copy.as<BlockPlace>());
    const PixelRect& rect = part.hints->cover.rect();
    FrameJob job;
    job.frame = part.frame;
    job.records = slot.records.as<PixelRecord>();
    job.x = rect.x;
    job.y = rect.y;
    job.width = rect.width;
    job.height = rect.height;
    job.blocks = slot.blocks.as<BlockPlace>();
    job.block_count = static_cast<unsigned int>(places.size());
    job.mapping = slot.list.plan().mapping;
    job.stop = stop_.as<unsigned int>();
    job.tally = slot.tally.as<DeviceTally>();
    CISTULA_CUDA_CHECK(cudaMemsetAsync(job.tally, 0, sizeof(DeviceTally), compute_));
    CISTULA_CUDA_CHECK(cudaMemsetAsync(next_.as<void>(), 0, next_bytes, compute_));
    CISTULA_CUDA_CHECK(cudaMemcpyAsync(slot.blocks.as<void>(), slot.blocks_copy.as<void>(),
                                       places.size() * sizeof(BlockPlace), cudaMemcpyHostToDevice, compute_));
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.begin, compute_));
    job.next = next_.as<unsigned int>();
    job.storage = storage_.as<LatticeStorage>();
    job.storage_blocks = storage_blocks_;
    if (!places.empty()) launch(part.sampling, part.mask, path_, scene_, job, compute_);
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.end, compute_));
    CISTULA_CUDA_CHECK(
        cudaMemcpyAsync(slot.tally_copy.as<void>(), job.tally, sizeof(DeviceTally), cudaMemcpyDeviceToHost, compute_));
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.done, compute_));
}

template <class Real>
bool DeviceWorker<Real>::fetch(int index, Film& film, const std::atomic<bool>& stop) {
    use_device(device_);
    PartSlot& slot = slots_[index];
    fill_gaps(slot, film);  // while the kernels are at work
    if (!await(slot.done, stop)) return false;
    const bool is_empty = slot.list.places().empty();
    if (!is_empty) kernel_seconds += slot.end.since(slot.begin) * 1e-3;
    const auto start = std::chrono::steady_clock::now();
    if (!is_empty) copy_blocks(slot, film);
    const DeviceTally& tally = *slot.tally_copy.as<DeviceTally>();
    for (const auto& counts : tally.rays) {
        rays.primary += counts[0];
        rays.reflected += counts[1];
        rays.transmitted += counts[2];
        rays.shadow += counts[3];
    }
    flags |= tally.flags;
    transfer_seconds += seconds_since(start);
    return true;
}

template <class Real>
void DeviceWorker<Real>::stop() {
    use_device(device_);
    CISTULA_CUDA_CHECK(
        cudaMemcpyAsync(stop_.as<void>(), one_.as<void>(), sizeof(unsigned int), cudaMemcpyHostToDevice, copy_));
    stopped_ = true;
}

template <class Real>
void DeviceWorker<Real>::wait() {
    use_device(device_);
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(compute_));
    if (!stopped_) return;
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(copy_));
    CISTULA_CUDA_CHECK(cudaMemsetAsync(stop_.as<void>(), 0, sizeof(unsigned int), compute_));
    stopped_ = false;
}

/// What no block renders is background.
template <class Real>
void DeviceWorker<Real>::fill_gaps(const PartSlot& slot, Film& film) {
    const BackgroundPixel& background = slot.part.hints->background;
    std::atomic<uint64_t> pixels{0};
    tbb::parallel_for(0, slot.list.rows(), [&](int i) {
        const PixelWriter writer;
        uint64_t count = 0;
        slot.list.for_each_gap(i, [&](int row, int begin, int end) {
            writer.fill(&film.pixels[size_t(row) * size_t(film.rect.width) + size_t(begin)], size_t(end - begin),
                        background.record);
            count += uint64_t(end - begin);
        });
        pixels += count;
    });
    background.count(pixels, rays, flags);
}

/// Through two page-locked buffers: one is filled while threads spread the other over the film.
template <class Real>
void DeviceWorker<Real>::copy_blocks(const PartSlot& slot, Film& film) {
    const std::vector<BlockPlace>& places = slot.list.places();
    const BlockShape shape = slot.list.shape();
    const auto order = rows_of_records(slot.list.plan());
    const int count = int(places.size());
    const size_t block_bytes = size_t(shape.pixels()) * sizeof(PixelRecord);
    // No more than there is: to lock pages takes longer than to render a small frame.
    const int batch = std::min(int(staging_bytes / block_bytes), count);
    for (PinnedMemory& buffer : staging_) buffer.reserve(size_t(batch) * block_bytes);
    const auto fill = [&](int first, int buffer) {
        CISTULA_CUDA_CHECK(
            cudaMemcpyAsync(staging_[buffer].as<void>(), slot.records.as<std::byte>() + size_t(first) * block_bytes,
                            size_t(std::min(batch, count - first)) * block_bytes, cudaMemcpyDeviceToHost, copy_));
        CISTULA_CUDA_CHECK(cudaEventRecord(staged_[buffer], copy_));
    };
    fill(0, 0);
    for (int first = 0, buffer = 0; first < count; first += batch, buffer ^= 1) {
        CISTULA_CUDA_CHECK(cudaEventSynchronize(staged_[buffer]));
        if (first + batch < count) fill(first + batch, buffer ^ 1);
        const auto* from = staging_[buffer].as<std::byte>();
        const tbb::blocked_range<int> blocks(0, std::min(batch, count - first), blocks_together);
        tbb::parallel_for(blocks, [&](const tbb::blocked_range<int>& some) {
            const PixelWriter writer;
            for (int i = some.begin(); i < some.end(); ++i) {
                const auto* records = reinterpret_cast<const PixelRecord*>(from + size_t(i) * block_bytes);
                unpack(records, order, shape, places[size_t(first + i)], film, writer);
            }
        });
    }
}

template class DeviceWorker<float>;
template class DeviceWorker<double>;

}  // namespace cistula
