// A stream that waits until the host has enqueued all that is to run in one go.
#pragma once

#include <cudaTypedefs.h>

#include <cstdint>

#include "backend_cuda/cuda_resources.h"

namespace cistula {

/// Between an event and the kernel behind it a device may wait for the host, which takes ten microseconds to launch a kernel of
/// many parameters: time of the host's that the events would count as the kernel's. Belongs to the device that is current
/// when it is made. Where the driver has no such wait all goes on without one.
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

    /// What is enqueued from here on starts once the hold has ended.
    [[nodiscard]] Hold hold(cudaStream_t stream);

  private:
    void open();

    PFN_cuStreamWaitValue32_v11070 wait_ = nullptr;
    PinnedMemory opened_;  // how often it was opened
    uint32_t closed_ = 0;  // and closed
};

}  // namespace cistula
