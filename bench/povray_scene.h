// A scene of Cistula's in the language of POV-Ray 3.7: the same triangles, camera, materials and lights.
#pragma once

#include <string>

#include "scene/description/camera_path.h"
#include "scene/description/description.h"

namespace cistula::bench {

/// The text of a .pov file whose picture of any size of this width to height, one ray through each pixel's center,
/// converges to Cistula's with growing depth. Depth and max_trace_level are counted differently: POV-Ray counts
/// mirrored and bent rays only. Throws Error (usage) for what POV-Ray has no equal of: glass that absorbs or tints, or
/// bends without Fresnel, textures other than checkers, lights that are seen or fall off.
std::string povray_scene(const SceneDescription& scene, const CameraFrame& camera, int width, int height,
                         int max_trace_level);

}  // namespace cistula::bench
