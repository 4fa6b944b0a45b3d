#include "apps/render_verify/host_intersectors.h"

#include "backend_embree/embree/embree_intersector.h"
#include "cistula/traversal/brute.h"

namespace cistula::verify {
namespace {

/// The reference intersector: every primitive's exact test, without any culling.
template <class Real>
struct PlainIntersector {
    const SceneView<Real>& scene;

    Hit<Real> closest(const Ray<Real>& ray) const {
        Hit<Real> best;
        if (!is_finite(ray)) return best;
        const TriangleRay<Real> triangle_ray = TriangleRay<Real>::of(ray.origin, ray.direction);
        for (uint32_t p = 0; p < scene.convex.size + scene.clusters.size; ++p)
            closest_primitive(scene, p, ray, triangle_ray, best);
        return best;
    }
};

}  // namespace

template <class Real>
void with_intersector(HostPath path, const SceneView<Real>& scene, const PathNeeds<Real>& needs,
                      const std::function<void(const CalledIntersector<Real>&)>& body) {
    const auto call = [&](const auto& intersector) { body(CalledIntersector<Real>(intersector)); };
    switch (path) {
        case HostPath::embree:
            return call(EmbreeIntersector<Real>{scene, needs.embree});
        case HostPath::lanes:
            return call(*needs.lanes);
        case HostPath::bvh:
            return call(BvhIntersector<Real>{scene});
        case HostPath::brute:
            return call(BruteIntersector<Real>{scene});
        case HostPath::plain:
            return call(PlainIntersector<Real>{scene});
    }
}

template void with_intersector(HostPath, const SceneView<float>&, const PathNeeds<float>&,
                               const std::function<void(const CalledIntersector<float>&)>&);
template void with_intersector(HostPath, const SceneView<double>&, const PathNeeds<double>&,
                               const std::function<void(const CalledIntersector<double>&)>&);

}  // namespace cistula::verify
