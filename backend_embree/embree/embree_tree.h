// Embree's device and its tree over a scene's primitives.
#pragma once

#include <memory>

#include "backend_embree/embree/embree_device.h"
#include "backend_embree/embree/embree_intersector.h"
#include "backend_embree/embree/embree_renderer.h"

namespace cistula {

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
