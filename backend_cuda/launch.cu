// From a mask's index to its kernels, which are compiled apart.
#include <array>
#include <utility>

#include "backend_cuda/frame_kernels.cuh"

namespace cistula {

#define CISTULA_ELSEWHERE_IN(real, mask)                                                                      \
    extern template void list_resources_of_mask<real, mask>(std::vector<KernelResources>&);                   \
    extern template void launch_mask<real, mask>(DevicePath, Pass, const DeviceScene<real>&, const FrameJob&, \
                                                 cudaStream_t);
#define CISTULA_ELSEWHERE(mask)       \
    CISTULA_ELSEWHERE_IN(float, mask) \
    CISTULA_ELSEWHERE_IN(double, mask)
CISTULA_ELSEWHERE(0)
CISTULA_ELSEWHERE(1)
CISTULA_ELSEWHERE(2)
CISTULA_ELSEWHERE(3)
CISTULA_ELSEWHERE(4)
CISTULA_ELSEWHERE(5)
CISTULA_ELSEWHERE(6)
CISTULA_ELSEWHERE(7)
#undef CISTULA_ELSEWHERE
#undef CISTULA_ELSEWHERE_IN
static_assert(compiled_mask_count == 8, "name the new masks above and in CMakeLists.txt");

template <class Real>
size_t queued_branch_bytes(DevicePath path) {
    using Largest = Effects<all_effects>;
    using Loop = typename PathTraits<Real, Largest, DevicePath::plain_loop>::Intersector::Media;
    using Tree = typename PathTraits<Real, Largest, DevicePath::tree>::Intersector::Media;
    return path == DevicePath::plain_loop ? sizeof(QueuedBranch<BranchOf<Real, Largest, Loop>>)
                                          : sizeof(QueuedBranch<BranchOf<Real, Largest, Tree>>);
}

template <class Real>
void launch(Pass pass, int mask, DevicePath path, const DeviceScene<Real>& scene, const FrameJob& job,
            cudaStream_t stream) {
    using Launch = void (*)(DevicePath, Pass, const DeviceScene<Real>&, const FrameJob&, cudaStream_t);
    static constexpr auto table = []<int... m>(std::integer_sequence<int, m...>) {
        return std::array<Launch, sizeof...(m)>{&launch_mask<Real, m>...};
    }
    (std::make_integer_sequence<int, compiled_mask_count>());
    table[size_t(mask)](path, pass, scene, job, stream);
}

std::vector<KernelResources> kernel_resources() {
    std::vector<KernelResources> list;
    [&]<int... m>(std::integer_sequence<int, m...>) {
        (list_resources_of_mask<float, m>(list), ...);
        (list_resources_of_mask<double, m>(list), ...);
    }
    (std::make_integer_sequence<int, compiled_mask_count>());
    return list;
}

template size_t queued_branch_bytes<float>(DevicePath);
template size_t queued_branch_bytes<double>(DevicePath);
template void launch(Pass, int, DevicePath, const DeviceScene<float>&, const FrameJob&, cudaStream_t);
template void launch(Pass, int, DevicePath, const DeviceScene<double>&, const FrameJob&, cudaStream_t);

}  // namespace cistula
