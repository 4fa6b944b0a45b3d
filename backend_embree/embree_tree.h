// Embree's device and its tree over a scene's primitives.
#pragma once

#include <atomic>
#include <string>

#include "backend_embree/embree_intersector.h"
#include "backend_embree/embree_renderer.h"

namespace cistula {

/// Owns the device and the scene. Throws Error (device) with Embree's words.
template <class Real>
class EmbreeTree {
  public:
    EmbreeTree(const SceneView<Real>& scene, const EmbreeOptions& options);
    EmbreeTree(const EmbreeTree&) = delete;
    EmbreeTree& operator=(const EmbreeTree&) = delete;

    RTCScene scene() const { return scene_.get(); }
    size_t memory() const { return size_t(memory_.load()); }

  private:
    std::atomic<ssize_t> memory_{0};  // first, since the device counts in it until it is gone
    DevicePointer device_;
    ScenePointer scene_;
};

}  // namespace cistula
