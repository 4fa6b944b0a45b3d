#include "testing/reference_renderers.h"

#include "backend_embree/host/host_renderer.h"
#include "cistula/traversal/bvh.h"

namespace cistula {

template <class Real>
std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             HostIntersector intersector) {
    auto view = std::make_unique<const SceneView<Real>>(scene->view());
    if (intersector == HostIntersector::bvh)
        return std::make_unique<HostRenderer<Real, BvhIntersector<Real>>>(std::move(scene), std::move(view), "bvh");
    return std::make_unique<HostRenderer<Real, BruteIntersector<Real>>>(std::move(scene), std::move(view), "brute");
}

template std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<float>>, HostIntersector);
template std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<double>>, HostIntersector);

}  // namespace cistula
