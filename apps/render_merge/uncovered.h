// The pixels of a window that rectangles leave uncovered.
#pragma once

#include <vector>

#include "scene/base/pixel_rect.h"

namespace cistula {

/// Rectangles apart from each other that hold what of the window no rectangle covers.
std::vector<PixelRect> uncovered(const PixelRect& window, const std::vector<PixelRect>& rects);

}  // namespace cistula
