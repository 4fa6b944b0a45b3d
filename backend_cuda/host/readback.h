// Copies the records of blocks from a GPU's memory to a film.
#pragma once

#include <cstddef>

#include "backend_cuda/host/block_list.h"
#include "backend_cuda/host/cuda_resources.h"
#include "render/record/film.h"

namespace cistula {

/// Copies records through page-locked buffers. Belongs to the device that is current when it is made.
class Readback {
  public:
    /// Copies the records of all blocks of a list, whose kept parts are stored at `records` on the device, to the film.
    /// It uses two page-locked buffers: one is filled while threads distribute the other over the film, and add up the
    /// radiance for `totals`.
    void copy(const PixelPlanes& records, const BlockList& list, Film& film, PixelTotals& totals);

    /// Copies the words of layers, as copy() does records.
    void copy_layers(const int64_t* layers, const BlockList& list, Film& film);

    cudaStream_t stream() const { return stream_; }

  private:
    template <class Part>
    void copy_part(const Part* from, const BlockList& list, const Film& film, Part* to, PixelTotals& totals);
    template <class Unpack>
    void copy_blocks(const std::byte* from, size_t pixel_bytes, const BlockList& list, const Unpack& unpack);

    CudaStream stream_;
    PinnedMemory staging_[2];
    CudaEvent staged_[2];
};

}  // namespace cistula
