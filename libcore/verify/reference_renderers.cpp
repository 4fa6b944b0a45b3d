#include "verify/reference_renderers.h"

#include "backend_embree/host/frame_loop.h"
#include "backend_embree/host/ray_queries.h"
#include "cistula/traversal/bvh.h"
#include "render/frame/ray_questions.h"

namespace cistula {
namespace {

/// The loop over all primitives, or the tree. Which it is is chosen when it runs, so that renderers are compiled once.
template <class Real>
struct EitherIntersector {
    using Media = InteriorList;
    using Scene = SceneView<Real>;
    const Scene& scene;
    HostIntersector by;

    template <class E = Effects<all_effects>>
    CISTULA_NOINLINE Hit<Real> closest(const Ray<Real>& ray) const {
        if (by == HostIntersector::bvh) return BvhIntersector<Real>{scene}.template closest<E>(ray);
        return BruteIntersector<Real>{scene}.template closest<E>(ray);
    }
    template <class E>
    CISTULA_NOINLINE Throughput<Real, E> transmittance(const ShadowRay<Real>& shadow) const {
        if (by == HostIntersector::bvh) return BvhIntersector<Real>{scene}.template transmittance<E>(shadow);
        return BruteIntersector<Real>{scene}.template transmittance<E>(shadow);
    }
};

}  // namespace

template <class Real>
inline constexpr bool fills_film_layers<EitherIntersector<Real>> = true;

namespace {

/// A Renderer over an intersector that needs only a view of the scene.
template <class Real>
class HostRenderer : public Renderer {
  public:
    using Intersector = EitherIntersector<Real>;

    HostRenderer(std::shared_ptr<const CompiledScene<Real>> scene, HostIntersector by)
        : scene_(std::move(scene)), view_(scene_->view()), by_(by) {}

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        const Intersector intersector{view_, by_};
        FrameTask task(*scene_, intersector, camera, settings, film, progress);
        effects_ = task.effects();
        return task.run();
    }
    RayHits intersect(std::span<const glm::dvec3> origins, std::span<const glm::dvec3> directions) override {
        const Intersector intersector{view_, by_};
        return ray_hits<Real>(*scene_, origins, directions, [&](auto questions, auto answers) {
            SingleQueries<Real, Intersector>{intersector}.rays(questions, answers);
        });
    }
    std::vector<glm::dvec3> transmittance(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) override {
        const Intersector intersector{view_, by_};
        return segment_shares<Real>(*scene_, from, to, [&](auto questions, auto shares) {
            SingleQueries<Real, Intersector>{intersector}.segments(questions, shares);
        });
    }
    uint32_t effects() const override { return effects_; }
    std::string intersector() const override { return by_ == HostIntersector::bvh ? "bvh" : "brute"; }
    size_t memory() const override { return scene_->memory(); }

  private:
    std::shared_ptr<const CompiledScene<Real>> scene_;
    SceneView<Real> view_;
    const HostIntersector by_;
    uint32_t effects_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             HostIntersector intersector) {
    return std::make_unique<HostRenderer<Real>>(std::move(scene), intersector);
}

template std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<float>>, HostIntersector);
template std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<double>>, HostIntersector);

}  // namespace cistula
