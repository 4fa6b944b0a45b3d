// Launches kernels, which are compiled separately, by the index of their mask.
#include <array>
#include <utility>

#include "backend_cuda/kernels/frame_job.h"

namespace cistula {
namespace {

template <class Real>
using Launch = void (*)(Sampling, DevicePath, const DeviceScene<Real>&, const FrameJob&, cudaStream_t);

/// The launch of a mask's kernels, if this build has them.
template <class Real, int mask>
constexpr Launch<Real> compiled_launch() {
    if constexpr (CISTULA_EVERY_KERNEL || (mask == layered_mask && sizeof(Real) == sizeof(float)))
        return &launch_mask<Real, mask>;
    else
        return nullptr;
}

}  // namespace

template <class Real>
void launch(Sampling sampling, int mask, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
            cudaStream_t stream) {
    static constexpr auto table = []<int... m>(std::integer_sequence<int, m...>) {
        return std::array<Launch<Real>, sizeof...(m)>{compiled_launch<Real, m>()...};
    }
    (std::make_integer_sequence<int, compiled_mask_count>());
    table[size_t(mask)](sampling, path, scene, job, stream);
}

template void launch(Sampling, int, DevicePath, const DeviceScene<float>&, const FrameJob&, cudaStream_t);
template void launch(Sampling, int, DevicePath, const DeviceScene<double>&, const FrameJob&, cudaStream_t);

}  // namespace cistula
