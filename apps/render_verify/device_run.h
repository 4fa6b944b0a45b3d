// Cases on a device: the launchers of one case, and what moves its parts there and its findings back.
#pragma once

#include <cstddef>
#include <vector>

#include "apps/render_verify/setup.h"
#include "apps/render_verify/tally.h"

namespace cistula::verify {

/// Threads that a case's rays are dealt out to, each with a tally of its own.
inline constexpr unsigned device_threads = 1u << 16, device_block = 128;

/// `setup` and `out` are the device's; `functor` is read here.
template <class Real>
struct DeviceMethods {
    void (*tally)(const std::byte* functor, const Setup<Real>& setup, uint64_t place, uint64_t count,
                  Tally* out) = nullptr;
    void (*words)(const std::byte* functor, const Setup<Real>& setup, uint64_t first, uint64_t count,
                  uint64_t* out) = nullptr;
};

/// `here`: the part in this program's memory; its tree may be any. Throw Error (device).
template <class Real>
Tally tally_on_device(const DeviceMethods<Real>& methods, const std::byte* functor, const Setup<Real>& here,
                      uint64_t place, uint64_t count);
template <class Real>
std::vector<uint64_t> words_on_device(const DeviceMethods<Real>& methods, const std::byte* functor,
                                      const Setup<Real>& here, uint64_t count);

}  // namespace cistula::verify
