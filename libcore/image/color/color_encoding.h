// What the numbers of a texture may mean: a color space, and the curve from numbers to light.
#pragma once

#include <array>
#include <iterator>
#include <string_view>

#include "cistula/numerics/elementary.h"
#include "image/color/color_space.h"

namespace cistula {

/// A curve from a number to light, both 0 to 1 for a shade from black to white; it goes on outside of that.
using Curve = double (*)(double number);

inline double linear_curve(double number) {
    return number;
}

/// The power numerator / denominator. Numbers below 0 stay as they are, as the Color Interop Forum has it.
template <int numerator, int denominator>
double power_curve(double number) {
    constexpr double exponent = static_cast<double>(numerator) / denominator;
    return number <= 0 ? number : elementary::pow(number, exponent);
}

struct ColorEncoding {
    std::string_view name;
    std::string_view space;  // the id of one of color_spaces()
    Curve curve;
};

/// sRGB and linear Rec. 709 by short names, and the IDs of the Color Interop Forum ("Color Space Encodings for Texture
/// Assets and CG Rendering", 1.1.0) but for CIE XYZ, which is for no pictures, and "unknown". Numbers that are no color
/// ("data") are taken as they are.
inline constexpr ColorEncoding color_encodings[] = {
    {"srgb", "lin_rec709_scene", elementary::srgb_to_linear},
    {"linear", "lin_rec709_scene", linear_curve},
    {"lin_rec709_scene", "lin_rec709_scene", linear_curve},
    {"lin_ap1_scene", "lin_ap1_scene", linear_curve},
    {"lin_ap0_scene", "lin_ap0_scene", linear_curve},
    {"lin_rec2020_scene", "lin_rec2020_scene", linear_curve},
    {"lin_p3d65_scene", "lin_p3d65_scene", linear_curve},
    {"lin_adobergb_scene", "lin_adobergb_scene", linear_curve},
    {"srgb_rec709_scene", "lin_rec709_scene", elementary::srgb_to_linear},
    {"srgb_ap1_scene", "lin_ap1_scene", elementary::srgb_to_linear},
    {"srgb_p3d65_scene", "lin_p3d65_scene", elementary::srgb_to_linear},
    {"g18_rec709_scene", "lin_rec709_scene", power_curve<18, 10>},
    {"g22_rec709_scene", "lin_rec709_scene", power_curve<22, 10>},
    {"g24_rec709_scene", "lin_rec709_scene", power_curve<24, 10>},
    {"g22_ap1_scene", "lin_ap1_scene", power_curve<22, 10>},
    {"g22_adobergb_scene", "lin_adobergb_scene", power_curve<563, 256>},
    {"data", "lin_rec709_scene", linear_curve},
};

inline constexpr auto color_encoding_names = [] {
    std::array<std::string_view, std::size(color_encodings)> names;
    for (size_t i = 0; i < names.size(); ++i) names[i] = color_encodings[i].name;
    return names;
}();

/// Null: there is none of that name.
inline const ColorEncoding* find_color_encoding(std::string_view name) {
    for (const ColorEncoding& encoding : color_encodings)
        if (encoding.name == name) return &encoding;
    return nullptr;
}

}  // namespace cistula
