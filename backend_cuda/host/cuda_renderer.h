// The GPU backend: libcore's traversal and kernel body on NVIDIA GPUs. Never another processor instead.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "scene/compile/compiled_scene.h"
#include "scene/film/renderer.h"

namespace cistula {

/// A GPU as the driver numbers it. `obstacle` is empty where this build's kernels run on it.
struct CudaDevice {
    int index = 0;
    std::string name;
    int major = 0, minor = 0;  // compute capability
    size_t memory = 0;         // bytes
    int multiprocessors = 0;
    std::string obstacle;
};

/// All GPUs of this machine. Throws Error (device) where there is none: no driver, a driver too old, no device.
std::vector<CudaDevice> list_cuda_devices();

/// The version that the driver supports, "13.0"; for records.
std::string cuda_driver_version();

struct CudaOptions {
    std::vector<int> devices = {0};  // CudaDevice::index; all share every frame, by interleaved tiles
    // None of these changes the image:
    size_t memory_limit = 0;   // bytes of a device that pixels may take; 0: what is free
    bool always_tree = false;  // a tree even where a plain loop would do; for tests
};

/// Uploads the scene. Throws Error (device) with CUDA's own words where a device cannot be used.
template <class Real>
std::unique_ptr<Renderer> make_cuda_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             const CudaOptions& options = {});

}  // namespace cistula
