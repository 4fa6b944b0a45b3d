#include "backend_cuda/device_worker.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <thread>

#include "scene/shadow_plan.h"

namespace cistula {
namespace {

constexpr size_t staging_bytes = size_t{32} << 20, copy_bytes = size_t{4} << 20;
/// Branches that may wait per pixel of a part, and in all; trees that find no room are walked to their end where they are.
constexpr size_t queued_per_pixel = 2, most_queued = size_t{1} << 21;
/// From so many pixels on the warps of a block interleave: all four then do much the same at a time and share the
/// instructions that are fetched. Of fewer, the few that take longest are better kept apart.
constexpr size_t many_pixels = size_t{1} << 19;
/// Blocks of a kernel that samples adaptively that a multiprocessor has at work, at the most.
constexpr int most_blocks = 6;
/// So long the host asks again and again whether a part is done, then every hundredth of the time that it has waited.
constexpr double patience = 5e-3, longest_nap = 1e-3;  // seconds

/// Strips are whole but for a rectangle's last.
int rows_of_last_strip(const FramePart& part) {
    const int top = (part.first_strip + (part.strips - 1) * part.strip_step) * strip_rows;
    return std::clamp(part.rect.height - top, 0, strip_rows);
}

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

/// `count` records of a mask from `from`, which are the film's from `to` on.
void unpack(int mask, const std::byte* from, PixelRecord* to, size_t count) {
    if (has_ledger(mask)) {
        std::memcpy(to, from, count * sizeof(PixelRecord));
        return;
    }
    const auto* seen = reinterpret_cast<const SeenRecord*>(from);
    for (size_t i = 0; i < count; ++i) to[i] = {seen[i], {}, {}};
}

}  // namespace

void use_device(int device) {
    CISTULA_CUDA_CHECK(cudaSetDevice(device));
}

template <class Real>
DeviceWorker<Real>::DeviceWorker(int device, const SceneArena<Real>& scene, const SceneView<Real>& here, DevicePath path)
    : device_(device), path_(path) {
    arena_.reserve(std::max<size_t>(scene.bytes().size(), 1));
    CISTULA_CUDA_CHECK(cudaMemcpyAsync(arena_.as<void>(), scene.bytes().data(), scene.bytes().size(),
                                       cudaMemcpyHostToDevice, compute_));
    counters_.reserve(counters * sizeof(unsigned int));
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
    if (path_ == DevicePath::plain_loop) scene_.small = *small_scene(here, scene_.view);
}

/// For as many blocks as the device can have at work, or half as many until there is memory.
template <class Real>
void DeviceWorker<Real>::reserve_rooms() {
    if (room_blocks_ != 0) return;
    int multiprocessors = 0;
    CISTULA_CUDA_CHECK(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device_));
    constexpr size_t block = block_pixels * sizeof(LatticeRoom);
    unsigned int blocks = unsigned(multiprocessors * most_blocks);
    while (blocks > 1 && !rooms_.try_reserve(blocks * block)) blocks /= 2;
    rooms_.reserve(blocks * block);
    room_blocks_ = blocks;
}

/// A kernel's first launch takes memory for its threads' stacks: over a gigabyte on a large device. It must come before the
/// pixels', which can do with less. It may also wait for other kernels, which must not be endless then.
template <class Real>
void DeviceWorker<Real>::prime(int mask, Pass pass) {
    const int kernel = 3 * mask + int(pass);
    if (primed_ >> kernel & 1u) return;
    PartSlot& slot = slots_[0];
    slot.records.reserve(strip_rows * sizeof(PixelRecord));
    FrameJob job;
    job.records = slot.records.as<void>();
    job.width = 1;
    job.rows = strip_rows;  // of a rectangle without height: no pixel is rendered
    job.tally = slot.tally.as<DeviceTally>();
    job.next = job.from.size = counters_.as<unsigned int>();
    job.stop = stop_.as<unsigned int>();
    if (pass == Pass::adaptive_pixels) reserve_rooms();
    job.rooms = rooms_.as<LatticeRoom>();
    job.room_blocks = room_blocks_;
    CISTULA_CUDA_CHECK(cudaMemsetAsync(job.next, 0, sizeof(unsigned int), compute_));
    launch(pass, mask, path_, scene_, job, compute_);
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(compute_));
    primed_ |= 1u << kernel;
}

template <class Real>
bool DeviceWorker<Real>::reserve(size_t pixels, size_t memory_limit, int mask, Pass first, bool splits) {
    use_device(device_);
    prime(mask, first);
    if (splits) prime(mask, Pass::branches);
    const size_t bytes = pixels * record_bytes(mask);
    if (!splits)
        for (DeviceMemory& queue : queue_) queue.free();
    const size_t branch = queued_branch_bytes<Real>(path_), wanted = splits ? std::min(queued_per_pixel * pixels, most_queued) : 0;
    if (memory_limit != 0 && slots * bytes + 2 * wanted * branch > memory_limit) return false;
    bool room = true;
    for (PartSlot& slot : slots_) room = room && slot.records.try_reserve(bytes);
    for (DeviceMemory& queue : queue_) room = room && queue.try_reserve(wanted * branch);
    queue_capacity_ = wanted;
    if (room) return true;
    // What one has got would be missing when the others ask for less.
    for (PartSlot& slot : slots_) slot.records.free();
    for (DeviceMemory& queue : queue_) queue.free();
    return false;
}

template <class Real>
void DeviceWorker<Real>::start(const FramePart& part, int index) {
    use_device(device_);
    PartSlot& slot = slots_[index];
    slot.part = part;
    FrameJob job;
    job.frame = part.frame;
    job.records = slot.records.as<void>();
    job.x = part.rect.x;
    job.y = part.rect.y;
    job.width = part.rect.width;
    job.height = part.rect.height;
    job.first_strip = part.first_strip;
    job.strip_step = part.strip_step;
    job.rows = part.strips * strip_rows;
    job.interleaved = size_t(job.width) * size_t(job.rows) >= many_pixels;
    job.stop = stop_.as<unsigned int>();
    job.tally = slot.tally.as<DeviceTally>();
    CISTULA_CUDA_CHECK(cudaMemsetAsync(job.tally, 0, sizeof(DeviceTally), compute_));
    CISTULA_CUDA_CHECK(cudaMemsetAsync(counters_.as<void>(), 0, counters * sizeof(unsigned int), compute_));
    const StreamGate::Hold held = gate_.hold(compute_);
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.begin, compute_));
    const auto queue = [&](int pass) {
        BranchQueue q;
        q.items = queue_[pass % 2].as<void>();
        q.capacity = static_cast<unsigned int>(queue_capacity_);
        q.size = counters_.as<unsigned int>() + pass;
        return q;
    };
    // A pass follows trees that many levels further down, the last one to their end.
    const auto give = [&](int pass) {
        const int depth = (pass + 1) * part.split_depth;
        const bool last = part.split_depth == 0 || pass + 1 == passes || depth >= part.frame.tree.depth;
        job.to = last ? BranchQueue() : queue(pass);
        job.split_depth = last ? whole_trees : depth;
        return !last;
    };
    bool more = give(0);
    job.next = counters_.as<unsigned int>() + passes;
    job.rooms = rooms_.as<LatticeRoom>();
    job.room_blocks = room_blocks_;
    launch(part.first, part.mask, path_, scene_, job, compute_);
    for (int pass = 1; more; ++pass) {
        job.from = queue(pass - 1);
        more = give(pass);
        launch(Pass::branches, part.mask, path_, scene_, job, compute_);
    }
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.end, compute_));
    CISTULA_CUDA_CHECK(cudaMemcpyAsync(slot.tally_copy.as<void>(), job.tally, sizeof(DeviceTally),
                                       cudaMemcpyDeviceToHost, compute_));
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.done, compute_));
}

template <class Real>
bool DeviceWorker<Real>::fetch(int index, Film& film, bool locked, const std::atomic<bool>& stop) {
    use_device(device_);
    PartSlot& slot = slots_[index];
    if (!await(slot.done, stop)) return false;
    kernel_seconds += slot.end.since(slot.begin) * 1e-3;
    const auto start = std::chrono::steady_clock::now();
    if (locked && has_ledger(slot.part.mask))
        copy_straight(slot, film);
    else
        copy_rows(slot, film);
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
    CISTULA_CUDA_CHECK(cudaMemcpyAsync(stop_.as<void>(), one_.as<void>(), sizeof(unsigned int), cudaMemcpyHostToDevice, copy_));
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

/// Into a film in locked pages: all strips that are whole at once, and the last one.
template <class Real>
void DeviceWorker<Real>::copy_straight(const PartSlot& slot, Film& film) {
    const FramePart& part = slot.part;
    const size_t width = size_t(part.rect.width), strip = strip_rows * width, strip_bytes = strip * sizeof(PixelRecord);
    const int last_rows = rows_of_last_strip(part), whole = last_rows == strip_rows ? part.strips : part.strips - 1;
    const PixelRecord* from = slot.records.as<PixelRecord>();
    PixelRecord* to = film.pixels.data() + size_t(part.first_strip) * strip;
    if (whole > 0)
        CISTULA_CUDA_CHECK(cudaMemcpy2DAsync(to, size_t(part.strip_step) * strip_bytes, from, strip_bytes, strip_bytes,
                                             size_t(whole), cudaMemcpyDeviceToHost, copy_));
    if (whole < part.strips)
        CISTULA_CUDA_CHECK(cudaMemcpyAsync(to + size_t(whole * part.strip_step) * strip, from + size_t(whole) * strip,
                                           size_t(last_rows) * width * sizeof(PixelRecord), cudaMemcpyDeviceToHost,
                                           copy_));
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(copy_));
}

/// Through two page-locked buffers: one is filled while threads spread the other over the film.
template <class Real>
void DeviceWorker<Real>::copy_rows(const PartSlot& slot, Film& film) {
    const FramePart& part = slot.part;
    const size_t width = size_t(part.rect.width), row_bytes = width * record_bytes(part.mask);
    const int rows = (part.strips - 1) * strip_rows + rows_of_last_strip(part);
    // No more than there is: to lock pages takes longer than to render a small frame.
    const int batch = std::min(int(std::max<size_t>(staging_bytes / row_bytes, 1)), rows);
    for (PinnedMemory& buffer : staging_) buffer.reserve(size_t(batch) * row_bytes);
    const auto fill = [&](int first, int buffer) {
        CISTULA_CUDA_CHECK(cudaMemcpyAsync(staging_[buffer].as<void>(),
                                           slot.records.as<std::byte>() + size_t(first) * row_bytes,
                                           size_t(std::min(batch, rows - first)) * row_bytes, cudaMemcpyDeviceToHost, copy_));
        CISTULA_CUDA_CHECK(cudaEventRecord(staged_[buffer], copy_));
    };
    fill(0, 0);
    for (int first = 0, buffer = 0; first < rows; first += batch, buffer ^= 1) {
        CISTULA_CUDA_CHECK(cudaEventSynchronize(staged_[buffer]));
        if (first + batch < rows) fill(first + batch, buffer ^ 1);
        const auto* from = staging_[buffer].as<std::byte>();
        const int count = std::min(batch, rows - first);
        // Rows that are neighbors in the film go together: large copies pass the caches by, which writers of files want.
        const int together = part.strip_step == 1 ? std::max(int(copy_bytes / row_bytes), 1) : 1;
        tbb::parallel_for(0, (count + together - 1) / together, [&](int i) {
            const int begin = i * together, row = first + begin;
            const int y = row_of_strips(part.first_strip, part.strip_step, row);
            unpack(part.mask, from + size_t(begin) * row_bytes, &film.pixels[size_t(y) * width],
                   size_t(std::min(together, count - begin)) * width);
        });
    }
}

template class DeviceWorker<float>;
template class DeviceWorker<double>;

}  // namespace cistula
