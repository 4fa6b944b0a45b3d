// A kernel's job, a part of a frame, and the function that launches it.
#pragma once

#include <cuda_runtime_api.h>

#include "backend_cuda/kernels/block_pixels.h"
#include "cistula/adaptive/lattice.h"
#include "cistula/model/constant_scene.h"
#include "cistula/transport/ray_query.h"

namespace cistula {

/// Ray counts, totals and error flags, added up by many blocks; several slots reduce contention between them.
struct DeviceTally {
    static constexpr int slots = 64;
    unsigned long long rays[slots][4];  // in the order of RayCounts
    Total losses[slots][6];             // pruned, cut, as in PixelLosses; not of frames with a target error
    unsigned int most_rays[slots];      // of a pixel; likewise
    unsigned int flags;
};

/// The state of an adaptively sampled pixel until it is finished.
struct LatticeStorage {
    LatticePixel pixel;
    LatticeSample samples[lattice_samples];
};
/// The number of adaptively sampled pixels that a block works on at a time. At first they want a sample for most of its
/// threads, later for all. With twice as many platonic.json takes 15 % longer at 320x180 (H200), as the last warps take
/// longer to finish theirs.
inline constexpr int pixels_at_work = 16;

/// A kernel's parameters: the blocks of a frame's rectangle to render.
struct FrameJob {
    FrameView frame;
    PixelPlanes records;        // ordered by blocks; unset beyond the rectangle
    int64_t* layers = nullptr;  // frame.layers.words for each record, 0 at first
    // of the rectangle in the frame
    int x = 0;
    int y = 0;
    // of the rectangle
    int width = 0;
    int height = 0;
    const BlockPlace* blocks = nullptr;
    unsigned int block_count = 0;
    PixelMapping mapping = PixelMapping::own_tiles;
    DeviceTally* tally = nullptr;
    const unsigned int* stop = nullptr;  // points to 1: the kernel ends, and its output is invalid
    unsigned int* next = nullptr;        // adaptive sampling: the pixel that the next free warp takes,
    LatticeStorage* storage = nullptr;   // ... pixels_at_work for each of storage_blocks,
    int64_t* sample_layers = nullptr;    // ... and frame.layers.sample_words() for each of their samples
    unsigned int storage_blocks = 0;

    CISTULA_INLINE PixelLayers layers_of(unsigned int record) const {
        return {layers + size_t(record) * size_t(frame.layers.words), 1};
    }
};

/// A scene in its forms; `constant` and `balls` are set for their loops only.
template <class Real>
struct DeviceScene {
    SceneView<Real> view;  // in device memory
    ConstantScene<Real> constant;
    BallScene<Real> balls;
};

/// How a kernel samples: every pixel on its uniform grid, or adaptively in a frame with a target error.
enum class Sampling { uniform, adaptive };

/// Enqueues a job's kernel. `mask` is an index of effect_masks. Adaptive sampling is compiled only for all effects,
/// with and without layers; layers only for DevicePath::tree, and DevicePath::ball_loop only for ball_mask. Throws
/// Error (device).
template <class Real>
void launch(Sampling sampling, int mask, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
            cudaStream_t stream);

/// launch() for one mask, defined in frame_kernels.cuh. Each mask and precision is instantiated in its own source file
/// (frame_kernels.cu.in), so that they compile in parallel.
template <class Real, int mask>
void launch_mask(Sampling sampling, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
                 cudaStream_t stream);

/// Enqueues the answers to questions about rays, or about segments (ray_query.h), of a scene in device memory that has
/// its tree. Throws Error (device).
template <class Real>
void launch_queries(const SceneView<Real>& scene, const RayQuestion* questions, unsigned int count, RayAnswer* answers,
                    cudaStream_t stream);
template <class Real>
void launch_queries(const SceneView<Real>& scene, const RayQuestion* questions, unsigned int count,
                    Vec3<double>* shares, cudaStream_t stream);

}  // namespace cistula
