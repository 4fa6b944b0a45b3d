// Owners of CUDA runtime resources. Each belongs to the device that is current when it is made.
#pragma once

#include <cstddef>
#include <utility>

#include "backend_cuda/host/cuda_check.h"

namespace cistula {

/// Device memory, or page-locked host memory, which devices copy to at full speed.
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

    /// Reserves at least `bytes`, with undefined contents. Throws Error (device); the memory is then empty.
    void reserve(size_t bytes) {
        if (!try_reserve(bytes))
            fail_cuda(cudaErrorMemoryAllocation, "no room for " + std::to_string(bytes) + " bytes");
    }

    /// Reserves at least `bytes`, with undefined contents; false if there is not enough memory. Other errors throw.
    bool try_reserve(size_t bytes) {
        if (bytes <= bytes_) return true;
        free();
        const cudaError_t error = on_device ? cudaMalloc(&data_, bytes) : cudaMallocHost(&data_, bytes);
        if (error == cudaErrorMemoryAllocation) {
            cudaGetLastError();  // clears the error, which is handled here
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
        cudaGetLastError();  // clears the error, which the next launch would report
        return false;
    }

    /// Milliseconds since `earlier`; both events must have completed.
    double since(const CudaEvent& earlier) const {
        float milliseconds = 0;
        CISTULA_CUDA_CHECK(cudaEventElapsedTime(&milliseconds, earlier.event_, event_));
        return milliseconds;
    }

  private:
    cudaEvent_t event_ = nullptr;
};

}  // namespace cistula
