// A compiled scene as Python holds it, with renderers that wait for the next call.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "render/renderer.h"
#include "render/scene.h"
#include "sequence/backends.h"

namespace cistula::python {

/// Immutable, but for the renderers: one of each kind is kept, and calls at the same time make more.
class SceneHandle {
  public:
    SceneHandle(std::shared_ptr<const SceneDescription> description, Scene scene)
        : description_(std::move(description)), scene_(std::move(scene)) {}

    const SceneDescription& description() const { return *description_; }
    const Scene& scene() const { return scene_; }

  private:
    friend class LentRenderer;
    std::shared_ptr<const SceneDescription> description_;
    Scene scene_;
    std::mutex mutex_;
    std::map<std::string, std::unique_ptr<Renderer>> idle_;
};

/// A renderer of a scene, which goes back there.
class LentRenderer {
  public:
    /// Throws Error.
    LentRenderer(std::shared_ptr<SceneHandle> scene, Backend backend, const DeviceChoice& devices);
    ~LentRenderer();
    LentRenderer(const LentRenderer&) = delete;
    LentRenderer& operator=(const LentRenderer&) = delete;

    Renderer& operator*() const { return *renderer_; }

  private:
    std::shared_ptr<SceneHandle> scene_;
    std::string key_;
    std::unique_ptr<Renderer> renderer_;
};

}  // namespace cistula::python
