#include "backend_cuda/stream_gate.h"

#include <atomic>

namespace cistula {

StreamGate::StreamGate() {
    // By the runtime, as programs that link the driver would not start where there is none.
    void* found = nullptr;
    cudaDriverEntryPointQueryResult result{};
    constexpr unsigned int since = 11070;  // CUDA 11.7
    if (cudaGetDriverEntryPointByVersion("cuStreamWaitValue32", &found, since, cudaEnableDefault, &result) != cudaSuccess ||
        result != cudaDriverEntryPointSuccess) {
        cudaGetLastError();  // or the next launch would be told
        return;
    }
    opened_.reserve(sizeof(uint32_t));
    *opened_.as<uint32_t>() = 0;
    wait_ = reinterpret_cast<PFN_cuStreamWaitValue32_v11070>(found);
}

StreamGate::Hold StreamGate::hold(cudaStream_t stream) {
    ++closed_;
    // One address for host and device, as of all memory that the runtime locks.
    if (wait_ && wait_(stream, reinterpret_cast<CUdeviceptr>(opened_.as<uint32_t>()), closed_, CU_STREAM_WAIT_VALUE_GEQ) != CUDA_SUCCESS)
        wait_ = nullptr;
    return Hold(*this);
}

void StreamGate::open() {
    if (wait_) std::atomic_ref(*opened_.as<uint32_t>()).store(closed_, std::memory_order_release);
}

}  // namespace cistula
