// Which pixels a block's threads render, and how their records get from shared memory to where they belong.
#pragma once

#include "backend_cuda/kernel_parts.cuh"

namespace cistula {

static_assert(2 * sizeof(PixelRecord) % sizeof(uint4) == 0 && 2 * sizeof(SeenRecord) % sizeof(uint4) == 0);

/// Where pixels have several samples, all warps of a block share one tile's, so that no thread is long at work.
__host__ __device__ inline bool shares_tiles(const FrameView& frame) {
    return frame.supersample > 1;
}

/// Pixels of a block: a tile that its warps share, or 2 x 2 of them.
struct BlockShape {
    int width, height;

    __host__ __device__ static BlockShape of(const FrameView& frame) {
        return shares_tiles(frame) ? BlockShape{tile_width, tile_height} : BlockShape{2 * tile_width, 2 * tile_height};
    }
};

/// How the pixels of a block are dealt out. Records are staged in the order of threads, which spares conflicts between the
/// banks of shared memory, and pixels are dealt out by twos, whose records are whole words of 16 bytes.
enum class Deal {
    shared,       // one tile, for every warp
    tiles,        // a tile a warp
    interleaved,  // to a warp every other two of a row, and every other row
};

struct PixelPlace {
    int column, row;  // in the block
};

template <Deal deal>
__device__ inline PixelPlace place_of_thread(int warp, int lane) {
    const int x = lane % tile_width, y = lane / tile_width;
    if constexpr (deal == Deal::interleaved) return {x / 2 * 4 + warp % 2 * 2 + x % 2, 2 * y + warp / 2};
    if constexpr (deal == Deal::tiles) return {x + warp % 2 * tile_width, y + warp / 2 * tile_height};
    return {x, y};
}

__device__ inline PixelPlace place_of_thread(Deal deal, int warp, int lane) {
    return deal == Deal::interleaved ? place_of_thread<Deal::interleaved>(warp, lane)
           : deal == Deal::tiles     ? place_of_thread<Deal::tiles>(warp, lane)
                                     : place_of_thread<Deal::shared>(warp, lane);
}

/// The first thread of those that have two pixels of a row.
template <Deal deal>
__device__ inline int thread_of_pair(int pair, int row) {
    constexpr int half = tile_width / 2;
    if constexpr (deal == Deal::interleaved)
        return (row % 2 * 2 + pair % 2) * warp_threads + row / 2 * tile_width + pair / 2 * 2;
    if constexpr (deal == Deal::tiles)
        return (row / tile_height * 2 + pair / half) * warp_threads + row % tile_height * tile_width + pair % half * 2;
    return row * tile_width + pair * 2;
}

__device__ inline int thread_of_pair(Deal deal, int pair, int row) {
    return deal == Deal::interleaved ? thread_of_pair<Deal::interleaved>(pair, row)
           : deal == Deal::tiles     ? thread_of_pair<Deal::tiles>(pair, row)
                                     : thread_of_pair<Deal::shared>(pair, row);
}

/// A block's threads write its records, whole rows at a time: two records are as many lanes' as they have words.
template <Deal deal, class Record>
__device__ void write_all(const Record* staged, Record* to, int frame_width) {
    constexpr int words = 2 * int(sizeof(Record)) / int(sizeof(uint4)), pairs = warp_threads / words;  // at a time
    constexpr int tiles = deal == Deal::shared ? 1 : 2, width = tiles * tile_width, height = tiles * tile_height;
    static_assert(width / 2 % pairs == 0 && height % block_warps == 0);
    const int warp = threadIdx.x / warp_threads, lane = threadIdx.x % warp_threads;
    const int pair = lane / words, word = lane % words;
    if (pair >= pairs) return;
    const size_t pitch = size_t(frame_width / 2) * words;
    auto* out = reinterpret_cast<uint4*>(to) + size_t(warp) * pitch + size_t(lane);
#pragma unroll
    for (int r = 0; r < height; r += block_warps, out += block_warps * pitch)
#pragma unroll
        for (int p = 0; p < width / 2; p += pairs)
            out[p * words] = reinterpret_cast<const uint4*>(staged + thread_of_pair<deal>(p + pair, r + warp))[word];
}

/// The first columns of its rows.
template <class Record>
__device__ void write_columns(const Record* staged, Deal deal, BlockShape block, Record* to, int columns, int frame_width) {
    constexpr int record = int(sizeof(Record)) / int(sizeof(uint2));
    const int warp = threadIdx.x / warp_threads, lane = threadIdx.x % warp_threads;
#pragma unroll 1
    for (int r = warp; r < block.height; r += block_warps) {
        auto* to_row = reinterpret_cast<uint2*>(to + size_t(r) * size_t(frame_width));
        for (int i = lane; i < columns * record; i += warp_threads) {
            const int column = i / record, thread = thread_of_pair(deal, column / 2, r) + column % 2;
            to_row[i] = reinterpret_cast<const uint2*>(staged + thread)[i % record];
        }
    }
}

template <class Record>
__device__ void write_block(const Record* staged, Deal deal, BlockShape block, const FrameJob& job, int left, int top) {
    Record* to = static_cast<Record*>(job.records) + size_t(top) * size_t(job.width) + left;
    const int columns = min(block.width, job.width - left);
    // In pairs of records all is aligned to 16 bytes.
    if (columns < block.width || job.width % 2 != 0)
        write_columns(staged, deal, block, to, columns, job.width);
    else if (deal == Deal::shared)
        write_all<Deal::shared>(staged, to, job.width);
    else if (deal == Deal::interleaved)
        write_all<Deal::interleaved>(staged, to, job.width);
    else
        write_all<Deal::tiles>(staged, to, job.width);
}

}  // namespace cistula
