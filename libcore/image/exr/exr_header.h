// What the header of an OpenEXR file says. Private to image/exr.
#pragma once

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfForward.h>

#include <map>
#include <string>

#include "image/picture/picture.h"
#include "image/picture/stored_picture.h"

namespace cistula {

/// A compression, by our name and the library's number. Those that only other programs write are `other`.
struct NamedCompression {
    Compression ours;
    Imf::Compression theirs;
    const char* name;
};
inline constexpr NamedCompression compressions[] = {
    {Compression::none, Imf::NO_COMPRESSION, "none"},   {Compression::rle, Imf::RLE_COMPRESSION, "rle"},
    {Compression::zips, Imf::ZIPS_COMPRESSION, "zips"}, {Compression::zip, Imf::ZIP_COMPRESSION, "zip"},
    {Compression::piz, Imf::PIZ_COMPRESSION, "piz"},    {Compression::other, Imf::PXR24_COMPRESSION, "pxr24"},
    {Compression::other, Imf::B44_COMPRESSION, "b44"},  {Compression::other, Imf::B44A_COMPRESSION, "b44a"},
    {Compression::dwaa, Imf::DWAA_COMPRESSION, "dwaa"}, {Compression::dwab, Imf::DWAB_COMPRESSION, "dwab"},
};
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
