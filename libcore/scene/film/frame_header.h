// What the header of an EXR says of a frame: everything that the pixels depend on and nothing else, so that equal
// images give equal files on any machine.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene/description/camera_path.h"
#include "scene/film/renderer.h"
#include "scene/image/picture/picture.h"

namespace cistula {

using Attributes = decltype(LayeredPicture::attributes);

/// What tells scenes apart: for each frame a hash of everything that affects its image, except camera and settings.
class FrameHashes {
  public:
    /// Hashes of a scene in which nothing moves: one for all frames.
    FrameHashes(std::string still = "") : still_(std::move(still)) {}

    const std::string& of([[maybe_unused]] int frame) const { return still_; }
    bool operator==(const FrameHashes&) const = default;

  private:
    std::string still_;
};

/// The attributes: scene hash, camera hash, version, precision, depth, cutoff, supersample, frame, time, worldToCamera,
/// worldToNDC, screenWindowWidth, imageCounter. docs/programs.md documents each, with those that to_layers() gives.
Attributes header_attributes(const FrameHashes& hashes, const FrameSettings& settings, Precision precision,
                             const CameraFrame& camera);

/// Adds what the scene says of the film: framesPerSecond, owner and comments, where given.
void add_film_attributes(const FilmDescription& film, Attributes& attributes);

/// Matrix from world to camera space as OpenEXR has it, left-handed (x right, y up, z ahead): 16 numbers for row
/// vectors, p' = p M.
std::vector<float> world_to_camera(const Camera& camera);

/// Matrix from world to normalized device coordinates as OpenEXR has them, for row vectors. After division by w, the
/// distance along the view axis: (0, 0) is the upper left and (1, 1) the lower right corner of the full frame; z is
/// 1 - 1 / distance.
std::vector<float> world_to_ndc(const Camera& camera, int width, int height);

}  // namespace cistula
