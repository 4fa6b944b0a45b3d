#include "backend_cuda/host/readback.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

#include "scene/film/put_pixels.h"

namespace cistula {
namespace {

constexpr size_t staging_bytes = size_t{32} << 20;
constexpr int blocks_together = 16;  // that a host thread unpacks at a time

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

/// Writes a block's records to the film.
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

void Readback::copy(const PixelRecord* records, const BlockList& list, Film& film) {
    const std::vector<BlockPlace>& places = list.places();
    const BlockShape shape = list.shape();
    const auto order = rows_of_records(list.plan());
    const size_t in_block = size_t(shape.pixels());
    const int count = int(places.size());
    // Staging buffers no larger than needed: locking pages takes longer than rendering a small frame.
    const int batch = std::min(int(staging_bytes / (in_block * sizeof(PixelRecord))), count);
    for (PinnedMemory& buffer : staging_) buffer.reserve(size_t(batch) * in_block * sizeof(PixelRecord));
    const auto fill = [&](int first, int buffer) {
        const size_t pixels = size_t(std::min(batch, count - first)) * in_block;
        CISTULA_CUDA_CHECK(cudaMemcpyAsync(staging_[buffer].as<void>(), records + size_t(first) * in_block,
                                           pixels * sizeof(PixelRecord), cudaMemcpyDeviceToHost, stream_));
        CISTULA_CUDA_CHECK(cudaEventRecord(staged_[buffer], stream_));
    };
    fill(0, 0);
    for (int first = 0, buffer = 0; first < count; first += batch, buffer ^= 1) {
        CISTULA_CUDA_CHECK(cudaEventSynchronize(staged_[buffer]));
        if (first + batch < count) fill(first + batch, buffer ^ 1);
        const PixelRecord* from = staging_[buffer].as<PixelRecord>();
        const tbb::blocked_range<int> blocks(0, std::min(batch, count - first), blocks_together);
        tbb::parallel_for(blocks, [&](const tbb::blocked_range<int>& some) {
            const PixelWriter writer;
            for (int i = some.begin(); i < some.end(); ++i)
                unpack(from + size_t(i) * in_block, order, shape, places[size_t(first + i)], film, writer);
        });
    }
}

}  // namespace cistula
