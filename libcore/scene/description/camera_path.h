// Where the camera is at each frame of a film.
#pragma once

#include "cistula/model/camera.h"
#include "scene/description/description.h"

namespace cistula {

struct CameraFrame {
    int frame = 0;
    double time = 0;
    Camera camera;  // scene units
};

/// The camera at frame number `frame`, t = frame * time_step. Its sinusoids are those of elementary.h. Throws Error
/// (usage) where position and target coincide or the view direction is parallel to `up`.
CameraFrame camera_at(const CameraDescription& description, int frame);

}  // namespace cistula
