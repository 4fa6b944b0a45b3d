// One GPU's share of frames: one part is rendered while the previous one is read back.
#pragma once

#include <atomic>
#include <memory>
#include <span>

#include "backend_cuda/host/frame_plan.h"
#include "backend_cuda/host/readback.h"
#include "backend_cuda/host/scene_upload.h"
#include "backend_cuda/host/stop_flag.h"
#include "render/record/film.h"

namespace cistula {

/// Makes a device current for the calls of this thread.
void use_device(int device);

template <class Real>
class DeviceWorker {
  public:
    static constexpr int slots = 2;  // parts that are in progress at once

    /// `here`: a view of the arena's scene in host memory. The device must be current.
    DeviceWorker(int device, const SceneArena<Real>& scene, const SceneView<Real>& here, DevicePath path);

    /// Allocates memory for parts of `pixels` pixels, counting whole blocks, in both slots, beside what a mask's kernel
    /// allocates for itself. False if there is not enough. No part may be in work, unless is_ready().
    bool reserve(size_t pixels, size_t memory_limit, const FramePlan& plan);

    /// Whether reserve() has nothing to do.
    bool is_ready(size_t pixels, const FramePlan& plan) const;

    /// The number of parts that were started and not fetched.
    int in_work() const { return started_ - fetched_; }

    /// Enqueues a part of a frame without waiting. A slot must be free.
    void start(const FramePlan& plan, const Strips& strips);

    /// Waits for the part that was started first and puts its pixels into the film. False once `stop` is set; the part
    /// is then still being rendered.
    bool fetch(Film& film, const std::atomic<bool>& stop);

    /// Answers questions about rays or segments (ray_query.h). The path must be DevicePath::tree.
    template <class Answer>
    void answer(std::span<const RayQuestion> questions, std::span<Answer> answers);

    /// Makes all that was started end soon, without waiting. Nothing may be started until wait() returns.
    void stop();

    /// Waits for all that was started.
    void wait();

    /// Totals over all parts fetched since the caller reset them.
    struct Totals {
        double kernel_seconds = 0;
        double transfer_seconds = 0;
        FrameCounts counts;  // without the totals that adaptive sampling's kernel would count
    };
    Totals totals;

  private:
    /// A part that is being rendered.
    struct PartSlot {
        DeviceMemory radiance, losses, sights, layers, blocks, tally;
        PinnedMemory blocks_copy, tally_copy;
        CudaEvent begin, end, done;  // around the kernel; after the tally's copy too
        std::shared_ptr<const FrameHints> hints;
        BlockList list;
    };

    FrameJob job_for(const PartSlot& slot) const;
    void prime(Sampling sampling, int mask);
    void reserve_storage(const LayerPlan& layers);
    void fill_gaps(const PartSlot& slot, Film& film);

    const int device_;
    const DevicePath path_;
    CudaStream compute_;
    const SceneUpload<Real> upload_;
    Readback readback_;
    StopFlag stop_;
    DeviceMemory next_;                // FrameJob::next
    DeviceMemory storage_;             // FrameJob::storage, and sample_layers behind it
    unsigned int storage_blocks_ = 0;  // 0: storage_ is empty
    int sample_words_ = 0;             // for which storage_ has room
    uint32_t primed_ = 0;              // bit 2 m + s: mask m's kernel for Sampling s has run
    // What slots have room for: pixels, words of layers, and the parts of pixels that they keep.
    size_t pixels_ = 0;
    size_t words_ = 0;
    KeptParts parts_;
    // parts; number i goes to slot i % slots
    int started_ = 0;
    int fetched_ = 0;
    PartSlot slots_[slots];
};

}  // namespace cistula
