// Distribution of a frame's layers over parts of a file, or over files.
#pragma once

#include <string>
#include <vector>

#include "image/picture/picture.h"

namespace cistula {

/// Where the layers of a frame go: all into one part of one file, each into a part of its own, or each into a file.
enum class Split { none, parts, files };

/// The name of the part that holds R, G, B and A: that by which Blender knows it.
inline constexpr const char* main_part = "Combined";

/// The picture's channels by layer: what stands before a channel's last dot. The first part is main_part; the others
/// follow in the order of their channels. Parts of a file: channels without a dot but R, G, B and A are layers, too,
/// and so is each pair of ranks of a Cryptomatte, whose attributes are in its parts and in the first, where Blender
/// looks. Files: channels without a dot are in the first, and a Cryptomatte is one layer, which alone has its
/// attributes. All other attributes are in every part, but that a layer without R, G and B is said to be "data" in
/// place of a color space.
std::vector<PicturePart> split_by_layer(LayeredPicture picture, Split split);

/// Names a layer's R, G and B without the layer, as every program looks for the colors of a file.
void name_colors_plainly(PicturePart& part);

}  // namespace cistula
