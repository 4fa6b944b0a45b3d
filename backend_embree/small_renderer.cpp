#include "backend_embree/host_renderer.h"
#include "scene/shadow_plan.h"

namespace cistula {

template <class Real>
std::unique_ptr<Renderer> make_small_renderer(std::shared_ptr<const CompiledScene<Real>> scene) {
    std::unique_ptr<const SmallScene<Real>> small = small_scene(scene->view());
    if (!small) return nullptr;
    using Loop = BruteIntersector<Real, OneMedium, SmallScene<Real>>;
    return std::make_unique<HostRenderer<Real, Loop>>(std::move(scene), std::move(small), "embree");
}

template std::unique_ptr<Renderer> make_small_renderer(std::shared_ptr<const CompiledScene<float>>);
template std::unique_ptr<Renderer> make_small_renderer(std::shared_ptr<const CompiledScene<double>>);

}  // namespace cistula
