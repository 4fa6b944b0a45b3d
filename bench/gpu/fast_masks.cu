// gpu_check_fast times one scene: the kernels of masks that it does not call for are left out.
#include "backend_cuda/frame_kernels.cuh"

namespace cistula {

// Their resources are of no interest either.
#define CISTULA_LEFT_OUT_IN(real, mask)                                                                             \
    template <>                                                                                                     \
    void launch_mask<real, mask>(DevicePath, Pass, const DeviceScene<real>&, const FrameJob&, cudaStream_t) {       \
        throw Error(ExitCode::failed, "mask " #mask " of effects is not in this program: only the benchmark's, 3"); \
    }                                                                                                               \
    template <>                                                                                                     \
    void list_resources_of_mask<real, mask>(std::vector<KernelResources>&) {}
#define CISTULA_LEFT_OUT(mask)       \
    CISTULA_LEFT_OUT_IN(float, mask) \
    CISTULA_LEFT_OUT_IN(double, mask)
CISTULA_LEFT_OUT(0)
CISTULA_LEFT_OUT(1)
CISTULA_LEFT_OUT(2)
CISTULA_LEFT_OUT(4)
CISTULA_LEFT_OUT(5)
CISTULA_LEFT_OUT(6)
CISTULA_LEFT_OUT(7)
#undef CISTULA_LEFT_OUT
#undef CISTULA_LEFT_OUT_IN
static_assert(compiled_mask_count == 8, "leave the new masks out above");

}  // namespace cistula
