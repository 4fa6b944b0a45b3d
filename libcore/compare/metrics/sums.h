// Whether the layers of a picture add up to its radiance.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "image/picture/picture.h"

namespace cistula {

/// A division of the radiance into layers, and how well they add up to it.
struct DivisionSums {
    std::string name;  // "path" or "light"
    size_t layers = 0;
    size_t pixels_off = 0;  // where a channel differs by more than the rounding of its values to the file's types
    double most = 0;        // the largest difference there, at:
    // in the display window
    int x = 0;
    int y = 0;
    std::string channel;
};

/// The divisions that a picture has whole. Of n layers each value, and the sum's, may be off by half a unit in its last
/// place.
std::vector<DivisionSums> division_sums(const LayeredPicture& picture);

/// A line for each division.
std::string sums_text(const std::vector<DivisionSums>& divisions, size_t pixels);

}  // namespace cistula
