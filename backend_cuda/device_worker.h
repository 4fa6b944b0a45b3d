// One GPU's share of frames: a part at a time on its way through the kernels while the one before is read back.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "backend_cuda/block_list.h"
#include "backend_cuda/cuda_resources.h"
#include "backend_cuda/frame_job.h"
#include "scene/film.h"
#include "scene/scene_arena.h"

namespace cistula {

/// "7.5 or later": what this build's kernels run on.
std::string kernel_architectures();
bool kernels_run_on_capability(int capability);

/// Makes a device current for the calls of this thread.
void use_device(int device);

/// Strips of the rectangle of a frame's cover that a device renders in one go.
struct FramePart {
    FrameView frame;
    std::shared_ptr<const FrameHints> hints;
    Strips strips;
    BlockPlan plan;
    Sampling sampling = Sampling::uniform;
    int mask = 0;  // index of effect_masks
};

/// A part on its way.
struct PartSlot {
    DeviceMemory records, blocks, tally;
    PinnedMemory blocks_copy, tally_copy;
    CudaEvent begin, end, done;  // of the kernels; of all, the tally's copy too
    FramePart part;
    BlockList list;
};

template <class Real>
class DeviceWorker {
  public:
    static constexpr int slots = 2;  // parts on their way at once

    /// `here`: the scene of the arena, where this program can read it.
    DeviceWorker(int device, const SceneArena<Real>& scene, const SceneView<Real>& here, DevicePath path);

    /// Takes memory for parts of that many pixels, those of whole blocks, in both slots, beside what a mask's kernel
    /// takes for itself. False where there is none.
    bool reserve(size_t pixels, size_t memory_limit, Sampling sampling, int mask);

    /// Enqueues a part; nothing is waited for. Its slot must be free.
    void start(const FramePart& part, int slot);

    /// Waits for the part in a slot and puts its pixels where they belong in the film. False, the part still under way,
    /// once `stop` is set.
    bool fetch(int slot, Film& film, const std::atomic<bool>& stop);

    /// Makes all that was started end soon, whatever is left to do; nothing is waited for. Until wait() nothing may
    /// start.
    void stop();

    /// Waits for all that was started.
    void wait();

    int device() const { return device_; }
    double kernel_seconds = 0, transfer_seconds = 0;  // of all parts fetched; the caller resets them
    RayCounts rays;
    uint32_t flags = 0;

  private:
    static constexpr size_t next_bytes = 16;

    void prime(Sampling sampling, int mask);
    void reserve_storage();
    void fill_gaps(const PartSlot& slot, Film& film);
    void copy_blocks(const PartSlot& slot, Film& film);

    const int device_;
    const DevicePath path_;
    CudaStream compute_, copy_;
    DeviceMemory arena_, next_;  // next_: FrameJob::next
    PinnedMemory staging_[2];
    CudaEvent staged_[2];
    DeviceMemory storage_;             // FrameJob::storage
    unsigned int storage_blocks_ = 0;  // 0: storage_ is empty
    uint32_t primed_ = 0;              // bit 2 m + s: that mask m's kernel of Sampling s has run
    DeviceMemory stop_;                // what kernels look at; 0 unless stopped_
    PinnedMemory one_;  // from where it is set: by a copy, as a kernel that does so might have to wait for the others
    bool stopped_ = false;
    DeviceScene<Real> scene_;
    std::vector<uint32_t> primitives_;  // of each solid, as in BlockPlace
    PartSlot slots_[slots];
};

}  // namespace cistula
