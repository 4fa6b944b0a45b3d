// FLIP, by its reference implementation where that is installed.
#pragma once

#include <string>

#include "base/error.h"
#include "compare/metrics/selection.h"
#include "image/picture/stored_picture.h"

namespace cistula {

/// What NVIDIA's program `flip` (flip-evaluator on PyPI) says of two images.
struct FlipResult {
    std::string absent;   // why there is none; empty: there is
    std::string kind;     // "HDR-FLIP", of floating-point values; "LDR-FLIP", of 8-bit sRGB codes
    std::string version;  // of the program: "v1.7"
    double mean = 0, median = 0, min = 0, max = 0;  // 0 to 1; the median is weighted
};

/// FLIP of R, G and B in the first part in which both files have them, over the pixels that are compared. The reference
/// is the first file. P. Andersson, J. Nilsson, T. Akenine-Möller et al., "FLIP: A Difference Evaluator for Alternating
/// Images", HPG 2020; P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Möller, "Visualizing Errors in Rendered High
/// Dynamic Range Images", Eurographics 2021.
FlipResult flip_of(const StoredFile& a, const StoredFile& b, const Selection& selection, StopSignal stop = {});

}  // namespace cistula
