#include "backend_embree/embree/embree_renderer.h"

#include "backend_embree/embree/embree_tree.h"
#include "backend_embree/host/frame_loop.h"
#include "scene/compile/lane_scene.h"

namespace cistula {

template <class Real>
inline constexpr bool fills_film_layers<EmbreeIntersector<Real>> = true;

namespace {

template <class Real>
class EmbreeRenderer : public Renderer {
  public:
    EmbreeRenderer(std::shared_ptr<const CompiledScene<Real>> scene, const EmbreeOptions& options,
                   std::shared_ptr<const EmbreeTree<Real>> tree)
        : scene_(std::move(scene)), view_(scene_->view()), options_(options), tree_(std::move(tree)) {
        if (!tree_ && !options.always_tree) in_lanes_ = lane_scene(view_);
        if (!tree_ && !in_lanes_) build_tree();
    }

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        EmbreeIntersector<Real> intersector{view_, tree_ ? tree_->scene() : nullptr};
        FrameTask task(*scene_, intersector, camera, settings, film, progress,
                       in_lanes_ ? &in_lanes_->scene() : nullptr);
        effects_ = task.effects();
        lanes_ = task.lanes();
        if (lanes_ == 1 && !tree_) {
            build_tree();
            intersector.tree = tree_->scene();
        }
        return task.run();
    }
    uint32_t effects() const override { return effects_; }
    int lanes() const override { return lanes_; }
    std::string intersector() const override { return "embree"; }
    size_t memory() const override {
        return scene_->memory() + (in_lanes_ ? in_lanes_->memory() : 0) + (tree_ ? tree_->memory() : 0);
    }

  private:
    void build_tree() { tree_ = std::make_shared<const EmbreeTree<Real>>(view_, options_); }

    std::shared_ptr<const CompiledScene<Real>> scene_;
    SceneView<Real> view_;
    EmbreeOptions options_;
    std::shared_ptr<const EmbreeTree<Real>> tree_;  // built when a frame needs it, or before all if every frame does
    std::unique_ptr<const OwnedLaneScene<Real>> in_lanes_;  // set if rays may be traced in lanes
    // Of the last frame:
    uint32_t effects_ = 0;
    int lanes_ = 1;
};

}  // namespace

template <class Real>
std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               const EmbreeOptions& options) {
    return std::make_unique<EmbreeRenderer<Real>>(std::move(scene), options, nullptr);
}

template <class Real>
std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               std::shared_ptr<const EmbreeTree<Real>> tree) {
    return std::make_unique<EmbreeRenderer<Real>>(std::move(scene), EmbreeOptions(), std::move(tree));
}

template std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<float>>,
                                                        const EmbreeOptions&);
template std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<double>>,
                                                        const EmbreeOptions&);
template std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<float>>,
                                                        std::shared_ptr<const EmbreeTree<float>>);
template std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<double>>,
                                                        std::shared_ptr<const EmbreeTree<double>>);

}  // namespace cistula
