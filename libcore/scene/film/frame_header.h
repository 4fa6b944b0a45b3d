// What the header of an EXR says of a frame: everything that the pixels depend on and nothing else, so that equal
// images give equal files on any machine.
#pragma once

#include <string>
#include <vector>

#include "scene/description/camera_path.h"
#include "scene/film/renderer.h"
#include "scene/image/picture.h"

namespace cistula {

using Attributes = decltype(LayeredPicture::attributes);

/// The attributes: scene hash, camera hash, version, precision, depth, cutoff, supersample, frame, time, worldToCamera,
/// worldToNDC, chromaticities (Rec. 709, D65), and the intersector if it is not the exact one. docs/programs.md
/// documents each.
Attributes header_attributes(const std::string& scene_hash, const FrameSettings& settings, Precision precision,
                             const CameraFrame& camera, Intersection intersection = Intersection::exact);

/// Matrix from world to camera space (x right, y up, looking along -z): 16 numbers for row vectors, p' = p M.
std::vector<float> world_to_camera(const Camera& camera);

/// Matrix from world to normalized device coordinates, for row vectors. After division by w, the distance along the
/// view axis: x is -1 to 1 from left to right, y -1 to 1 from bottom to top of the full frame, z = 1 - 1 / distance.
std::vector<float> world_to_ndc(const Camera& camera, int width, int height);

}  // namespace cistula
