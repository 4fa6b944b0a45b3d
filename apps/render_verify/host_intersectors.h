// The host's intersectors, as cases call them.
#pragma once

#include <functional>

#include "apps/render_verify/called_intersector.h"
#include "backend_embree/embree/embree_api.h"

namespace cistula::verify {

/// Ways to find hits on the host. `plain`: tests every primitive and nothing else; the reference of compared cases.
enum class HostPath { embree, bvh, brute, plain };

/// Calls body(intersector) with the intersector of this path; `tree` is Embree's, for its path alone.
template <class Real>
void with_intersector(HostPath path, const SceneView<Real>& scene, RTCScene tree,
                      const std::function<void(const CalledIntersector<Real>&)>& body);

}  // namespace cistula::verify
