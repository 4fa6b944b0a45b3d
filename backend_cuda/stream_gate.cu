#include "backend_cuda/stream_gate.h"

#include <atomic>

namespace cistula {
namespace {

/// Until it was opened `turn` times.
__global__ void wait_for_host(const volatile uint32_t* opened, uint32_t turn) {
    constexpr long long longest = 150000;  // cycles
    const long long begin = clock64();
    while (int32_t(*opened - turn) < 0 && clock64() - begin < longest) {
    }
}

}  // namespace

StreamGate::StreamGate() {
    opened_.reserve(sizeof(uint32_t));
    *opened_.as<uint32_t>() = 0;
}

StreamGate::Hold StreamGate::hold(cudaStream_t stream) {
    ++closed_;
    wait_for_host<<<1, 1, 0, stream>>>(opened_.as<uint32_t>(), closed_);
    check_cuda(cudaGetLastError(), "launch of wait_for_host");
    return Hold(*this);
}

void StreamGate::open() {
    std::atomic_ref(*opened_.as<uint32_t>()).store(closed_, std::memory_order_release);
}

}  // namespace cistula
