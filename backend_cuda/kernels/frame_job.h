// What the host asks of a device for a part of a frame, and the kernels' launcher.
#pragma once

#include <cuda_runtime_api.h>

#include "backend_cuda/kernels/block_pixels.h"
#include "cistula/adaptive/lattice.h"
#include "cistula/model/constant_scene.h"
#include "cistula/transport/pixel.h"

namespace cistula {

/// Ray counts and flags, added up by many blocks: spread over slots, so that they do not queue for one.
struct DeviceTally {
    static constexpr int slots = 64;
    unsigned long long rays[slots][4];  // in the order of RayCounts
    unsigned int flags;
};

/// What a pixel that is sampled adaptively keeps until it is done.
struct LatticeStorage {
    LatticePixel pixel;
    LatticeSample samples[lattice_samples];
};
/// Such pixels that a block has at work at a time. At first they want a sample for most of its threads, later for all.
/// With twice as many platonic.json takes 15 % longer at 320x180 (H200), as the last warps are longer alone with
/// theirs.
inline constexpr int pixels_at_work = 16;

/// Blocks of the frame's rectangle.
struct FrameJob {
    FrameView frame;
    PixelRecord* records = nullptr;  // by blocks; those beyond the rectangle are unset
    int x = 0, y = 0;                // of the rectangle in the frame
    int width = 0, height = 0;       // of the rectangle
    const BlockPlace* blocks = nullptr;
    unsigned int block_count = 0;
    PixelMapping mapping = PixelMapping::own_tiles;
    DeviceTally* tally = nullptr;
    const unsigned int* stop = nullptr;  // to a 1: the kernel ends, and what it has written means nothing
    unsigned int* next = nullptr;        // of adaptive sampling: the pixel that the next free warp takes,
    LatticeStorage* storage = nullptr;   // ... pixels_at_work for each of storage_blocks
    unsigned int storage_blocks = 0;
};

/// The scene in both forms; `constant` is set for the plain loop only.
template <class Real>
struct DeviceScene {
    SceneView<Real> view;  // in device memory
    ConstantScene<Real> constant;
};

/// What a kernel renders: all pixels of the job with their grid of samples, or those of a frame with a target error.
enum class Sampling { uniform, adaptive };

/// Enqueues a job's kernel. `mask` is an index of effect_masks; adaptive sampling runs with all effects, the last that
/// scenes run with. Throws Error (device).
template <class Real>
void launch(Sampling sampling, int mask, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
            cudaStream_t stream);

/// launch() of one mask: defined in frame_kernels.cuh, instantiated one mask and precision a source
/// (frame_kernels.cu.in), so that they compile side by side.
template <class Real, int mask>
void launch_mask(Sampling sampling, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
                 cudaStream_t stream);

}  // namespace cistula
