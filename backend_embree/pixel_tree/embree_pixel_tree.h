// The ray trees of one pixel, as the CPU backend traces them.
#pragma once

#include <memory>

#include "render/pixel_tree.h"
#include "render/renderer.h"
#include "scene/compile/compiled_scene.h"

namespace cistula {

/// The ray trees of pixel (x, y) of the frame; settings.crop is ignored. Throws std::logic_error if the trees do not
/// give the renderer's result for that pixel bit for bit, and Error as a render does.
template <class Real>
PixelTree embree_pixel_tree(std::shared_ptr<const CompiledScene<Real>> scene, const CameraFrame& camera,
                            const FrameSettings& settings, int x, int y);

}  // namespace cistula
