// A stream that waits a moment for the host to enqueue all that is to run in one go.
#pragma once

#include <cstdint>

#include "backend_cuda/cuda_resources.h"

namespace cistula {

/// Between an event and the kernel behind it a device may wait for the host, which takes some microseconds to launch a
/// kernel of many parameters: time of the host's that the events would count as the kernel's. Belongs to the device
/// that is current when it is made.
class StreamGate {
  public:
    StreamGate();

    /// Closed while it lives.
    class Hold {
      public:
        explicit Hold(StreamGate& gate) : gate_(gate) {}
        ~Hold() { gate_.open(); }
        Hold(const Hold&) = delete;
        Hold& operator=(const Hold&) = delete;

      private:
        StreamGate& gate_;
    };

    /// What is enqueued from here on starts once the hold has ended, or a tenth of a millisecond later: tools that let
    /// every launch wait for its kernel (compute-sanitizer, CUDA_LAUNCH_BLOCKING) would wait for ever else. Throws
    /// Error (device).
    [[nodiscard]] Hold hold(cudaStream_t stream);

  private:
    void open();

    PinnedMemory opened_;  // how often it was opened
    uint32_t closed_ = 0;  // and closed
};

}  // namespace cistula
