// What every reader of OpenEXR files checks before it believes one.
#pragma once

#include <OpenEXR/ImfForward.h>

#include <cerrno>
#include <exception>
#include <new>
#include <string>

#include "scene/base/file_bytes.h"
#include "scene/image/picture.h"

namespace cistula {

using ExrAttributes = decltype(LayeredPicture::attributes);

/// Runs `read`; the library's exceptions become an Error that names the file, or std::bad_alloc.
template <class Read>
auto with_file_errors(const std::string& path, Read read) {
    errno = 0;
    try {
        return read();
    } catch (const Error&) {
        if (errno == ENOMEM) throw std::bad_alloc();  // the library takes what it could not read for missing
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        if (errno == ENOMEM) throw std::bad_alloc();
        throw file_error(path, "read", std::string(failure.what()));
    }
}

/// Limits picture sizes before the library opens a file, so that a damaged header cannot make it allocate huge arrays.
void limit_exr_sizes();

/// Throws for a header that says more pixels than a file of its size can hold, before memory is taken for them. Deflate
/// packs 1,032 to 1 at most, RLE and PIZ less; DWA does so after it took one value in 64.
void check_claim(const Imf::Header& header, const std::string& path);

/// Throws unless every chunk is present. The table of offsets is not enough: it precedes the pixels, so a truncated
/// file has all of it. Tiles are checked when their pixels are read. File: Imf::InputFile or Imf::InputPart.
template <class File>
void check_chunks(File& file);

/// Throws if a channel, by name or any, has fewer values than there are pixels.
void check_full_sampling(const Imf::Header& header, const std::string& name);
void check_full_sampling(const Imf::Header& header);

/// The attributes of the types that write_exr writes; float attributes become doubles.
ExrAttributes read_attributes(const Imf::Header& header);

}  // namespace cistula
