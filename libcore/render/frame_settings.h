// The settings of a scene's frames where nobody asks for others.
#pragma once

#include "render/renderer.h"
#include "scene/description/description.h"

namespace cistula {

/// A scene's own settings: the size and the samples of its film, its depth and its cutoff, without a crop.
FrameSettings frame_settings(const SceneDescription& scene);

}  // namespace cistula
