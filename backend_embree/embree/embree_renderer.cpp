#include "backend_embree/embree/embree_renderer.h"

#include "backend_embree/embree/embree_tree.h"
#include "backend_embree/host/frame_loop.h"
#include "backend_embree/host/ray_queries.h"
#include "backend_embree/pixel_tree/embree_pixel_tree.h"
#include "render/frame/ray_questions.h"
#include "scene/compile/lane_scene.h"

namespace cistula {

template <class Real>
inline constexpr bool fills_film_layers<EmbreeIntersector<Real>> = true;

namespace {

template <class Real>
class EmbreeRenderer : public Renderer {
  public:
    EmbreeRenderer(std::shared_ptr<const CompiledScene<Real>> scene, const EmbreeOptions& options)
        : scene_(std::move(scene)), view_(scene_->view()), options_(options) {
        if (!options.always_tree) in_lanes_ = lane_scene(view_);
        if (!in_lanes_) tree();
    }

    bool render(const CameraFrame& camera, const FrameSettings& settings, Film& film,
                RenderProgress& progress) override {
        EmbreeIntersector<Real> intersector{view_, tree_ ? tree_->scene() : nullptr};
        FrameTask task(*scene_, intersector, camera, settings, film, progress,
                       in_lanes_ ? &in_lanes_->scene() : nullptr);
        effects_ = task.effects();
        lanes_ = task.lanes();
        if (lanes_ == 1) intersector.tree = tree();
        return task.run();
    }
    RayHits intersect(std::span<const glm::dvec3> origins, std::span<const glm::dvec3> directions) override {
        return with_queries([&](const auto& queries) {
            return ray_hits<Real>(*scene_, origins, directions,
                                  [&](auto questions, auto answers) { queries.rays(questions, answers); });
        });
    }
    std::vector<glm::dvec3> transmittance(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) override {
        return with_queries([&](const auto& queries) {
            return segment_shares<Real>(*scene_, from, to,
                                        [&](auto questions, auto shares) { queries.segments(questions, shares); });
        });
    }
    PixelTree pixel_tree(const CameraFrame& camera, const FrameSettings& settings, int x, int y,
                         const PixelTreeLimits& limits) override {
        return embree_pixel_tree<Real>(*scene_, {view_, tree()}, *this, camera, settings, x, y, limits);
    }
    uint32_t effects() const override { return effects_; }
    int lanes() const override { return lanes_; }
    std::string intersector() const override { return lanes_ > 1 ? "lanes" : "embree"; }
    size_t memory() const override {
        return scene_->memory() + (in_lanes_ ? in_lanes_->memory() : 0) + (tree_ ? tree_->memory() : 0);
    }

  private:
    RTCScene tree() {
        if (!tree_) tree_ = std::make_unique<const EmbreeTree<Real>>(view_, options_);
        return tree_->scene();
    }

    /// Calls ask(queries) with what answers questions about rays as frames trace theirs.
    template <class Ask>
    auto with_queries(const Ask& ask) {
        const TileFunctions* const functions = in_lanes_ ? tile_functions(in_lanes_->scene(), 0) : nullptr;
        if (functions == nullptr) {
            const EmbreeIntersector<Real> intersector{view_, tree()};
            return ask(SingleQueries<Real, EmbreeIntersector<Real>>{intersector});
        }
        return ask(LaneQueries<Real>{in_lanes_->scene(), *functions});
    }

    std::shared_ptr<const CompiledScene<Real>> scene_;
    SceneView<Real> view_;
    EmbreeOptions options_;
    std::unique_ptr<const EmbreeTree<Real>> tree_;          // built when it is needed first
    std::unique_ptr<const OwnedLaneScene<Real>> in_lanes_;  // set if rays may be traced in lanes
    // Of the last frame:
    uint32_t effects_ = 0;
    int lanes_ = 1;
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

std::unique_ptr<Renderer> make_embree_renderer(const Scene& scene, const EmbreeOptions& options) {
    return scene.visit([&](const auto& compiled) { return make_embree_renderer(compiled, options); });
}

}  // namespace cistula
