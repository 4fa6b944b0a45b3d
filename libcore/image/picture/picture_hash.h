// Pictures as their files store them: values of the channels' types, and a hash of all that is stored but the header's
// text.
#pragma once

#include <string>

#include "image/picture/picture.h"

namespace cistula {

/// Rounds the values of half channels to halves, to nearest even, as write_exr does: the picture then has the bits that
/// read_exr would read.
void round_to_stored(LayeredPicture& picture);

/// 128-bit FNV-1a of a picture as 32 hexadecimal digits. What enters, integers lowest byte first: width, height, x and
/// y of the data window, width and height of the display window, the number of channels, each in 32 bits; then every
/// channel in the order of the names' bytes: the length of its name in 32 bits, the name, its type in 8 bits as OpenEXR
/// numbers them (half 1, float 2), and the bits of all values, row by row from the top left, in 16 or 32 bits each.
/// Attributes and compression do not enter. Half channels must hold halves (round_to_stored).
std::string picture_hash(const LayeredPicture& picture);

}  // namespace cistula
