// One pixel's ray trees, as the CPU backend follows them.
#pragma once

#include <memory>

#include "scene/compile/compiled_scene.h"
#include "scene/film/pixel_tree.h"
#include "scene/film/renderer.h"

namespace cistula {

/// The ray trees of pixel (x, y) of the frame; settings.crop plays no part. Throws std::logic_error where the trees are
/// not what the renderer gives for that pixel, bit for bit, and Error as a render does.
template <class Real>
PixelTree embree_pixel_tree(std::shared_ptr<const CompiledScene<Real>> scene, const CameraFrame& camera,
                            const FrameSettings& settings, int x, int y);

}  // namespace cistula
