// What a layer looks like.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/view/picture_view.h"
#include "layers.h"

namespace cistula {

/// A layer as linear colors for an encoder that clamps them. Pixels with a value that is not a number are magenta,
/// those with an infinity cyan, except infinitely far depths.
struct ShownLayer {
    ColorPicture picture;
    std::string values;               // what is shown how, in words: "3.2 bright to 41 dark"; empty: nothing to say
    size_t nans = 0, infinities = 0;  // pixels
};

/// Shows a layer of a part. `channels`: those of the layer, with their values. `view` applies to colors and luminance;
/// its exposure to scalars too, which are divided by the largest where `exposed` is false.
ShownLayer show_layer(const Layer& layer, const ExrPart& part, const std::vector<const ExrChannel*>& channels,
                      const PictureView& view, bool exposed);

}  // namespace cistula
