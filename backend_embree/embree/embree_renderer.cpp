#include "backend_embree/embree/embree_renderer.h"

#include "backend_embree/embree/embree_tree.h"
#include "backend_embree/host/frame_loop.h"

namespace cistula {

template <class Real>
inline constexpr bool fills_film_layers<EmbreeIntersector<Real>> = true;

namespace {

template <class Real>
class EmbreeRenderer : public Renderer {
  public:
    EmbreeRenderer(std::shared_ptr<const CompiledScene<Real>> scene, std::shared_ptr<const EmbreeTree<Real>> tree)
        : scene_(std::move(scene)), view_(scene_->view()), tree_(std::move(tree)) {
        if (tree_) return;
        plain_ = make_constant_renderer<Real>(scene_);
        if (!plain_) tree_ = embree_tree(view_, EmbreeOptions{.always_tree = true});
    }

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        used_plain_ = plain_ && !settings.layers.any();
        if (used_plain_) return plain_->render(camera, settings, film, progress);
        if (!tree_) tree_ = embree_tree(view_, EmbreeOptions{.always_tree = true});
        const EmbreeIntersector<Real> intersector{view_, tree_->scene()};
        FrameTask task(*scene_, intersector, camera, settings, film, progress);
        effects_ = task.effects();
        return task.run();
    }
    uint32_t effects() const override { return used_plain_ ? plain_->effects() : effects_; }
    int lanes() const override { return used_plain_ ? plain_->lanes() : 1; }
    std::string intersector() const override { return "embree"; }
    size_t memory() const override { return tree_ ? scene_->memory() + tree_->memory() : plain_->memory(); }

  private:
    std::shared_ptr<const CompiledScene<Real>> scene_;
    SceneView<Real> view_;
    std::shared_ptr<const EmbreeTree<Real>> tree_;
    std::unique_ptr<Renderer> plain_;  // set if a loop over few primitives replaces the tree, which layers need
    bool used_plain_ = false;          // for the last frame
    uint32_t effects_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               const EmbreeOptions& options) {
    std::shared_ptr<const EmbreeTree<Real>> tree = embree_tree(scene->view(), options);
    return make_embree_renderer(std::move(scene), std::move(tree));
}

template <class Real>
std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               std::shared_ptr<const EmbreeTree<Real>> tree) {
    return std::make_unique<EmbreeRenderer<Real>>(std::move(scene), std::move(tree));
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
