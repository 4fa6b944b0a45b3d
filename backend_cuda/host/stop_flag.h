// What kernels look at to end soon.
#pragma once

#include "backend_cuda/host/cuda_resources.h"

namespace cistula {

/// A word in the memory of the device that is current when it is made: 1 while its kernels are to end.
class StopFlag {
  public:
    explicit StopFlag(cudaStream_t compute) {
        flag_.reserve(sizeof(unsigned int));
        one_.reserve(sizeof(unsigned int));
        *one_.as<unsigned int>() = 1;
        lower(compute);
    }

    const unsigned int* on_device() const { return flag_.as<unsigned int>(); }

    /// Sets it, past the kernels: by a copy on another stream, as a kernel that did so might have to wait for others.
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
