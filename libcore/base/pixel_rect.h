// Rectangles of pixels.
#pragma once

#include <cstddef>
#include <string>

namespace cistula {

/// A rectangle of pixels; (0, 0) is the top left of the full frame, or of a file's pixel space.
struct PixelRect {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;

    bool is_empty() const { return width <= 0 || height <= 0; }
    size_t pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }

    /// The number of one of its pixels, row-major.
    size_t index(int column, int row) const {
        return static_cast<size_t>(row - y) * static_cast<size_t>(width) + static_cast<size_t>(column - x);
    }
    bool operator==(const PixelRect&) const = default;
    auto operator<=>(const PixelRect&) const = default;
};

/// The pixels that both have; width and height are 0 where there are none.
PixelRect intersection(const PixelRect& a, const PixelRect& b);

/// Whether one has all pixels of another.
bool contains(const PixelRect& outer, const PixelRect& inner);

/// A rectangle in messages: "640x480+0+0".
std::string format_rect(const PixelRect& rect);

}  // namespace cistula
