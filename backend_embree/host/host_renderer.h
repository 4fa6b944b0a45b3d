// A Renderer over an intersector that needs only a form of the scene: a SceneView or a ConstantScene.
#pragma once

#include "backend_embree/embree/embree_renderer.h"
#include "backend_embree/host/frame_loop.h"
#include "scene/compile/lane_scene.h"

namespace cistula {

template <class Real, class Intersector>
class HostRenderer : public Renderer {
  public:
    using Form = typename Intersector::Scene;

    /// `in_lanes`: the form in which rays may be traced in lanes, if any.
    HostRenderer(std::shared_ptr<const CompiledScene<Real>> scene, std::unique_ptr<const Form> form, const char* name,
                 std::unique_ptr<const OwnedLaneScene<Real>> in_lanes = nullptr)
        : scene_(std::move(scene)), form_(std::move(form)), name_(name), in_lanes_(std::move(in_lanes)) {}

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        const Intersector intersector{*form_};
        FrameTask task(*scene_, intersector, camera, settings, film, progress,
                       in_lanes_ ? &in_lanes_->scene() : nullptr);
        effects_ = task.effects();
        lanes_ = task.lanes();
        return task.run();
    }
    uint32_t effects() const override { return effects_; }
    int lanes() const override { return lanes_; }
    std::string intersector() const override { return name_; }
    size_t memory() const override { return scene_->memory() + sizeof(Form) + (in_lanes_ ? in_lanes_->memory() : 0); }

  private:
    std::shared_ptr<const CompiledScene<Real>> scene_;
    std::unique_ptr<const Form> form_;  // of *scene_
    const char* name_;
    std::unique_ptr<const OwnedLaneScene<Real>> in_lanes_;
    uint32_t effects_ = 0;
    int lanes_ = 1;
};

}  // namespace cistula
