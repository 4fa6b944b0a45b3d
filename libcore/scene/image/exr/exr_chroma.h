// Luminance and chroma of OpenEXR files.
#pragma once

#include <glm/vec3.hpp>

#include "scene/image/picture/picture.h"

namespace cistula {

/// Makes R, G and B of texels that hold RY = (R - Y) / Y, Y and BY = (B - Y) / Y. A channel that `is_halved` holds in
/// the texels of even x and y alone; the others are filtered from these as OpenEXR's RgbaInputFile does, and colors
/// that this made more saturated than their neighbors are desaturated, as there. In double, so that the same file gives
/// the same bits with every version of that library. `weights` are the shares of R, G and B in Y.
void colors_from_chroma(ColorPicture& picture, const bool (&is_halved)[3], const glm::dvec3& weights);

}  // namespace cistula
