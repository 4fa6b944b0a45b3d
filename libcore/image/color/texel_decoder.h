// Numbers of picture files to texels, which are linear Rec. 709.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "image/color/file_colors.h"

namespace cistula {

/// Decodes samples of 1 or 2 bytes, whose largest number is white, or of 4, which are floats. Gray stays gray exactly,
/// in any space, unless channels have factors of their own. A converted value that is negative only by the rounding of
/// the numbers in the file becomes 0.
class TexelDecoder {
  public:
    TexelDecoder(const FileEncoding& encoding, uint32_t sample_bytes, bool is_half = false,
                 const std::array<double, 3>& factors = {1, 1, 1});

    /// Appends a texel for every `channels` samples, of the first three, or of the first where there are fewer.
    void append(std::string_view bytes, uint32_t channels, std::vector<glm::vec3>& texels) const;

  private:
    glm::vec3 texel(const glm::dvec3& light) const;
    template <class Sample, class Light>
    void append_as(std::string_view bytes, uint32_t channels, std::vector<glm::vec3>& texels, Light light) const;

    Curve curve_;
    uint32_t sample_bytes_;
    std::vector<double> table_;  // for integers
    bool converts_;
    glm::dmat3 matrix_{1.0};
    std::array<double, 3> factors_;  // of floats
    double rounding_;                // relative error of the file's numbers
};

}  // namespace cistula
