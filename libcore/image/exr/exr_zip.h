// OpenEXR files of the compressions zip and zips, packed by libdeflate on TBB's threads. Private to image/.
#pragma once

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>

#include <vector>

#include "image/picture/picture.h"

namespace cistula {

/// Writes a file of scan lines, of a part for each header; only the headers' numbers of chunks are still to be set.
/// Equal pictures give equal bytes. What the stream throws ends it.
void write_zipped(Imf::OStream& stream, std::vector<Imf::Header> headers,
                  const std::vector<const LayeredPicture*>& pictures);

}  // namespace cistula
