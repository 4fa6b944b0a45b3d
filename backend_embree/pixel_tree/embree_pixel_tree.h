// The ray trees of one pixel, as the CPU backend traces them.
#pragma once

#include <memory>

#include "backend_embree/embree/embree_intersector.h"
#include "render/pixel_tree.h"
#include "render/renderer.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// Renderer::pixel_tree() of `renderer`, which renders the same scene on the CPU.
template <class Real>
PixelTree embree_pixel_tree(const CompiledScene<Real>& scene, const EmbreeIntersector<Real>& intersector,
                            Renderer& renderer, const CameraFrame& camera, const FrameSettings& settings, int x, int y,
                            const PixelTreeLimits& limits);

}  // namespace cistula
