// A scene in a GPU's memory, in the forms that kernels take.
#pragma once

#include <vector>

#include "backend_cuda/host/cuda_resources.h"
#include "backend_cuda/kernels/frame_job.h"
#include "scene/compile/scene_arena.h"

namespace cistula {

/// The path for a scene: where they are few, a loop over primitives is faster than any tree.
template <class Real>
DevicePath path_for(const SceneView<Real>& scene);

template <class Real>
class SceneUpload {
  public:
    /// Copies a scene to the current device. `here`: a view of the arena's scene in host memory.
    SceneUpload(const SceneArena<Real>& scene, const SceneView<Real>& here, DevicePath path, cudaStream_t stream);

    const DeviceScene<Real>& scene() const { return scene_; }
    /// The primitive mask of each solid, as in BlockPlace::in_view; empty where kernels do not use it.
    const std::vector<uint32_t>& primitives() const { return primitives_; }

  private:
    DeviceMemory arena_;
    DeviceScene<Real> scene_;
    std::vector<uint32_t> primitives_;
};

}  // namespace cistula
