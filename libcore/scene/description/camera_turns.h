// Where the picture of a film turns at once.
#pragma once

#include <string>
#include <vector>

#include "scene/description/description.h"

namespace cistula {

/// A warning that names the consecutive frames between which the picture turns by more than a quarter about its middle,
/// beyond what it takes to move the view straight from one direction to the other: the view passes along `up` there.
/// Empty if there are none. Frames in `frames` that do not follow one another are not compared.
std::string camera_turns(const CameraDescription& description, const std::vector<int>& frames);

}  // namespace cistula
