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

/// What a kernel takes of this thread's current device.
struct KernelResources {
    const char* name;              // "render_pixels", ...
    const char *precision, *path;  // "float", "double"; "loop", "tree"
    uint32_t mask;                 // of effects
    int registers;                 // of a thread
    size_t local_bytes;            // of a thread: its stack of branches, and what found no register
    int blocks;                    // that share a multiprocessor
    double occupancy;              // their threads, as a share of those that a multiprocessor has room for
};

/// What all kernels in this program take. Throws Error (device).
std::vector<KernelResources> kernel_resources();

/// Uploads the scene. Throws Error (device) with CUDA's own words where a device cannot be used.
template <class Real>
std::unique_ptr<Renderer> make_cuda_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             const CudaOptions& options = {});

}  // namespace cistula
