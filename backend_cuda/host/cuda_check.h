// Error checks for calls of the CUDA runtime; errors name the call and carry CUDA's message.
#pragma once

#include <cuda_runtime_api.h>

#include <string>

#include "base/error.h"

namespace cistula {

[[noreturn]] inline void fail_cuda(cudaError_t error, const std::string& call) {
    throw Error(ErrorKind::device,
                "CUDA: " + call + ": " + cudaGetErrorString(error) + " (" + cudaGetErrorName(error) + ")");
}

inline void check_cuda(cudaError_t error, const char* call) {
    if (error != cudaSuccess) fail_cuda(error, call);
}

}  // namespace cistula

/// Throws Error (device) where a call does not return cudaSuccess.
#define CISTULA_CUDA_CHECK(call) ::cistula::check_cuda((call), #call)
