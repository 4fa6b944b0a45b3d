// What a picture file says of its colors, and what that makes of its numbers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "image/color/color_encoding.h"
#include "image/color/color_space.h"

namespace cistula {

/// Attributes of an OpenEXR file, or what a profile or the header of another file means.
struct FileColors {
    std::string id;       // colorInteropID, or a name of color_encodings; empty: none
    std::string profile;  // name of an ICC profile, or of something else, that is none of them; empty: none
    std::optional<Chromaticities> chromaticities;
    bool is_aces = false;                    // acesImageContainerFlag, of SMPTE ST 2065-4
    bool is_half = false;                    // numbers are rounded to halves
    std::array<double, 3> factors{1, 1, 1};  // that its numbers were multiplied by, and are to be divided by
};

/// What the numbers of one file mean.
struct FileEncoding {
    ColorSpace space;
    Curve curve;
};

/// The encoding that has a name, or, if that is empty, the one that the file says; of a file that says nothing,
/// linear Rec. 709 for floating-point numbers and sRGB for integers. Throws std::runtime_error for a name, an ID or a
/// profile that is not known, and where a file contradicts itself.
FileEncoding file_encoding(std::string_view name, const FileColors& colors, bool is_floating);

}  // namespace cistula
