// The host's intersectors, as cases call them.
#pragma once

#include <functional>

#include "apps/render_verify/lane_path.h"
#include "backend_embree/embree/embree_api.h"

namespace cistula::verify {

/// Ways to find hits on the host. `plain`: tests every primitive and nothing else; the reference of compared cases.
enum class HostPath { embree, lanes, bvh, brute, plain };

/// What intersectors need beside the scene, each for its own path.
template <class Real>
struct PathNeeds {
    RTCScene embree = nullptr;
    const LanePath<Real>* lanes = nullptr;
};

/// Calls body(intersector) with the intersector of this path.
template <class Real>
void with_intersector(HostPath path, const SceneView<Real>& scene, const PathNeeds<Real>& needs,
                      const std::function<void(const CalledIntersector<Real>&)>& body);

}  // namespace cistula::verify
