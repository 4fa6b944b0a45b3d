// One GPU's share of frames: a part at a time on its way through the kernels while the one before is read back.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "backend_cuda/host/frame_plan.h"
#include "backend_cuda/host/readback.h"
#include "backend_cuda/host/scene_upload.h"
#include "backend_cuda/host/stop_flag.h"
#include "scene/film/film.h"

namespace cistula {

/// "7.5 or later": what this build's kernels run on.
std::string kernel_architectures();
bool kernels_run_on_capability(int capability);

/// Makes a device current for the calls of this thread.
void use_device(int device);

template <class Real>
class DeviceWorker {
  public:
    static constexpr int slots = 2;  // parts on their way at once

    /// `here`: the scene of the arena, where this program can read it. The device is current.
    DeviceWorker(int device, const SceneArena<Real>& scene, const SceneView<Real>& here, DevicePath path);

    /// Takes memory for parts of that many pixels, those of whole blocks, in both slots, beside what a mask's kernel
    /// takes for itself. False where there is none.
    bool reserve(size_t pixels, size_t memory_limit, Sampling sampling, int mask);

    /// Enqueues a part of a frame; nothing is waited for. Its slot must be free.
    void start(const FramePlan& plan, const Strips& strips, int slot);

    /// Waits for the part in a slot and puts its pixels where they belong in the film. False, the part still under way,
    /// once `stop` is set.
    bool fetch(int slot, Film& film, const std::atomic<bool>& stop);

    /// Makes all that was started end soon, whatever is left to do; nothing is waited for. Until wait() nothing may
    /// start.
    void stop();

    /// Waits for all that was started.
    void wait();

    /// Counts of all parts fetched since the caller reset them.
    struct Totals {
        double kernel_seconds = 0, transfer_seconds = 0;
        RayCounts rays;
        uint32_t flags = 0;
    };
    Totals totals;

  private:
    /// A part on its way.
    struct PartSlot {
        DeviceMemory records, blocks, tally;
        PinnedMemory blocks_copy, tally_copy;
        CudaEvent begin, end, done;  // of the kernels; of all, the tally's copy too
        std::shared_ptr<const FrameHints> hints;
        BlockList list;
    };

    FrameJob job_for(const PartSlot& slot) const;
    void prime(Sampling sampling, int mask);
    void reserve_storage();
    void fill_gaps(const PartSlot& slot, Film& film);

    const int device_;
    const DevicePath path_;
    CudaStream compute_;
    const SceneUpload<Real> upload_;
    Readback readback_;
    StopFlag stop_;
    DeviceMemory next_;                // FrameJob::next
    DeviceMemory storage_;             // FrameJob::storage
    unsigned int storage_blocks_ = 0;  // 0: storage_ is empty
    uint32_t primed_ = 0;              // bit 2 m + s: that mask m's kernel of Sampling s has run
    PartSlot slots_[slots];
};

}  // namespace cistula
