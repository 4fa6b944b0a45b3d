#include "backend_cuda/host/device_worker.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <thread>

#include "base/stages.h"
#include "render/frame/frame_view.h"

namespace cistula {
namespace {

/// The maximum number of blocks per multiprocessor of the kernel for adaptive sampling.
constexpr int most_blocks = 6;
/// Bytes allocated for FrameJob::next.
constexpr size_t next_bytes = 16;
/// The time for which the host polls for the end of a part without pausing, and its longest pause after that; pauses
/// are a hundredth of the time waited.
// seconds
constexpr double patience = 5e-3;
constexpr double longest_nap = 1e-3;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Waits for an event; false once `stop` is set, which CUDA's own waiting functions would not notice.
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

/// What a slot of the tally has counted: all but the totals of radiance, which whoever reads the pixels adds up.
FrameCounts counts_of(const DeviceTally& tally, int slot) {
    FrameCounts counts;
    const auto& rays = tally.rays[slot];
    counts.rays = {rays[0], rays[1], rays[2], rays[3]};
    for (int c = 0; c < 3; ++c) {
        counts.totals.pruned[c] = tally.losses[slot][c];
        counts.totals.cut[c] = tally.losses[slot][3 + c];
    }
    counts.totals.units = {counts.rays.total(), 0, tally.most_rays[slot]};  // units_lost without a target error
    return counts;
}

}  // namespace

void use_device(int device) {
    CISTULA_CUDA_CHECK(cudaSetDevice(device));
}

template <class Real>
DeviceWorker<Real>::DeviceWorker(int device, const SceneArena<Real>& scene, const SceneView<Real>& here,
                                 DevicePath path)
    : device_(device), path_(path), upload_(scene, here, path, compute_), stop_(compute_) {
    next_.reserve(next_bytes);
    for (PartSlot& slot : slots_) {
        slot.tally.reserve(sizeof(DeviceTally));
        slot.tally_copy.reserve(sizeof(DeviceTally));
    }
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(compute_));
}

/// Allocates adaptive sampling's storage for as many blocks as the device can run at once, or half as many until it
/// fits and leaves as much for pixels.
template <class Real>
void DeviceWorker<Real>::reserve_storage(const LayerPlan& layers) {
    if (storage_blocks_ != 0 && layers.sample_words() <= sample_words_) return;
    storage_.free();
    storage_blocks_ = 0;
    int multiprocessors = 0;
    size_t unused = 0;
    size_t all = 0;
    CISTULA_CUDA_CHECK(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device_));
    CISTULA_CUDA_CHECK(cudaMemGetInfo(&unused, &all));
    sample_words_ = layers.sample_words();
    const size_t sample_layers = size_t(sample_words_) * sizeof(int64_t);
    const size_t block = pixels_at_work * (sizeof(LatticeStorage) + lattice_samples * sample_layers);
    unsigned int blocks = unsigned(multiprocessors * most_blocks);
    while (blocks > 1 && (blocks * block > unused / 2 || !storage_.try_reserve(blocks * block))) blocks /= 2;
    storage_.reserve(blocks * block);
    storage_blocks_ = blocks;
}

/// A job without pixels, with all data that belong to the worker.
template <class Real>
FrameJob DeviceWorker<Real>::job_for(const PartSlot& slot) const {
    FrameJob job;
    job.records = {slot.radiance.template as<PixelRadiance>(), slot.losses.template as<PixelLosses>(),
                   slot.sights.template as<PixelSight>()};
    job.layers = slot.layers.template as<int64_t>();
    job.tally = slot.tally.template as<DeviceTally>();
    job.next = next_.as<unsigned int>();
    job.stop = stop_.on_device();
    job.storage = storage_.as<LatticeStorage>();
    job.sample_layers = reinterpret_cast<int64_t*>(job.storage + size_t(storage_blocks_) * pixels_at_work);
    job.storage_blocks = storage_blocks_;
    return job;
}

/// Launches a kernel on no pixels. A kernel's first launch allocates its threads' stacks, over a gigabyte on a large
/// device; that must happen before the pixels' memory is allocated, which can do with less. It may also wait for other
/// kernels, which must then not run indefinitely.
template <class Real>
void DeviceWorker<Real>::prime(Sampling sampling, int mask) {
    const int kernel = 2 * mask + int(sampling);
    if (primed_ >> kernel & 1u) return;
    PartSlot& slot = slots_[0];
    constexpr size_t records = most_warps * warp_threads;
    slot.radiance.reserve(records * sizeof(PixelRadiance));
    slot.losses.reserve(records * sizeof(PixelLosses));
    slot.sights.reserve(records * sizeof(PixelSight));
    FrameJob job = job_for(slot);  // its rectangle has no height, so its block renders no pixel
    job.blocks = next_.as<BlockPlace>();
    job.block_count = 1;
    job.storage_blocks = 1;
    CISTULA_CUDA_CHECK(cudaMemsetAsync(next_.as<void>(), 0, next_bytes, compute_));
    CISTULA_CUDA_CHECK(cudaMemsetAsync(job.tally, 0, sizeof(DeviceTally), compute_));
    launch(sampling, mask, path_, upload_.scene(), job, compute_);
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(compute_));
    primed_ |= 1u << kernel;
}

template <class Real>
bool DeviceWorker<Real>::is_ready(size_t pixels, const FramePlan& plan) const {
    const KeptParts parts = plan.settings.kept_parts();
    return (primed_ >> (2 * plan.mask + int(plan.sampling)) & 1u) != 0 && pixels <= pixels_ &&
           parts.losses <= parts_.losses && parts.sights <= parts_.sights &&
           pixels * size_t(plan.view.layers.words) <= words_ &&
           (plan.sampling != Sampling::adaptive ||
            (storage_blocks_ != 0 && plan.view.layers.sample_words() <= sample_words_));
}

template <class Real>
bool DeviceWorker<Real>::reserve(size_t pixels, size_t memory_limit, const FramePlan& plan) {
    if (is_ready(pixels, plan)) return true;
    use_device(device_);
    prime(plan.sampling, plan.mask);
    if (plan.sampling == Sampling::adaptive) reserve_storage(plan.view.layers);
    const KeptParts parts = plan.settings.kept_parts();
    const size_t bytes = pixels * parts.bytes();
    const size_t layer_bytes = pixels * size_t(plan.view.layers.words) * sizeof(int64_t);
    if (memory_limit != 0 && slots * (bytes + layer_bytes) > memory_limit) return false;
    bool room = true;
    // At most one block per tile.
    const size_t list_bytes = pixels / (tile_width * tile_height) * sizeof(BlockPlace);
    for (PartSlot& slot : slots_) {
        room = room && slot.radiance.try_reserve(pixels * sizeof(PixelRadiance)) &&
               slot.losses.try_reserve(parts.losses ? pixels * sizeof(PixelLosses) : 0) &&
               slot.sights.try_reserve(parts.sights ? pixels * sizeof(PixelSight) : 0) &&
               slot.layers.try_reserve(layer_bytes) && slot.blocks.try_reserve(list_bytes);
        slot.blocks_copy.reserve(list_bytes);
    }
    pixels_ = room ? pixels : 0;
    words_ = room ? layer_bytes / sizeof(int64_t) : 0;
    parts_ = parts;
    if (room) return true;
    // Frees what was allocated: it would be missing when less is requested.
    for (PartSlot& slot : slots_) {
        slot.radiance.free();
        slot.losses.free();
        slot.sights.free();
        slot.layers.free();
    }
    return false;
}

template <class Real>
void DeviceWorker<Real>::start(const FramePlan& plan, const Strips& strips) {
    use_device(device_);
    PartSlot& slot = slots_[started_++ % slots];
    slot.hints = plan.hints;
    slot.list = BlockList(plan.hints->cover, upload_.primitives(), strips, plan.blocks);
    const std::vector<BlockPlace>& places = slot.list.places();
    std::copy(places.begin(), places.end(), slot.blocks_copy.template as<BlockPlace>());
    const PixelRect& rect = plan.hints->cover.rect();
    FrameJob job = job_for(slot);
    const KeptParts parts = plan.settings.kept_parts();
    if (!parts.losses) job.records.losses = nullptr;
    if (!parts.sights) job.records.sights = nullptr;
    job.frame = plan.view;
    job.x = rect.x;
    job.y = rect.y;
    job.width = rect.width;
    job.height = rect.height;
    job.blocks = slot.blocks.template as<BlockPlace>();
    job.block_count = static_cast<unsigned int>(places.size());
    job.mapping = plan.blocks.mapping;
    CISTULA_CUDA_CHECK(cudaMemsetAsync(job.tally, 0, sizeof(DeviceTally), compute_));
    CISTULA_CUDA_CHECK(cudaMemsetAsync(job.next, 0, next_bytes, compute_));
    const size_t words = places.size() * size_t(plan.blocks.shape().pixels()) * size_t(plan.view.layers.words);
    if (words != 0) CISTULA_CUDA_CHECK(cudaMemsetAsync(job.layers, 0, words * sizeof(int64_t), compute_));
    CISTULA_CUDA_CHECK(cudaMemcpyAsync(slot.blocks.template as<void>(), slot.blocks_copy.template as<void>(),
                                       places.size() * sizeof(BlockPlace), cudaMemcpyHostToDevice, compute_));
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.begin, compute_));
    if (!places.empty()) launch(plan.sampling, plan.mask, path_, upload_.scene(), job, compute_);
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.end, compute_));
    CISTULA_CUDA_CHECK(cudaMemcpyAsync(slot.tally_copy.template as<void>(), job.tally, sizeof(DeviceTally),
                                       cudaMemcpyDeviceToHost, compute_));
    CISTULA_CUDA_CHECK(cudaEventRecord(slot.done, compute_));
}

template <class Real>
bool DeviceWorker<Real>::fetch(Film& film, const std::atomic<bool>& stop) {
    use_device(device_);
    PartSlot& slot = slots_[fetched_ % slots];
    fill_gaps(slot, film);  // while the kernels are at work
    if (!await(slot.done, stop)) return false;
    ++fetched_;
    const InStage stage(Stage::transfer);
    const auto start = std::chrono::steady_clock::now();
    if (!slot.list.places().empty()) {
        totals.kernel_seconds += slot.end.since(slot.begin) * 1e-3;
        readback_.copy(job_for(slot).records, slot.list, film, totals.counts.totals);
        readback_.copy_layers(slot.layers.template as<int64_t>(), slot.list, film);
    }
    const DeviceTally& tally = *slot.tally_copy.template as<DeviceTally>();
    for (int i = 0; i < DeviceTally::slots; ++i) totals.counts.add(counts_of(tally, i));
    totals.counts.flags |= tally.flags;
    totals.transfer_seconds += seconds_since(start);
    return true;
}

template <class Real>
template <class Answer>
void DeviceWorker<Real>::answer(std::span<const RayQuestion> questions, std::span<Answer> answers) {
    use_device(device_);
    const size_t together = std::min(questions.size(), size_t{1} << 20);
    DeviceMemory asked, answered;
    asked.reserve(together * sizeof(RayQuestion));
    answered.reserve(together * sizeof(Answer));
    for (size_t first = 0; first < questions.size(); first += together) {
        const size_t count = std::min(together, questions.size() - first);
        CISTULA_CUDA_CHECK(cudaMemcpyAsync(asked.as<void>(), &questions[first], count * sizeof(RayQuestion),
                                           cudaMemcpyHostToDevice, compute_));
        launch_queries(upload_.scene().view, asked.as<RayQuestion>(), unsigned(count), answered.as<Answer>(), compute_);
        CISTULA_CUDA_CHECK(cudaMemcpyAsync(&answers[first], answered.as<void>(), count * sizeof(Answer),
                                           cudaMemcpyDeviceToHost, compute_));
    }
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(compute_));
}

template <class Real>
void DeviceWorker<Real>::stop() {
    use_device(device_);
    stop_.raise(readback_.stream());
}

template <class Real>
void DeviceWorker<Real>::wait() {
    use_device(device_);
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(compute_));
    started_ = fetched_ = 0;
    if (!stop_.is_raised()) return;
    CISTULA_CUDA_CHECK(cudaStreamSynchronize(readback_.stream()));
    stop_.lower(compute_);
}

/// Fills the pixels that no block renders with background.
template <class Real>
void DeviceWorker<Real>::fill_gaps(const PartSlot& slot, Film& film) {
    std::mutex together;
    tbb::parallel_for(0, slot.list.rows(), [&](int i) {
        const PixelWriter writer(film.pixels.planes());
        FrameCounts counts;
        slot.list.for_each_gap(i, [&](int row, int begin, int end) {
            const size_t first = size_t(row) * size_t(film.rect.width) + size_t(begin);
            slot.hints->fill(writer, film.rect.x + begin, film.rect.y + row, end - begin, first, counts);
            fill_background_layers(film, first, size_t(end - begin));
        });
        const std::lock_guard<std::mutex> lock(together);
        totals.counts.add(counts);
    });
}

template class DeviceWorker<float>;
template class DeviceWorker<double>;
template void DeviceWorker<float>::answer(std::span<const RayQuestion>, std::span<RayAnswer>);
template void DeviceWorker<float>::answer(std::span<const RayQuestion>, std::span<Vec3<double>>);
template void DeviceWorker<double>::answer(std::span<const RayQuestion>, std::span<RayAnswer>);
template void DeviceWorker<double>::answer(std::span<const RayQuestion>, std::span<Vec3<double>>);

}  // namespace cistula
