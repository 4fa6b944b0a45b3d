// The color spaces of files: scene-linear, told apart by their primaries and white.
#pragma once

#include <span>
#include <string_view>

#include <glm/mat3x3.hpp>

namespace cistula {

/// A scene-linear RGB space.
struct ColorSpace {
    std::string_view id;                         // as the Color Interop Forum names it
    double red[2], green[2], blue[2], white[2];  // CIE 1931 x, y
};

/// lin_rec709_scene (ITU-R BT.709, white D65), the space of scenes and of rendering; lin_ap1_scene (ACEScg, SMPTE
/// ST 2065-1's white), lin_ap0_scene (ACES2065-1), lin_rec2020_scene (ITU-R BT.2020, D65).
std::span<const ColorSpace> color_spaces();

/// Null: there is none of that id.
const ColorSpace* find_color_space(std::string_view id);

/// From RGB of one space to RGB of another: to XYZ, by Bradford's adaptation from white to white (Lam 1985; linear, as
/// in ICC.1), and to RGB. The rows of the result add up to 1, to within rounding: white stays white.
glm::dmat3 color_matrix(const ColorSpace& from, const ColorSpace& to);

}  // namespace cistula
