// Where the camera is at each frame of a sequence, and where its picture turns at once.
#pragma once

#include <string>
#include <vector>

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

/// A warning that names the consecutive frames between which the picture turns by more than a quarter about its middle,
/// beyond what it takes to move the view straight from one direction to the other: the view passes along `up` there.
/// Empty if there are none. Frames in `frames` that do not follow one another are not compared.
std::string camera_turns(const CameraDescription& description, const std::vector<int>& frames);

}  // namespace cistula
