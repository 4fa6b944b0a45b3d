// Functors of rays, and how they run on devices. A functor is a trivially copyable struct, its members the parameters
// of a part, with one of
//     template <class Real, class Tracer>
//     CISTULA_HD void operator()(const Setup<Real>&, const Tracer& intersector, uint64_t i, Tally&) const;
//     template <class Real>
//     CISTULA_HD void operator()(const Setup<Real>&, uint64_t i, Tally&) const;   // asks no intersector
//     template <class Real, class Tracer>
//     CISTULA_HD uint64_t fingerprint(const Setup<Real>&, const Tracer& intersector, uint64_t i) const;
// The last gives a word a ray that must be the same on all intersectors as from a plain loop over all primitives on the
// host.
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#include "verify/setup.h"

namespace cistula::verify {

template <class Functor>
concept AsksNothing = requires(const Functor& functor, const Setup<double>& setup, Tally& tally) {
    functor(setup, uint64_t(0), tally);
};
template <class Functor>
concept HasWords = requires(const Functor& functor, const Setup<double>& setup) {
    functor.fingerprint(setup, BvhIntersector<double>{setup.scene}, uint64_t(0));
};

template <class Functor, class Real, class Tracer>
CISTULA_HD inline void call(const Functor& functor, const Setup<Real>& setup, const Tracer& intersector, uint64_t i,
                            Tally& tally) {
    if constexpr (AsksNothing<Functor>)
        functor(setup, i, tally);
    else
        functor(setup, intersector, i, tally);
}

template <class Functor>
Functor functor_of(const std::byte* bytes) {
    Functor functor;
    std::memcpy(static_cast<void*>(&functor), bytes, sizeof(Functor));
    return functor;
}

/// Launches a functor's kernel. `setup` and `out` are in device memory; `functor` in host memory.
template <class Real>
struct DeviceMethods {
    void (*tally)(const std::byte* functor, const Setup<Real>& setup, uint64_t place, uint64_t count,
                  Tally* out) = nullptr;
    void (*words)(const std::byte* functor, const Setup<Real>& setup, uint64_t first, uint64_t count,
                  uint64_t* out) = nullptr;
};

/// The launchers of a functor. Defined in device_cases.cu for those that it lists.
template <class Functor, class Real>
DeviceMethods<Real> device_methods();

/// Runs a functor on the device. `here`: the part in host memory, with any tree. Throws Error (device).
template <class Real>
Tally tally_on_device(const DeviceMethods<Real>& methods, const std::byte* functor, const Setup<Real>& here,
                      uint64_t place, uint64_t count);
template <class Real>
std::vector<uint64_t> words_on_device(const DeviceMethods<Real>& methods, const std::byte* functor,
                                      const Setup<Real>& here, uint64_t count);

}  // namespace cistula::verify
