// The layers of an EXR file: its channels in groups that are shown together.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "image/exr/exr_file.h"

namespace cistula {

/// How a layer is shown.
enum class LayerKind {
    color,      // R G B, as colors
    luminance,  // Y, as gray
    chroma,     // RY Y BY, as colors
    ids,        // a number: each in a color of its own
    mattes,     // Cryptomatte, r g b a: two ids, each followed by the share of the pixel that it covers
    depth,      // a distance
    normals,    // X Y Z, each from -1 to 1
    vectors,    // X Y, or X Y Z
    texture,    // U V, places in a texture
    scalar,     // any other number, as gray
};

struct Layer {
    std::string name;
    LayerKind kind = LayerKind::scalar;
    size_t part = 0;               // number in ExrFile::parts
    std::vector<size_t> channels;  // numbers in ExrPart::channels, in the order that the kind says
};

/// The kind in words: "color", "ids".
std::string_view kind_name(LayerKind kind);

/// All layers, those of a part together, colors without a name first. A channel belongs to the layer that its name says
/// before the last dot: diffuse.R, diffuse.G and diffuse.B are "diffuse", R, G and B without a dot are "RGB". Channels
/// that are no such set are layers of their own: "Z", "stats.rays"; one that is alone before its dot has the name
/// before it: "depth" of depth.Z. RY, Y and BY without a dot are "YC". In a file of several parts a layer is
/// "PART.NAME", unless NAME begins with the part's own. No two have the same name.
std::vector<Layer> layers_of(const std::vector<ExrPart>& parts);

/// The layer that is shown where none is named: the first of colors, else of luminance and chroma, else of luminance,
/// else the first.
const Layer& default_layer(const std::vector<Layer>& layers);

}  // namespace cistula
