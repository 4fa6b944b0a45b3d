// The color spaces of files: linear RGB, told apart by their primaries and white.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace cistula {

/// A linear RGB space.
struct ColorSpace {
    std::string_view id;                         // as the Color Interop Forum names it; empty: it has no name
    double red[2], green[2], blue[2], white[2];  // CIE 1931 x, y
};

/// lin_rec709_scene (ITU-R BT.709, white D65), the space of scenes and of rendering; lin_ap1_scene (ACEScg, SMPTE
/// ST 2065-1's white), lin_ap0_scene (ACES2065-1), lin_rec2020_scene (ITU-R BT.2020, D65), lin_p3d65_scene (SMPTE
/// RP 431-2's primaries, D65), lin_adobergb_scene (Adobe RGB (1998), D65).
std::span<const ColorSpace> color_spaces();

/// Null: there is none of that id.
const ColorSpace* find_color_space(std::string_view id);

/// x and y of red, green, blue and white, as OpenEXR stores them.
using Chromaticities = std::array<float, 8>;

/// The space of these chromaticities: one of color_spaces() where none is off by more than 0.001, the tolerance of the
/// Color Interop Forum; otherwise one without an id. Throws std::runtime_error where white does not lie inside the
/// triangle of red, green and blue, or where they are not finite.
ColorSpace color_space_of(const Chromaticities& chromaticities);

/// From RGB of one space to RGB of another: to XYZ, by Bradford's adaptation from white to white (Lam 1985; linear, as
/// in ICC.1), and to RGB. The rows of the result add up to 1, to within rounding: white stays white.
glm::dmat3 color_matrix(const ColorSpace& from, const ColorSpace& to);

/// XYZ of red, green and blue by column, adapted to D50 as ICC profiles give them; they add up to D50, Y = 1.
glm::dmat3 profile_colorants(const ColorSpace& space);

/// Shares of red, green and blue in the luminance Y of a color; they add up to 1, to within rounding.
glm::dvec3 luminance_weights(const ColorSpace& space);

}  // namespace cistula
