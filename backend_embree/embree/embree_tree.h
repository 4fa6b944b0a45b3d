// Embree's device, with its memory counted and its errors turned into Error, and its tree over a scene's primitives.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "backend_embree/embree/embree_intersector.h"
#include "backend_embree/embree/embree_renderer.h"
#include "scene/trees/embree_handles.h"

namespace cistula {

class EmbreeDevice {
  public:
    /// Makes a device. Throws Error (device) if Embree does not accept the configuration.
    explicit EmbreeDevice(const std::string& config);
    EmbreeDevice(const EmbreeDevice&) = delete;
    EmbreeDevice& operator=(const EmbreeDevice&) = delete;

    RTCDevice get() const { return device_.get(); }
    size_t memory() const { return size_t(memory_.load()); }  // bytes that the device holds now

    /// Throws Error (device) or std::bad_alloc if anything has failed since the last call; `doing` is for the message.
    void check(const char* doing) const;

  private:
    std::atomic<ssize_t> memory_{0};  // declared first: the device counts in it until it is destroyed
    DevicePointer device_;
};

/// Embree's device and scene for a SceneView. Throws Error (device) with Embree's message.
template <class Real>
class EmbreeTree {
  public:
    EmbreeTree(const SceneView<Real>& scene, const EmbreeOptions& options);
    EmbreeTree(const EmbreeTree&) = delete;
    EmbreeTree& operator=(const EmbreeTree&) = delete;

    RTCScene scene() const { return scene_.get(); }
    size_t memory() const { return device_.memory(); }

  private:
    void build(const SceneView<Real>& scene, const EmbreeOptions& options);

    EmbreeDevice device_;
    ScenePointer scene_;
};

}  // namespace cistula
