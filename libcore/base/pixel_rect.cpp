#include "base/pixel_rect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace cistula {

PixelRect intersection(const PixelRect& a, const PixelRect& b) {
    const auto end = [](int start, int size) { return static_cast<int64_t>(start) + size; };
    const int x = std::max(a.x, b.x);
    const int y = std::max(a.y, b.y);
    const int64_t width = std::min(end(a.x, a.width), end(b.x, b.width)) - x;
    const int64_t height = std::min(end(a.y, a.height), end(b.y, b.height)) - y;
    if (width <= 0 || height <= 0) return {x, y, 0, 0};
    return {x, y, static_cast<int>(width), static_cast<int>(height)};
}

bool contains(const PixelRect& outer, const PixelRect& inner) {
    return intersection(outer, inner) == inner;
}

std::string format_rect(const PixelRect& rect) {
    return fmt::format("{}x{}{:+}{:+}", rect.width, rect.height, rect.x, rect.y);
}

}  // namespace cistula
