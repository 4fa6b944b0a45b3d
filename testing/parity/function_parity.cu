// Function parity, the GPU's side: one thread per input, which it generates itself.
#include "backend_cuda/host/cuda_check.h"
#include "testing/parity/function_cases.h"
#include "testing/parity/function_parity.h"

namespace cistula::parity {
namespace {

template <class Case>
__global__ void run_cases(uint64_t seed, uint64_t first, uint64_t count, uint64_t* out) {
    const uint64_t i = uint64_t(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i < count) run_case<Case>(first + i, seed, out + i * Case::words);
}

/// Tests bit patterns in turn, skipping those out of range.
__global__ void try_reciprocals(float low, float high, ReciprocalTally* tally) {
    const uint64_t threads = uint64_t(gridDim.x) * blockDim.x;
    unsigned long long equal = 0;
    for (uint64_t i = uint64_t(blockIdx.x) * blockDim.x + threadIdx.x; i < uint64_t(1) << 32; i += threads) {
        const float x = bits_as<float>(uint32_t(i));
        if (!(magnitude(x) >= low && magnitude(x) <= high)) continue;
        const uint32_t ours = bits_as<uint32_t>(reciprocal(x));
        if (ours == bits_as<uint32_t>(__fdiv_rn(1.0f, x)))
            ++equal;
        else
            atomicMin(&tally->first_difference, (unsigned long long)(i << 32 | ours));
    }
    atomicAdd(&tally->equal, equal);
}

struct DeviceWords {
    uint64_t* data = nullptr;

    explicit DeviceWords(size_t size) { CISTULA_CUDA_CHECK(cudaMalloc(&data, size * sizeof(uint64_t))); }
    DeviceWords(const DeviceWords&) = delete;
    DeviceWords& operator=(const DeviceWords&) = delete;
    ~DeviceWords() { cudaFree(data); }
};

template <class Case>
void run_on_device(uint64_t seed, uint64_t first, uint64_t count, uint64_t* out) {
    constexpr unsigned block = 128;
    if (count == 0) return;
    const DeviceWords words(count * Case::words);
    run_cases<Case><<<unsigned((count + block - 1) / block), block>>>(seed, first, count, words.data);
    const std::string kernel =
        std::string("run_cases<") + Case::name + ", " + RealTraits<typename Case::Number>::name + ">";
    check_cuda(cudaGetLastError(), kernel.c_str());
    check_cuda(cudaDeviceSynchronize(), kernel.c_str());
    CISTULA_CUDA_CHECK(cudaMemcpy(out, words.data, count * Case::words * sizeof(uint64_t), cudaMemcpyDeviceToHost));
}

template <class... Cases>
std::vector<CaseRunner> device_runners(CaseList<Cases...>) {
    return {{Cases::name, RealTraits<typename Cases::Number>::name, Cases::words, &run_on_device<Cases>}...};
}

}  // namespace

ReciprocalTally try_every_reciprocal(float low, float high) {
    ReciprocalTally tally;
    static_assert(sizeof tally % sizeof(uint64_t) == 0);
    const DeviceWords words(sizeof tally / sizeof(uint64_t));
    CISTULA_CUDA_CHECK(cudaMemcpy(words.data, &tally, sizeof tally, cudaMemcpyHostToDevice));
    try_reciprocals<<<4096, 256>>>(low, high, reinterpret_cast<ReciprocalTally*>(words.data));
    check_cuda(cudaGetLastError(), "try_reciprocals");
    check_cuda(cudaDeviceSynchronize(), "try_reciprocals");
    CISTULA_CUDA_CHECK(cudaMemcpy(&tally, words.data, sizeof tally, cudaMemcpyDeviceToHost));
    return tally;
}

std::vector<CaseRunner> device_cases() {
    return device_runners(AllCases());
}

}  // namespace cistula::parity
