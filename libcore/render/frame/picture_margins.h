// Margins by which projected outlines are enlarged, so that rounding moves nothing out of them. Private to
// libcore/scene.
#pragma once

#include <algorithm>

#include "cistula/transport/pixel.h"

namespace cistula {

/// Margin around projected outlines in pixels, for the rounding of the projection in double.
inline constexpr double picture_margin = 0x1p-6;

/// Growth of projected bodies in the frame of reference: far above the rounding of rays and faces in either precision
/// (docs/rules.md, 1 and 2). `extent`: the scene's M.
inline double picture_growth(const FrameView& frame, double extent) {
    constexpr double share_of_extent = 0x1p-16, share_of_distance = 0x1p-44;
    return share_of_extent * extent + share_of_distance * length(frame.camera.position);
}

/// Whether the margins suffice; they do not for cameras very far away or with very wide views.
inline bool margins_suffice(const FrameView& frame, double extent) {
    constexpr double farthest = 0x1p40, widest_tangent = 256;
    return length(frame.camera.position) <= farthest * extent &&
           frame.camera.tan_half_width * std::max(1.0, double(frame.height) / frame.width) <= widest_tangent;
}

}  // namespace cistula
