// The flag by which the host ends running kernels.
#pragma once

#include "backend_cuda/host/cuda_resources.h"

namespace cistula {

/// A word in the memory of the device that is current when it is made; 1 tells its kernels to end.
class StopFlag {
  public:
    explicit StopFlag(cudaStream_t compute) {
        flag_.reserve(sizeof(unsigned int));
        one_.reserve(sizeof(unsigned int));
        *one_.as<unsigned int>() = 1;
        lower(compute);
    }

    const unsigned int* on_device() const { return flag_.as<unsigned int>(); }

    /// Sets the flag by a copy on another stream: a kernel that set it might have to wait for the running ones.
    void raise(cudaStream_t copy) {
        CISTULA_CUDA_CHECK(
            cudaMemcpyAsync(flag_.as<void>(), one_.as<void>(), sizeof(unsigned int), cudaMemcpyHostToDevice, copy));
        is_raised_ = true;
    }
    bool is_raised() const { return is_raised_; }
    void lower(cudaStream_t compute) {
        CISTULA_CUDA_CHECK(cudaMemsetAsync(flag_.as<void>(), 0, sizeof(unsigned int), compute));
        is_raised_ = false;
    }

  private:
    DeviceMemory flag_;
    PinnedMemory one_;
    bool is_raised_ = false;
};

}  // namespace cistula
