// Renderers over libcore's own intersectors on the host: what the backends are compared with.
#pragma once

#include <memory>

#include "render/renderer.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// libcore's own intersectors on the host: the reference (brute) and the GPU's tree traversal (bvh; the scene must have
/// its tree, see build_primitive_tree).
enum class HostIntersector { brute, bvh };
template <class Real>
std::unique_ptr<Renderer> make_host_renderer(std::shared_ptr<const CompiledScene<Real>> scene,
                                             HostIntersector intersector);

}  // namespace cistula
