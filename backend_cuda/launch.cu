// From a mask's index to its kernels, which are compiled apart.
#include <utility>

#include "backend_cuda/frame_kernels.cuh"

namespace cistula {

#define CISTULA_ELSEWHERE(mask)                                                                   \
    extern template void launch_mask<float, mask>(DevicePath, bool, const FrameJob<float>&, cudaStream_t); \
    extern template void launch_mask<double, mask>(DevicePath, bool, const FrameJob<double>&, cudaStream_t);
CISTULA_ELSEWHERE(0)
CISTULA_ELSEWHERE(1)
CISTULA_ELSEWHERE(2)
CISTULA_ELSEWHERE(3)
#undef CISTULA_ELSEWHERE
static_assert(effect_mask_count == 4, "name the new masks above and in CMakeLists.txt");

namespace {

template <class Real>
void launch(int mask, DevicePath path, bool branches, const FrameJob<Real>& job, cudaStream_t stream) {
    using Launch = void (*)(DevicePath, bool, const FrameJob<Real>&, cudaStream_t);
    static constexpr Launch table[effect_mask_count] = {launch_mask<Real, 0>, launch_mask<Real, 1>, launch_mask<Real, 2>,
                                                        launch_mask<Real, 3>};
    table[mask](path, branches, job, stream);
}

}  // namespace

template <class Real>
size_t queued_branch_bytes(DevicePath path) {
    return path == DevicePath::plain_loop
               ? sizeof(QueuedBranch<Real, typename PathTraits<Real, DevicePath::plain_loop>::Intersector::Media>)
               : sizeof(QueuedBranch<Real, typename PathTraits<Real, DevicePath::tree>::Intersector::Media>);
}

template <class Real>
void launch_pixels(int mask, DevicePath path, const FrameJob<Real>& job, cudaStream_t stream) {
    launch(mask, path, false, job, stream);
}
template <class Real>
void launch_branches(int mask, DevicePath path, const FrameJob<Real>& job, cudaStream_t stream) {
    launch(mask, path, true, job, stream);
}

template size_t queued_branch_bytes<float>(DevicePath);
template size_t queued_branch_bytes<double>(DevicePath);
template void launch_pixels(int, DevicePath, const FrameJob<float>&, cudaStream_t);
template void launch_pixels(int, DevicePath, const FrameJob<double>&, cudaStream_t);
template void launch_branches(int, DevicePath, const FrameJob<float>&, cudaStream_t);
template void launch_branches(int, DevicePath, const FrameJob<double>&, cudaStream_t);

}  // namespace cistula
