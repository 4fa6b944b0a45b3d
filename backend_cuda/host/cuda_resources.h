// What the CUDA runtime hands out, owned. All belong to the device that is current when they are made.
#pragma once

#include <cstddef>
#include <utility>

#include "backend_cuda/host/cuda_check.h"

namespace cistula {

/// Memory of a device, or page-locked memory of the host that devices copy to at full speed.
template <bool on_device>
class CudaMemory {
  public:
    CudaMemory() = default;
    ~CudaMemory() { free(); }
    CudaMemory(CudaMemory&& other) noexcept { swap(other); }
    CudaMemory& operator=(CudaMemory&& other) noexcept {
        swap(other);
        return *this;
    }

    /// At least `bytes`, contents undefined. Throws Error (device); the memory is then empty.
    void reserve(size_t bytes) {
        if (!try_reserve(bytes))
            fail_cuda(cudaErrorMemoryAllocation, "no room for " + std::to_string(bytes) + " bytes");
    }

    /// At least `bytes`, contents undefined; false where there is no room for it. Other errors throw.
    bool try_reserve(size_t bytes) {
        if (bytes <= bytes_) return true;
        free();
        const cudaError_t error = on_device ? cudaMalloc(&data_, bytes) : cudaMallocHost(&data_, bytes);
        if (error == cudaErrorMemoryAllocation) {
            cudaGetLastError();  // it is no longer news
            data_ = nullptr;
            return false;
        }
        check_cuda(error, on_device ? "cudaMalloc" : "cudaMallocHost");
        bytes_ = bytes;
        return true;
    }

    void free() {
        if (data_) on_device ? cudaFree(data_) : cudaFreeHost(data_);
        data_ = nullptr;
        bytes_ = 0;
    }

    template <class T>
    T* as() const {
        return static_cast<T*>(data_);
    }
    size_t size() const { return bytes_; }

  private:
    void swap(CudaMemory& other) {
        std::swap(data_, other.data_);
        std::swap(bytes_, other.bytes_);
    }
    void* data_ = nullptr;
    size_t bytes_ = 0;
};
using DeviceMemory = CudaMemory<true>;
using PinnedMemory = CudaMemory<false>;

class CudaStream {
  public:
    CudaStream() { CISTULA_CUDA_CHECK(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking)); }
    ~CudaStream() { cudaStreamDestroy(stream_); }
    CudaStream(const CudaStream&) = delete;
    CudaStream& operator=(const CudaStream&) = delete;
    operator cudaStream_t() const { return stream_; }

  private:
    cudaStream_t stream_ = nullptr;
};

class CudaEvent {
  public:
    CudaEvent() { CISTULA_CUDA_CHECK(cudaEventCreate(&event_)); }
    ~CudaEvent() { cudaEventDestroy(event_); }
    CudaEvent(const CudaEvent&) = delete;
    CudaEvent& operator=(const CudaEvent&) = delete;
    operator cudaEvent_t() const { return event_; }

    bool happened() const {
        const cudaError_t error = cudaEventQuery(event_);
        if (error == cudaSuccess) return true;
        if (error != cudaErrorNotReady) fail_cuda(error, "cudaEventQuery");
        cudaGetLastError();  // or the next launch would be told
        return false;
    }

    /// Milliseconds from `earlier`; both must have happened.
    double since(const CudaEvent& earlier) const {
        float milliseconds = 0;
        CISTULA_CUDA_CHECK(cudaEventElapsedTime(&milliseconds, earlier.event_, event_));
        return milliseconds;
    }

  private:
    cudaEvent_t event_ = nullptr;
};

}  // namespace cistula
