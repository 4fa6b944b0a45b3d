// Kernels of cases; each thread takes every 2^16th ray. Included by device_cases.cu.in only.
#pragma once

#include <cstring>

#include "apps/render_verify/case.h"
#include "apps/render_verify/device_run.h"
#include "backend_cuda/host/cuda_check.h"

namespace cistula::verify {

/// The traversal of devices, in functions that kernels call: compiled into each, it would take most of ptxas's time.
template <class Real>
struct CalledTraversal {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const SceneView<Real>& scene;

    CISTULA_HD __noinline__ Hit<Real> closest(const Ray<Real>& ray) const {
        return BvhIntersector<Real>{scene}.closest(ray);
    }
    template <class E>
    CISTULA_HD __noinline__ Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        return BvhIntersector<Real>{scene}.template transmittance<E>(shadow);
    }
};

template <class Case, class Real>
__global__ void __launch_bounds__(device_block)
    tally_rays(const __grid_constant__ Setup<Real> setup, const Case functor, uint64_t place, uint64_t count,
               Tally* out) {
    const uint64_t thread = uint64_t(blockIdx.x) * blockDim.x + threadIdx.x;
    Tally tally;
    for (uint64_t i = thread; i < count; i += device_threads) {
        tally.place = place + i;
        functor(setup, CalledTraversal<Real>{setup.scene}, i, tally);
    }
    out[thread] = tally;
}

template <class Case, class Real>
__global__ void __launch_bounds__(device_block) word_rays(const __grid_constant__ Setup<Real> setup, const Case functor,
                                                          uint64_t first, uint64_t count, uint64_t* out) {
    const uint64_t thread = uint64_t(blockIdx.x) * blockDim.x + threadIdx.x;
    for (uint64_t i = thread; i < count; i += device_threads)
        out[i] = functor.fingerprint(setup, CalledTraversal<Real>{setup.scene}, first + i);
}

template <class Case>
Case functor_of(const std::byte* bytes) {
    Case functor;
    std::memcpy(&functor, bytes, sizeof(Case));
    return functor;
}

template <class Case, class Real>
DeviceMethods<Real> device_methods_of() {
    DeviceMethods<Real> methods;
    if constexpr (ComparedCase<Case>)
        methods.words = [](const std::byte* functor, const Setup<Real>& setup, uint64_t first, uint64_t count,
                           uint64_t* out) {
            word_rays<Case, Real>
                <<<device_threads / device_block, device_block>>>(setup, functor_of<Case>(functor), first, count, out);
            check_cuda(cudaGetLastError(), Case::name);
        };
    else if constexpr (RayCase<Case>)
        methods.tally = [](const std::byte* functor, const Setup<Real>& setup, uint64_t place, uint64_t count,
                           Tally* out) {
            tally_rays<Case, Real>
                <<<device_threads / device_block, device_block>>>(setup, functor_of<Case>(functor), place, count, out);
            check_cuda(cudaGetLastError(), Case::name);
        };
    return methods;
}

/// The launchers of the cases in list order.
template <class Real, class... Cases>
std::vector<DeviceMethods<Real>> device_methods(CaseList<Cases...>) {
    return {device_methods_of<Cases, Real>()...};
}

}  // namespace cistula::verify
