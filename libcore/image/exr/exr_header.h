// What the header of an OpenEXR file says. Private to image/exr.
#pragma once

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfForward.h>

#include <iterator>
#include <map>
#include <string>

#include "image/picture/picture.h"
#include "image/picture/stored_picture.h"

namespace cistula {

/// The library's numbers of the compressions that are written, in our order.
inline constexpr Imf::Compression compressions[] = {Imf::NO_COMPRESSION,  Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                                    Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAA_COMPRESSION,
                                                    Imf::DWAB_COMPRESSION};
static_assert(std::size(compressions) == std::size(compression_names));
Compression compression_of(Imf::Compression compression);

using ExrAttributes = decltype(LayeredPicture::attributes);

/// The attributes of the types that write_exr writes, but for those that make a part of a file; float attributes become
/// doubles.
ExrAttributes read_attributes(const Imf::Header& header);

/// Every attribute but the windows, the channels, the part's name and what exr_packing says; those of types that nobody
/// knows too. Its value is the bytes that the file has.
std::map<std::string, StoredAttribute> exr_header_values(const Imf::Header& header);

/// How the pixels are packed, which says nothing of them: compression, order of lines, tiles.
std::map<std::string, std::string> exr_packing(const Imf::Header& header);

}  // namespace cistula
