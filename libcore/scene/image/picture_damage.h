// What decoders of picture files get wrong without a word: damage, and kinds that they do not know.
#pragma once

#include <string>
#include <string_view>

namespace cistula {

/// What is wrong with a file that OpenImageIO has opened as `format`, for a message. JPEG, DDS: it is cut off, where
/// decoders make up the rest, or its header would have them decode without end. TIFF, Radiance: it is of a kind that
/// OpenImageIO 2.4 reads as another. Empty for other formats.
std::string picture_damage(std::string_view format, const std::string& path);

}  // namespace cistula
