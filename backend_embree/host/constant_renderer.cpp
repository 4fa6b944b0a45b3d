#include "backend_embree/host/host_renderer.h"
#include "scene/compile/constant_scene.h"
#include "scene/compile/lane_scene.h"

namespace cistula {

template <class Real>
std::unique_ptr<Renderer> make_constant_renderer(std::shared_ptr<const CompiledScene<Real>> scene) {
    std::unique_ptr<const ConstantScene<Real>> form = constant_scene(scene->view());
    if (!form) return nullptr;
    using Loop = BruteIntersector<Real, SingleInterior, ConstantScene<Real>>;
    auto in_lanes = lane_scene(scene->view());
    return std::make_unique<HostRenderer<Real, Loop>>(std::move(scene), std::move(form), "embree", std::move(in_lanes));
}

template std::unique_ptr<Renderer> make_constant_renderer(std::shared_ptr<const CompiledScene<float>>);
template std::unique_ptr<Renderer> make_constant_renderer(std::shared_ptr<const CompiledScene<double>>);

}  // namespace cistula
