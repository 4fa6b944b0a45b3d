// What the header of an EXR says of a frame: everything that the pixels depend on and nothing else, so that equal
// images give equal files on any machine.
#pragma once

#include <string>
#include <vector>

#include "image/picture/picture.h"
#include "render/record/target_report.h"
#include "render/renderer.h"
#include "scene/compile/scene_names.h"
#include "scene/description/camera_path.h"

namespace cistula {

/// The attributes: scene hash, camera hash, version, precision, depth, cutoff, supersample, frame, time, worldToCamera,
/// worldToNDC, screenWindowWidth, imageCounter. docs/programs/headers.md documents each, with those of to_layers().
Attributes header_attributes(const FrameHashes& hashes, const FrameSettings& settings, Precision precision,
                             const CameraFrame& camera);

/// Adds what the scene says of the film: framesPerSecond, owner and comments, where given.
void add_film_attributes(const FilmDescription& film, Attributes& attributes);

/// All that the header of a finished frame says beside what to_layers() gives: the above, what the scene says of the
/// film, and what is proven and estimated of a target error.
Attributes header_attributes(const Film& film, const FilmDescription& description, const FrameHashes& hashes,
                             const FrameSettings& settings, Precision precision, const CameraFrame& camera);

/// Adds what is proven and estimated of the image: provenTruncation, checkedPixels and offPixels.
void add_target_attributes(const TargetReport& report, Attributes& attributes);

/// The attributes without what add_target_attributes() adds.
Attributes without_target_attributes(Attributes attributes);

/// Adds what is proven and estimated of more pixels of a frame, where a header says that.
void join_target_attributes(const Attributes& more, Attributes& attributes);

/// Matrix from world to camera space as OpenEXR has it, left-handed (x right, y up, z ahead): 16 numbers for row
/// vectors, p' = p M.
std::vector<float> world_to_camera(const Camera& camera);

/// Matrix from world to normalized device coordinates as OpenEXR has them, for row vectors. After division by w, the
/// distance along the view axis: (0, 0) is the upper left and (1, 1) the lower right corner of the full frame; z is
/// 1 - 1 / distance.
std::vector<float> world_to_ndc(const Camera& camera, int width, int height);

/// Whether `picture` is the image that the attributes, windows, channels and compression of `expected` describe. The
/// values of `expected` are ignored, and so is what add_target_attributes() added to the picture.
bool is_same_image(const LayeredPicture& picture, const LayeredPicture& expected);

}  // namespace cistula
