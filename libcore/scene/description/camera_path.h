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

/// The camera at frame number `frame`, t = frame * time_step. Its sinusoids are those of elementary.h. Where the view
/// is along `up`, to within rounding, the picture's right is the first of these that there is: the limit of the picture
/// along the path from the frame before (for frame 0, from the one after); the limit as the position's r grows a
/// little, or the target's if only that has a path; the world axis that is least along the view, x before y before z. A
/// function of `frame` alone. Throws Error (usage), with the camera's place, where position and target coincide.
CameraFrame camera_at(const CameraDescription& description, int frame);

}  // namespace cistula
