// The compressions of OpenEXR files, by our names and the library's. Private to image/.
#pragma once

#include <OpenEXR/ImfCompression.h>

#include "scene/image/picture/picture.h"

namespace cistula {

struct NamedCompression {
    Compression ours;
    Imf::Compression theirs;
};

/// Those that are written; files of other programs have more.
inline constexpr NamedCompression compressions[] = {
    {Compression::none, Imf::NO_COMPRESSION},   {Compression::rle, Imf::RLE_COMPRESSION},
    {Compression::zips, Imf::ZIPS_COMPRESSION}, {Compression::zip, Imf::ZIP_COMPRESSION},
    {Compression::piz, Imf::PIZ_COMPRESSION},   {Compression::dwaa, Imf::DWAA_COMPRESSION},
    {Compression::dwab, Imf::DWAB_COMPRESSION},
};

}  // namespace cistula
