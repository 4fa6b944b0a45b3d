// The backends that programs offer by name: those of this build, the GPUs to use, and renderers on them.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "backend_cuda/host/cuda_renderer.h"
#include "render/renderer.h"
#include "render/scene.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

enum class Backend { embree, cuda };

/// The names of backends, in their order.
inline constexpr std::string_view backend_names[] = {"embree", "cuda"};
constexpr const char* backend_name(Backend backend) {
    return backend_names[static_cast<size_t>(backend)].data();
}

/// The GPUs named by --device: a list, or all usable ones.
struct DeviceChoice {
    bool all = false;
    std::vector<int> indices = {0};
};

/// Parses "0,2" or "all". Throws Error (usage): what would be right, for any text if the backend is not CUDA.
DeviceChoice parse_devices(const std::string& text, Backend backend);
std::string devices_text(const DeviceChoice& choice);

/// The GPUs that a program runs on, and their names for records. All empty if the backend is not CUDA.
struct ChosenDevices {
    CudaOptions options;
    std::vector<std::string> names;
    std::string driver;  // the latest CUDA version that it supports
};

/// The devices to run on, whose contexts it makes, all at once. Throws Error (device) if this build or this machine
/// lacks them. It takes a good part of a second, so it may be called on a thread of its own while the scene is read.
ChosenDevices choose_devices(Backend backend, const DeviceChoice& choice);

/// The chosen GPUs among `present`. Throws Error (device) if one is missing or unusable.
std::vector<CudaDevice> pick_devices(const DeviceChoice& choice, const std::vector<CudaDevice>& present);

/// The output of --list-devices: a line for each GPU, or one that says why there is none.
std::string list_devices_text();
std::string list_devices_text(const std::vector<CudaDevice>& devices);

/// A renderer on the backend, never on another one. Throws Error (device) if this build lacks the backend.
template <class Real>
std::unique_ptr<Renderer> make_renderer(Backend backend, std::shared_ptr<const CompiledScene<Real>> scene,
                                        const CudaOptions& options);

/// A renderer of a scene. One that keys change is compiled again, and goes to the devices whole, for each frame.
std::unique_ptr<Renderer> make_renderer(Backend backend, const Scene& scene, const CudaOptions& options);

/// The reason why a frame that the renderer made of the scene is unreliable, for a message: describe_flags, with the
/// solids around one ray where they are too many. It renders parts of the frame again to find that ray.
std::string describe_flags(uint32_t flags, Renderer& renderer, const SceneDescription& scene, Precision precision,
                           const CameraFrame& camera, FrameSettings settings);

}  // namespace cistula
