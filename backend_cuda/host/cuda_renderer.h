// The GPU backend: libcore's traversal and shading on NVIDIA GPUs. It never falls back to the CPU. In builds without
// it, functions of these names throw Error (device), which says so (sequence/without_cuda.cpp).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// Whether this build has the CUDA backend, independent of GPUs in this machine.
bool has_cuda_backend();

/// A GPU with the driver's number. `obstacle` is empty if this build's kernels run on it, else it says why not.
struct CudaDevice {
    int index = 0;
    std::string name;
    // compute capability
    int major = 0;
    int minor = 0;
    size_t memory = 0;  // bytes
    int multiprocessors = 0;
    std::string obstacle;
};

/// All GPUs of this machine. Throws Error (device) if there is none (no driver, a driver too old, no device), or if
/// this build has not every kernel.
std::vector<CudaDevice> list_cuda_devices();

/// Makes the contexts of devices, which renderers else make one after the other. Throws Error (device) where it cannot.
void begin_cuda_devices(const std::vector<int>& devices);

/// The CUDA version that the driver supports, such as "13.0", for records.
std::string cuda_driver_version();

struct CudaOptions {
    std::vector<int> devices = {0};  // CudaDevice::index; they share frames or take turns
    // The following options never change the image.
    size_t memory_limit = 0;   // bytes of device memory for pixels; 0: all that is free
    bool always_tree = false;  // use a tree even where a plain loop is faster; for tests
};

/// A renderer on GPUs, to which it uploads the scene. Throws Error (device) with CUDA's message if a device cannot be
/// used.
template <class Real>
std::unique_ptr<Renderer> make_cuda_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             const CudaOptions& options = {});

}  // namespace cistula
