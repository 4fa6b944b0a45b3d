// Launches kernels, which are compiled separately, by the index of their mask.
#include <array>
#include <utility>

#include "backend_cuda/kernels/frame_job.h"

namespace cistula {

template <class Real>
void launch(Sampling sampling, int mask, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
            cudaStream_t stream) {
    using Launch = void (*)(Sampling, DevicePath, const DeviceScene<Real>&, const FrameJob&, cudaStream_t);
    static constexpr auto table = []<int... m>(std::integer_sequence<int, m...>) {
        return std::array<Launch, sizeof...(m)>{&launch_mask<Real, m>...};
    }
    (std::make_integer_sequence<int, compiled_mask_count>());
    table[size_t(mask)](sampling, path, scene, job, stream);
}

template void launch(Sampling, int, DevicePath, const DeviceScene<float>&, const FrameJob&, cudaStream_t);
template void launch(Sampling, int, DevicePath, const DeviceScene<double>&, const FrameJob&, cudaStream_t);

}  // namespace cistula
