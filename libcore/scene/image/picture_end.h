// Whether a picture file is whole, for formats whose decoders make up what is missing.
#pragma once

#include <string>
#include <string_view>

namespace cistula {

/// What is missing at the end of a JPEG or DDS file that OpenImageIO has opened as `format`, for a message; empty where
/// nothing is, and for other formats, whose decoders say so themselves.
std::string missing_end(std::string_view format, const std::string& path);

}  // namespace cistula
