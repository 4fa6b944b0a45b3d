// gpu_check_fast times one scene: the kernels of masks that it does not call for are left out.
#include "backend_cuda/frame_kernels.cuh"

namespace cistula {

#define CISTULA_LEFT_OUT(real, mask)                                                                                \
    template <>                                                                                                     \
    void launch_mask<real, mask>(DevicePath, Pass, const DeviceScene<real>&, const FrameJob&, cudaStream_t) {       \
        throw Error(ExitCode::failed, "mask " #mask " of effects is not in this program: only the benchmark's, 1"); \
    }
CISTULA_LEFT_OUT(float, 0)
CISTULA_LEFT_OUT(float, 2)
CISTULA_LEFT_OUT(float, 3)
CISTULA_LEFT_OUT(double, 0)
CISTULA_LEFT_OUT(double, 2)
CISTULA_LEFT_OUT(double, 3)
#undef CISTULA_LEFT_OUT

}  // namespace cistula
