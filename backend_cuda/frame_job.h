// What the host asks of a device for a part of a frame, and the kernels' launcher.
#pragma once

#include <cuda_runtime_api.h>

#include <vector>

#include "backend_cuda/block_pixels.h"
#include "backend_cuda/cuda_renderer.h"
#include "cistula/small_scene.h"

namespace cistula {

/// Ray counts and flags, added up by many blocks: spread over slots, so that they do not queue for one.
struct DeviceTally {
    static constexpr int slots = 64;
    unsigned long long rays[slots][4];  // in the order of RayCounts
    unsigned int flags;
};

/// Branches that wait for the next pass, of any kind of media: bytes for `capacity` of them.
struct BranchQueue {
    void* items = nullptr;
    unsigned int capacity = 0;
    unsigned int* size = nullptr;  // may pass capacity: what found no room
};

/// Whether kernels of a mask, an index of effect_masks, write PixelRecords: else SeenRecords (RecordOf).
constexpr bool has_ledger(int mask) {
    return sends_rays_on(effect_masks[mask]);
}
constexpr size_t record_bytes(int mask) {
    return has_ledger(mask) ? sizeof(PixelRecord) : sizeof(SeenRecord);
}

inline constexpr int whole_trees = 0x7fffffff;

/// A pixel that is sampled adaptively.
struct LatticeRoom {
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
    void* records =
        nullptr;       // by blocks: PixelRecords, or SeenRecords without a ledger; those beyond the rectangle are unset
    int x = 0, y = 0;  // of the rectangle in the frame
    int width = 0, height = 0;  // of the rectangle
    const BlockPlace* blocks = nullptr;
    unsigned int block_count = 0;
    PixelMapping mapping = PixelMapping::own_tiles;
    DeviceTally* tally = nullptr;
    BranchQueue from, to;                // passes after the first read `from`
    int split_depth = whole_trees;       // branches of this depth and more go `to` the queue
    const unsigned int* stop = nullptr;  // to a 1: the kernel ends, and what it has written means nothing
    unsigned int* next = nullptr;        // of adaptive sampling: the pixel that the next free warp takes,
    LatticeRoom* rooms = nullptr;        // ... pixels_at_work for each of room_blocks
    unsigned int room_blocks = 0;
};

/// Which intersector and which form of media the kernels use. Never changes the image.
enum class DevicePath {
    plain_loop,  // a SmallScene of few primitives, closed solids all convex and apart
    tree,        // any scene
};
inline constexpr int device_path_count = 2;

/// Warps of the blocks in which a mask's pixels are rendered. Large blocks pay where the code is much more than the
/// instruction caches hold; with other masks most frames take longer (docs/architecture.md).
constexpr int warps_of_blocks(uint32_t effects) {
    const bool is_large = (effects & effect_refraction) != 0 || effects == (clear_bodies | effect_visible_lights);
    return is_large ? large_block_warps : block_warps;
}

/// The scene in both forms; `small` is set for the plain loop only.
template <class Real>
struct DeviceScene {
    SceneView<Real> view;  // in device memory
    SmallScene<Real> small;
};

/// Bytes of a queued branch.
template <class Real>
size_t queued_branch_bytes(DevicePath path);

/// What a kernel goes over: all pixels of the job, those of a frame with a target error, or the branches of job.from.
enum class Pass { pixels, adaptive_pixels, branches };

/// Enqueues a pass; Pass::branches is for masks whose trees_fork, Pass::adaptive_pixels for all but the unshadowed one.
/// `mask` is an index of effect_masks. Throws Error (device).
template <class Real>
void launch(Pass pass, int mask, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
            cudaStream_t stream);

}  // namespace cistula
