// The GPUs of this machine.
#include <fmt/format.h>

#include <future>

#include "backend_cuda/host/cuda_check.h"
#include "backend_cuda/host/cuda_renderer.h"

namespace cistula {
namespace {

[[noreturn]] void fail_no_device(cudaError_t error) {
    const char* advice =
        "check that an NVIDIA GPU and its driver are installed (nvidia-smi); `backend` embree renders on the CPU";
    if (error == cudaErrorInsufficientDriver || error == cudaErrorSystemDriverMismatch)
        advice =
            "install an NVIDIA driver, or a newer one, for this version of CUDA; `backend` embree renders on the CPU";
    throw Error(ErrorKind::device, std::string("no usable GPU: ") + cudaGetErrorString(error), advice);
}

/// The compute capabilities that this build's kernels run on, such as "7.5 or later".
std::string kernel_architectures() {
    return fmt::format("{}.{} or later", CISTULA_LEAST_CAPABILITY / 10, CISTULA_LEAST_CAPABILITY % 10);
}

bool kernels_run_on_capability(int capability) {
    return capability >= CISTULA_LEAST_CAPABILITY;  // the PTX of the lowest capability runs on every later GPU
}

}  // namespace

bool has_cuda_backend() {
    return true;
}

std::vector<CudaDevice> list_cuda_devices() {
    if (!CISTULA_EVERY_KERNEL)
        throw Error(ErrorKind::device, "this build has one kernel of many, to see that it compiles, and uses no GPU",
                    "make with CUDA=yes, or CMake with -DCISTULA_EVERY_KERNEL=ON, builds all; `backend` embree renders "
                    "on the CPU");
    int count = 0;
    const cudaError_t error = cudaGetDeviceCount(&count);
    if (error != cudaSuccess) fail_no_device(error);
    if (count == 0) fail_no_device(cudaErrorNoDevice);
    std::vector<CudaDevice> devices;
    for (int i = 0; i < count; ++i) {
        cudaDeviceProp properties;
        CISTULA_CUDA_CHECK(cudaGetDeviceProperties(&properties, i));
        CudaDevice device;
        device.index = i;
        device.name = properties.name;
        device.major = properties.major;
        device.minor = properties.minor;
        device.memory = properties.totalGlobalMem;
        device.multiprocessors = properties.multiProcessorCount;
        if (!kernels_run_on_capability(10 * properties.major + properties.minor))
            device.obstacle = fmt::format("its compute capability is {}.{}; this build needs {}", properties.major,
                                          properties.minor, kernel_architectures());
        devices.push_back(std::move(device));
    }
    return devices;
}

void begin_cuda_devices(const std::vector<int>& devices) {
    std::vector<std::future<void>> begun;
    for (const int device : devices)
        begun.push_back(std::async(std::launch::async, [device] {
            CISTULA_CUDA_CHECK(cudaSetDevice(device));
            CISTULA_CUDA_CHECK(cudaFree(nullptr));  // before CUDA 12 the first call makes the context
        }));
    for (std::future<void>& device : begun) device.get();
}

std::string cuda_driver_version() {
    int version = 0;
    if (cudaDriverGetVersion(&version) != cudaSuccess || version == 0) return "none";
    return fmt::format("{}.{}", version / 1000, version % 1000 / 10);
}

}  // namespace cistula
