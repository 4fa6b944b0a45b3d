// Cases on a device: the launchers of a case, and transfer of its parts and results.
#pragma once

#include <cstddef>
#include <vector>

#include "apps/render_verify/setup.h"
#include "apps/render_verify/tally.h"

namespace cistula::verify {

/// Number of threads for the rays of a case, each with its own tally.
inline constexpr unsigned device_threads = 1u << 16, device_block = 128;

/// Launches a case's kernel. `setup` and `out` are in device memory; `functor` in host memory.
template <class Real>
struct DeviceMethods {
    void (*tally)(const std::byte* functor, const Setup<Real>& setup, uint64_t place, uint64_t count,
                  Tally* out) = nullptr;
    void (*words)(const std::byte* functor, const Setup<Real>& setup, uint64_t first, uint64_t count,
                  uint64_t* out) = nullptr;
};

/// Runs a case on the device. `here`: the part in host memory, with any tree. Throws Error (device).
template <class Real>
Tally tally_on_device(const DeviceMethods<Real>& methods, const std::byte* functor, const Setup<Real>& here,
                      uint64_t place, uint64_t count);
template <class Real>
std::vector<uint64_t> words_on_device(const DeviceMethods<Real>& methods, const std::byte* functor,
                                      const Setup<Real>& here, uint64_t count);

}  // namespace cistula::verify
