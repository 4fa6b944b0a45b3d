// The functions of the CUDA backend in builds that have none.
#include "backend_cuda/host/cuda_renderer.h"
#include "base/error.h"

namespace cistula {
namespace {

[[noreturn]] void fail_without_cuda() {
    throw Error(ErrorKind::device, "this build has no CUDA backend", "`backend` embree renders on the CPU")
        .of("backend", "cuda");
}

}  // namespace

bool has_cuda_backend() {
    return false;
}

std::vector<CudaDevice> list_cuda_devices() {
    fail_without_cuda();
}

void begin_cuda_devices(const std::vector<int>&) {
    fail_without_cuda();
}

std::string cuda_driver_version() {
    fail_without_cuda();
}

template <class Real>
std::unique_ptr<Renderer> make_cuda_renderer(std::shared_ptr<const CompiledScene<Real>>, const CudaOptions&) {
    fail_without_cuda();
}

template std::unique_ptr<Renderer> make_cuda_renderer<float>(std::shared_ptr<const CompiledScene<float>>,
                                                             const CudaOptions&);
template std::unique_ptr<Renderer> make_cuda_renderer<double>(std::shared_ptr<const CompiledScene<double>>,
                                                              const CudaOptions&);

}  // namespace cistula
