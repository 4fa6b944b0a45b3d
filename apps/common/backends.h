// The backends that programs offer by name: what this build has, which GPUs it may use, and a renderer on them.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "backend_cuda/host/cuda_renderer.h"
#include "scene/compile/compiled_scene.h"
#include "scene/film/renderer.h"

namespace cistula {

enum class Backend { embree, cuda };

/// "embree" or "cuda", what --backend says. Throws Error (usage).
Backend parse_backend(const std::string& text);
const char* backend_name(Backend backend);

/// "exact" or "native", what --intersector says. Throws Error (usage), also for native on another backend than Embree.
Intersection parse_intersection(const std::string& text, Backend backend);

/// What --device says: these GPUs, or all that can be used.
struct DeviceChoice {
    bool all = false;
    std::vector<int> indices = {0};
};

/// "0,2" or "all"; empty: the default. Throws Error (usage), as for any choice where the backend is not CUDA.
DeviceChoice parse_devices(const std::string& text, Backend backend);

/// The GPUs that a program runs on, and how records name them. All empty where the backend is not CUDA.
struct ChosenDevices {
    CudaOptions options;
    std::vector<std::string> names;
    std::string driver;  // the CUDA version that it supports
};

/// Throws Error (device) where this build or this machine does not have what was asked for: early, before a scene is
/// compiled.
ChosenDevices choose_devices(Backend backend, const DeviceChoice& choice);

/// Those of `present` that were chosen. Throws Error (device) where one is not there or cannot be used.
std::vector<CudaDevice> pick_devices(const DeviceChoice& choice, const std::vector<CudaDevice>& present);

/// What --list-devices prints: a line for each GPU, or one that says why there is none.
std::string list_devices_text();
std::string list_devices_text(const std::vector<CudaDevice>& devices);

/// Throws Error (device) where this build does not have the backend. Never another one instead. Native intersection is
/// Embree's: parse_intersection refuses it for any other.
template <class Real>
std::unique_ptr<Renderer> make_renderer(Backend backend, std::shared_ptr<const CompiledScene<Real>> scene,
                                        const CudaOptions& options, Intersection intersection = Intersection::exact);

/// Whether this build has the CUDA backend; whether this machine has a GPU is another question.
bool has_cuda_backend();

}  // namespace cistula
