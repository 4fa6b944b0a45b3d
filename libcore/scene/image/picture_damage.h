// Damage of picture files that the decoders of their formats do not see.
#pragma once

#include <string>
#include <string_view>

namespace cistula {

/// What is wrong with a JPEG or DDS file that OpenImageIO has opened as `format`, for a message: it is cut off, where
/// decoders make up the rest, or its header would have them decode without end. Empty for other formats.
std::string picture_damage(std::string_view format, const std::string& path);

}  // namespace cistula
