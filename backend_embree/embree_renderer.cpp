#include "backend_embree/embree_renderer.h"

#include "backend_embree/embree_tree.h"
#include "backend_embree/frame_loop.h"

namespace cistula {

namespace {

/// Up to this many primitives a plain loop is faster than any tree.
constexpr uint32_t plain_loop_primitives = 16;

template <class Real>
class EmbreeRenderer : public Renderer {
  public:
    EmbreeRenderer(std::shared_ptr<const CompiledScene<Real>> scene, const EmbreeOptions& options)
        : scene_(std::move(scene)), view_(scene_->view()) {
        if (options.always_tree || view_.convex.size + view_.clusters.size > plain_loop_primitives)
            tree_ = std::make_unique<EmbreeTree<Real>>(view_, options);
    }

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        if (!tree_)
            return render_frame(*scene_, view_, BruteIntersector<Real>{view_}, camera, settings, film, progress,
                                effects_);
        return render_frame(*scene_, view_, EmbreeIntersector<Real>{view_, tree_->scene()}, camera, settings, film,
                            progress, effects_);
    }
    uint32_t effects() const override { return effects_; }
    std::string intersector() const override { return "embree"; }
    size_t memory() const override { return scene_->memory() + (tree_ ? tree_->memory() : 0); }

  private:
    std::shared_ptr<const CompiledScene<Real>> scene_;
    SceneView<Real> view_;
    std::unique_ptr<EmbreeTree<Real>> tree_;
    uint32_t effects_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                               const EmbreeOptions& options) {
    return std::make_unique<EmbreeRenderer<Real>>(std::move(scene), options);
}

template std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<float>>,
                                                        const EmbreeOptions&);
template std::unique_ptr<Renderer> make_embree_renderer(std::shared_ptr<const CompiledScene<double>>,
                                                        const EmbreeOptions&);

}  // namespace cistula
