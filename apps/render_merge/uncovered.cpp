#include "uncovered.h"

namespace cistula {
namespace {

/// Adds what of `rect` lies outside of `hole`, which is inside of it: above, below, left and right.
void add_around(const PixelRect& rect, const PixelRect& hole, std::vector<PixelRect>& to) {
    const auto add = [&](int x, int y, int width, int height) {
        if (width > 0 && height > 0) to.push_back({x, y, width, height});
    };
    const int right = hole.x + hole.width, below = hole.y + hole.height;
    add(rect.x, rect.y, rect.width, hole.y - rect.y);
    add(rect.x, below, rect.width, rect.y + rect.height - below);
    add(rect.x, hole.y, hole.x - rect.x, hole.height);
    add(right, hole.y, rect.x + rect.width - right, hole.height);
}

}  // namespace

std::vector<PixelRect> uncovered(const PixelRect& window, const std::vector<PixelRect>& rects) {
    std::vector<PixelRect> left = {window};
    for (const PixelRect& rect : rects) {
        std::vector<PixelRect> next;
        for (const PixelRect& part : left) {
            if (const PixelRect shared = intersection(part, rect); !shared.is_empty())
                add_around(part, shared, next);
            else
                next.push_back(part);
        }
        left = std::move(next);
    }
    return left;
}

}  // namespace cistula
