// The pixels of a window that rectangles leave uncovered.
#pragma once

#include <optional>
#include <vector>

#include "scene/film/film.h"

namespace cistula {

/// The pixels that two rectangles share; nothing if there are none.
std::optional<PixelRect> shared_pixels(const PixelRect& a, const PixelRect& b);

/// Rectangles apart from each other that hold what of the window no rectangle covers.
std::vector<PixelRect> uncovered(const PixelRect& window, const std::vector<PixelRect>& rects);

}  // namespace cistula
