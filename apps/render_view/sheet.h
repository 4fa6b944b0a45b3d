// Layers beside each other, as one picture.
#pragma once

#include <string>
#include <vector>

#include "options.h"
#include "show.h"

namespace cistula {

/// A picture, and a line for each of its layers: where it is, and how it is shown.
struct Sheet {
    ColorPicture picture;
    std::string legend;
};

/// Shows layers of a file, at least one, in rows from the top left, in their order, a gap between. Throws Error: file,
/// or usage if the picture would be too large for a PNG, or nearly all borders.
Sheet make_sheet(const ExrFile& file, const std::vector<Layer>& layers, const ViewOptions& options);

}  // namespace cistula
