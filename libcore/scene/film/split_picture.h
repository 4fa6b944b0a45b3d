// Distribution of a frame's layers over parts of a file, or over files.
#pragma once

#include <string>
#include <vector>

#include "scene/image/picture.h"

namespace cistula {

/// Where the layers of a frame go: all into one part of one file, each into a part of its own, or each into a file.
enum class Split { none, parts, files };

/// The name of the part that holds the beauty.
inline constexpr const char* main_part = "beauty";

/// The picture's channels by layer: what stands before a channel's last dot. The first part is main_part, with R, G, B,
/// A and all other channels without a dot; the others follow in the order of their channels. The channels of a
/// Cryptomatte are one layer, and its attributes are in that part alone; all others are in every part.
std::vector<PicturePart> split_by_layer(LayeredPicture picture);

/// Names a layer's R, G and B without the layer, as every program looks for the colors of a file.
void name_colors_plainly(PicturePart& part);

}  // namespace cistula
