// From a mask's index to its kernels, which are compiled apart.
#include <utility>

#include "backend_cuda/frame_kernels.cuh"

namespace cistula {

#define CISTULA_ELSEWHERE(mask)                                                                   \
    extern template void launch_mask<float, mask>(DevicePath, Pass, const DeviceScene<float>&, const FrameJob&, cudaStream_t); \
    extern template void launch_mask<double, mask>(DevicePath, Pass, const DeviceScene<double>&, const FrameJob&, cudaStream_t);
CISTULA_ELSEWHERE(0)
CISTULA_ELSEWHERE(1)
CISTULA_ELSEWHERE(2)
CISTULA_ELSEWHERE(3)
#undef CISTULA_ELSEWHERE
static_assert(effect_mask_count == 4, "name the new masks above and in CMakeLists.txt");

template <class Real>
size_t queued_branch_bytes(DevicePath path) {
    return path == DevicePath::plain_loop
               ? sizeof(QueuedBranch<Real, typename PathTraits<Real, DevicePath::plain_loop>::Intersector::Media>)
               : sizeof(QueuedBranch<Real, typename PathTraits<Real, DevicePath::tree>::Intersector::Media>);
}

template <class Real>
void launch(Pass pass, int mask, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job, cudaStream_t stream) {
    using Launch = void (*)(DevicePath, Pass, const DeviceScene<Real>&, const FrameJob&, cudaStream_t);
    static constexpr Launch table[effect_mask_count] = {launch_mask<Real, 0>, launch_mask<Real, 1>, launch_mask<Real, 2>,
                                                        launch_mask<Real, 3>};
    table[mask](path, pass, scene, job, stream);
}

template size_t queued_branch_bytes<float>(DevicePath);
template size_t queued_branch_bytes<double>(DevicePath);
template void launch(Pass, int, DevicePath, const DeviceScene<float>&, const FrameJob&, cudaStream_t);
template void launch(Pass, int, DevicePath, const DeviceScene<double>&, const FrameJob&, cudaStream_t);

}  // namespace cistula
