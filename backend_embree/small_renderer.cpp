#include "backend_embree/embree_renderer.h"
#include "backend_embree/frame_loop.h"
#include "scene/shadow_plan.h"

namespace cistula {

namespace {

/// A loop over what a small scene has, as kernels run it: masks reach the primitives' tests, and the shadow plan spares
/// most of them.
template <class Real>
class SmallRenderer : public Renderer {
  public:
    explicit SmallRenderer(std::shared_ptr<const CompiledScene<Real>> scene) : scene_(std::move(scene)) {
        const SceneView<Real> view = scene_->view();
        fits_ = small_.assign(view, view);
        if (fits_) plan_shadows(view, small_.plan);
    }
    bool fits() const { return fits_; }

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        return render_frame<Real>(*scene_, small_, BruteIntersector<Real, OneMedium, SmallScene<Real>>{small_}, camera,
                                  settings, film, progress, effects_);
    }
    uint32_t effects() const override { return effects_; }
    std::string intersector() const override { return "embree"; }
    size_t memory() const override { return scene_->memory() + sizeof small_; }

  private:
    std::shared_ptr<const CompiledScene<Real>> scene_;
    SmallScene<Real> small_;
    bool fits_ = false;
    uint32_t effects_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<Renderer> make_small_renderer(std::shared_ptr<const CompiledScene<Real>> scene) {
    auto renderer = std::make_unique<SmallRenderer<Real>>(std::move(scene));
    if (!renderer->fits()) return nullptr;
    return renderer;
}

template std::unique_ptr<Renderer> make_small_renderer(std::shared_ptr<const CompiledScene<float>>);
template std::unique_ptr<Renderer> make_small_renderer(std::shared_ptr<const CompiledScene<double>>);

}  // namespace cistula
