#include "verify/reference_renderers.h"

#include "backend_embree/host/frame_loop.h"
#include "backend_embree/host/ray_queries.h"
#include "cistula/traversal/bvh.h"
#include "render/frame/ray_questions.h"

namespace cistula {
namespace {

/// A Renderer over an intersector that needs only a view of the scene.
template <class Real, class Intersector>
class HostRenderer : public Renderer {
  public:
    HostRenderer(std::shared_ptr<const CompiledScene<Real>> scene, const char* name)
        : scene_(std::move(scene)), view_(scene_->view()), name_(name) {}

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        const Intersector intersector{view_};
        FrameTask task(*scene_, intersector, camera, settings, film, progress);
        effects_ = task.effects();
        return task.run();
    }
    RayHits intersect(std::span<const glm::dvec3> origins, std::span<const glm::dvec3> directions) override {
        const Intersector intersector{view_};
        return ray_hits<Real>(*scene_, origins, directions, [&](auto questions, auto answers) {
            SingleQueries<Real, Intersector>{intersector}.rays(questions, answers);
        });
    }
    std::vector<glm::dvec3> transmittance(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) override {
        const Intersector intersector{view_};
        return segment_shares<Real>(*scene_, from, to, [&](auto questions, auto shares) {
            SingleQueries<Real, Intersector>{intersector}.segments(questions, shares);
        });
    }
    uint32_t effects() const override { return effects_; }
    std::string intersector() const override { return name_; }
    size_t memory() const override { return scene_->memory(); }

  private:
    std::shared_ptr<const CompiledScene<Real>> scene_;
    SceneView<Real> view_;
    const char* name_;
    uint32_t effects_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             HostIntersector intersector) {
    if (intersector == HostIntersector::bvh)
        return std::make_unique<HostRenderer<Real, BvhIntersector<Real>>>(std::move(scene), "bvh");
    return std::make_unique<HostRenderer<Real, BruteIntersector<Real>>>(std::move(scene), "brute");
}

template std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<float>>, HostIntersector);
template std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<double>>, HostIntersector);

}  // namespace cistula
