#include "backend_cuda/host/readback.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>
#include <type_traits>

namespace cistula {
namespace {

constexpr size_t staging_bytes = size_t{8} << 20;  // locking more pages takes longer than the copies gain
constexpr int blocks_together = 16;                // that a host thread unpacks at a time

constexpr size_t most_records = most_warps * warp_threads;  // records of a block
using RecordOrder = std::array<uint8_t, most_records>;
static_assert(most_records - 1 <= UINT8_MAX);

/// The numbers of a block's records in row order of its pixels.
RecordOrder rows_of_records(const BlockPlan& plan) {
    const BlockShape shape = plan.shape();
    RecordOrder records{};
    for (int i = 0; i < shape.pixels(); ++i) {
        const PixelPlace place = plan.place_of(i);
        records[size_t(place.row * shape.width + place.column)] = uint8_t(i);
    }
    return records;
}

/// Calls put(pixel of the film, record of the block) for the pixels of a block that lie in the film.
template <class Put>
void for_each_pixel(const RecordOrder& records, BlockShape shape, const BlockPlace& block, const Film& film,
                    const Put& put) {
    const int left = block.column * shape.width;
    const int top = block.row * shape.height;
    const int width = std::min(shape.width, film.rect.width - left);
    const int height = std::min(shape.height, film.rect.height - top);
    for (int row = 0; row < height; ++row) {
        const size_t first = size_t(top + row) * size_t(film.rect.width) + size_t(left);
        for (int column = 0; column < width; ++column)
            put(first + size_t(column), records[size_t(row * shape.width + column)]);
    }
}

}  // namespace

/// Copies what the device has of each pixel of a list's blocks, `pixel_bytes` from `from` on, in batches. Calls
/// unpack(bytes, first, count) for the blocks first to first + count - 1, in several threads.
template <class Unpack>
void Readback::copy_blocks(const std::byte* from, size_t pixel_bytes, const BlockList& list, const Unpack& unpack) {
    const size_t block_bytes = size_t(list.shape().pixels()) * pixel_bytes;
    const int count = int(list.places().size());
    // Staging buffers no larger than needed: locking pages takes longer than rendering a small frame.
    const int batch = std::clamp(int(staging_bytes / block_bytes), 1, count);
    for (PinnedMemory& buffer : staging_) buffer.reserve(size_t(batch) * block_bytes);
    const auto fill = [&](int first, int buffer) {
        const size_t bytes = size_t(std::min(batch, count - first)) * block_bytes;
        CISTULA_CUDA_CHECK(cudaMemcpyAsync(staging_[buffer].as<void>(), from + size_t(first) * block_bytes, bytes,
                                           cudaMemcpyDeviceToHost, stream_));
        CISTULA_CUDA_CHECK(cudaEventRecord(staged_[buffer], stream_));
    };
    fill(0, 0);
    for (int first = 0, buffer = 0; first < count; first += batch, buffer ^= 1) {
        CISTULA_CUDA_CHECK(cudaEventSynchronize(staged_[buffer]));
        if (first + batch < count) fill(first + batch, buffer ^ 1);
        const std::byte* staged = staging_[buffer].as<std::byte>();
        const tbb::blocked_range<int> blocks(0, std::min(batch, count - first), blocks_together);
        tbb::parallel_for(blocks, [&](const tbb::blocked_range<int>& some) {
            unpack(staged + size_t(some.begin()) * block_bytes, first + some.begin(), int(some.size()));
        });
    }
}

/// Copies a part of the records, if the film keeps it. `totals`: the radiance is added.
template <class Part>
void Readback::copy_part(const Part* from, const BlockList& list, const Film& film, Part* to, PixelTotals& totals) {
    if (to == nullptr) return;
    const auto order = rows_of_records(list.plan());
    const BlockShape shape = list.shape();
    std::mutex together;
    copy_blocks(reinterpret_cast<const std::byte*>(from), sizeof(Part), list,
                [&](const std::byte* bytes, int first, int count) {
                    const PixelWriter::Fence fence;
                    PixelTotals sums;
                    for (int i = 0; i < count; ++i) {
                        const Part* of = reinterpret_cast<const Part*>(bytes) + size_t(i) * size_t(shape.pixels());
                        for_each_pixel(order, shape, list.places()[size_t(first + i)], film,
                                       [&](size_t pixel, size_t record) {
                                           PixelWriter::put(to + pixel, of[record]);
                                           if constexpr (std::is_same_v<Part, PixelRadiance>)
                                               for (int c = 0; c < 3; ++c)
                                                   sums.radiance[c].add(uint64_t(of[record].radiance[c]));
                                       });
                    }
                    if constexpr (std::is_same_v<Part, PixelRadiance>) {
                        const std::lock_guard<std::mutex> lock(together);
                        totals.add(sums);
                    }
                });
}

void Readback::copy(const PixelPlanes& records, const BlockList& list, Film& film, PixelTotals& totals) {
    const PixelPlanes to = film.pixels.planes();
    copy_part(records.radiance, list, film, to.radiance, totals);
    copy_part(records.losses, list, film, to.losses, totals);
    copy_part(records.sights, list, film, to.sights, totals);
}

void Readback::copy_layers(const int64_t* layers, const BlockList& list, Film& film) {
    const auto order = rows_of_records(list.plan());
    const BlockShape shape = list.shape();
    const size_t pixel_bytes = size_t(film.layers.plan.words) * sizeof(int64_t);
    if (pixel_bytes == 0) return;
    copy_blocks(reinterpret_cast<const std::byte*>(layers), pixel_bytes, list,
                [&](const std::byte* bytes, int first, int count) {
                    for (int i = 0; i < count; ++i) {
                        const std::byte* from = bytes + size_t(i) * size_t(shape.pixels()) * pixel_bytes;
                        for_each_pixel(order, shape, list.places()[size_t(first + i)], film,
                                       [&](size_t pixel, size_t record) {
                                           std::memcpy(film.layers.of(pixel), from + record * pixel_bytes, pixel_bytes);
                                       });
                    }
                });
}

}  // namespace cistula
